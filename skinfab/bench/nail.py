"""The paper's three tests on simulated participants: the published method and the improved one on the same touches.

Two thirds of the tables are about the simulator itself: how near the published method comes to the paper's accuracies, whether the
sensor conditions differ as they do there, and what each term of the simulator is for.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench import nail_confidence, nail_force, nail_window
from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.nail_ablation import ablate
from skinfab.fingertip.nail.improved import improved_answers
from skinfab.fingertip.nail.paper import ACCURACY, AROUND, DIFFERING
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome, Protocol, Session, published_answers, sessions, study
from skinfab.fingertip.nail.published import CONDITIONS
from skinfab.fingertip.nail.statistics import Comparison, compare
from skinfab.progress import Progress, part_of, silent

Table = Sequence[Mapping[str, Any]]

PUBLISHED, IMPROVED = "published", "improved"
#: The sensor condition that the improved method has, and by which the two are compared.
FULL = "AxAyAzGxGyGz"
#: With fewer participants no corrected comparison of nine conditions (36 pairs) shows what the paper's ten do.
LEAST_PARTICIPANTS = 6
#: Parts of the time: the three tests, then the ablation, then forces, then confidence; the window's lengths are the rest.
_TESTS_DONE, _TERMS_DONE, _FORCES_DONE, _SURE_DONE = 0.4, 0.75, 0.8, 0.82


@dataclass(frozen=True)
class Row:
    """One method under one sensor condition of one test.

    Parameters
    ----------
    test, condition, method : str
    percent, deviation : float
        Mean and standard deviation of the participants' accuracies.
    paper : float
        The paper's mean; NaN where it is not printed.
    around : bool
        The paper says "around" of it.
    within : float
        1 where the means differ by no more than the deviation, else 0; NaN where the paper has none.
    simulated : bool
    """

    test: str
    condition: str
    method: str
    percent: float
    deviation: float
    paper: float
    around: bool
    within: float
    simulated: bool = True


@dataclass(frozen=True)
class Difference:
    """Two sensor conditions under the published method, and whether they differ.

    Parameters
    ----------
    test, a, b : str
    method : str
        Of the comparison.
    p : float
        Corrected for the number of pairs.
    differs : bool
    paper : bool
        Does the paper say that they differ?
    simulated : bool
    """

    test: str
    a: str
    b: str
    method: str
    p: float
    differs: bool
    paper: bool
    simulated: bool = True


@dataclass(frozen=True)
class Taken:
    """How often the published method took one class for one class; by their numbers, 0 is no contact."""

    test: str
    condition: str
    was: int
    taken_for: int
    trials: int
    simulated: bool = True


def run(
    folder: Path, *, repeats: int = REPEATS, progress: Progress = silent, protocol: Protocol | None = None, seed: int = 0
) -> dict[str, Any]:
    """Run the three tests and measure the window's length; write tables, charts and sentences, nail*.csv, .png and .txt, into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    repeats : int
        Of timings.
    progress : Progress
    protocol : Protocol, optional
        The paper's where it is left out.
    seed : int
        Of the participants.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of it) and "rows".
    """
    from skinfab.bench.nail_chart import draw_accuracy, draw_confusion
    from skinfab.files import atomic_write

    protocol = protocol or Protocol()
    outcomes = {}
    for k, test in enumerate(TESTS):
        part = part_of(progress, _TESTS_DONE * (k / len(TESTS)), _TESTS_DONE * ((k + 1) / len(TESTS)))
        outcomes[test] = _outcome(test, protocol, seed, part)
    compared = {test: compare({name: of.accuracy[name] for name in CONDITIONS}) for test, of in outcomes.items()}
    write_csv([row for outcome in outcomes.values() for row in _rows(outcome)], folder / "nail.csv")
    write_csv([row for test, of in compared.items() for row in _differences(test, of)], folder / "nail_pairs.csv")
    write_csv([row for outcome in outcomes.values() for row in _taken(outcome)], folder / "nail_confusion.csv")
    write_csv(ablate(protocol, seed=seed, progress=part_of(progress, _TESTS_DONE, _TERMS_DONE)), folder / "nail_ablation.csv")
    pressed = nail_force.measure(protocol, tuple(TESTS), seed=seed, progress=part_of(progress, _TERMS_DONE, _FORCES_DONE))
    write_csv(pressed, folder / "nail_force.csv")
    told = nail_confidence.measure(protocol, tuple(TESTS), progress=part_of(progress, _FORCES_DONE, _SURE_DONE))
    write_csv(told, folder / "nail_confidence.csv")
    # From here on only what the tables hold is used, so that charts and sentence cannot say anything else.
    parts = ("", "_pairs", "_ablation", "_force", "_confidence")
    table, pairs, terms, forces, sure = (read_csv(folder / f"nail{part}.csv") for part in parts)
    windows = nail_window.run(folder, repeats=repeats, progress=part_of(progress, _SURE_DONE, 1.0), protocol=protocol)
    said = " ".join(
        [
            sentence(table, pairs, participants=protocol.participants),
            nail_force.sentence(forces),
            nail_confidence.sentence(sure),
            windows["sentence"],
        ]
    )
    notes = [
        f"simulated participants ({protocol.participants}, seed {seed}); what the simulator leaves out stands in docs/nail.md",
        *(f"{test}: {found}" for test, found in compared.items()),
        *windows["notes"],
    ]
    atomic_write(folder / "nail.txt", "\n".join([said, *notes]) + "\n")
    draw_accuracy(table, folder / "nail.png")
    nail_confidence.draw(sure, folder / "nail_confidence.png")
    for test, outcome in outcomes.items():
        draw_confusion(outcome, folder / f"nail_confusion_{test}.png")
    found = {"rows": table, "pairs": pairs, "ablation": terms, "forces": forces, "confidence": sure, "windows": windows["rows"]}
    return {"sentence": said, "notes": notes, "simulated": True, **found}


def _outcome(test: str, protocol: Protocol, seed: int, progress: Progress) -> Outcome:
    progress(0.0, test)

    def told(of: Session) -> None:
        progress(of.participant / protocol.participants, f"{test}: participant {of.participant}")

    return study(sessions(test, protocol=protocol, seed=seed), lambda of: published_answers(of) | improved_answers(of), told=told)


def _rows(outcome: Outcome) -> list[Row]:
    rows = []
    around = AROUND.get(outcome.test, {})
    for condition in CONDITIONS:
        mean, deviation = 100 * outcome.mean(condition), 100 * outcome.deviation(condition)
        paper = (around | ACCURACY[outcome.test]).get(condition, math.nan)
        within = math.nan if math.isnan(paper) else float(abs(mean - paper) <= deviation)
        rows.append(Row(outcome.test, condition, PUBLISHED, mean, deviation, paper, condition in around, within))
    mean, deviation = 100 * outcome.mean(IMPROVED), 100 * outcome.deviation(IMPROVED)
    return [*rows, Row(outcome.test, FULL, IMPROVED, mean, deviation, math.nan, False, math.nan)]


def _taken(outcome: Outcome) -> list[Taken]:
    return [
        Taken(outcome.test, condition, was, taken_for, int(trials))
        for condition in CONDITIONS
        for (was, taken_for), trials in np.ndenumerate(outcome.confusion[condition].counts)
        if trials
    ]


def _differences(test: str, found: Comparison) -> list[Difference]:
    ours = {frozenset((pair.a, pair.b)) for pair in found.differing()}
    return [
        Difference(test, pair.a, pair.b, found.method, pair.p, frozenset((pair.a, pair.b)) in ours, {pair.a, pair.b} in DIFFERING[test])
        for pair in found.pairs
    ]


def sentence(table: Table, pairs: Table, *, participants: int) -> str:
    """How near it comes to the paper: every number in it comes from the tables."""
    rows = [row for row in table if row["method"] == PUBLISHED]
    known = [row for row in rows if row["paper"] is not None]
    near = [row for row in known if row["within"]]
    heads = []
    for test in dict.fromkeys(row["test"] for row in table):
        full, better = (
            next(r for r in table if (r["test"], r["condition"], r["method"]) == (test, FULL, m)) for m in (PUBLISHED, IMPROVED)
        )
        heads.append(f"{full['percent']:.1f} % of {test} (paper {full['paper']:.1f}, improved {better['percent']:.1f})")
    far = [f"{row['condition']} of {row['test']} {row['percent']:.0f} instead of {row['paper']:.0f}" for row in known if row not in near]
    said = (
        f"Nail, simulated: with all six channels the published method is right in {', '.join(heads)}; "
        f"{len(near)} of {len(known)} accuracies that the paper gives are within the standard deviation of the simulated participants "
        f"themselves (up to {max(row['deviation'] for row in known):.1f} points"
        + (f'; {about} of the {len(known)} are only said to be "around 50 %"' if (about := sum(bool(r["around"]) for r in known)) else "")
        + ")"
        + (f", and these are not: {', '.join(far)}" if far else "")
    )
    if participants < LEAST_PARTICIPANTS:
        return f"{said}; {participants} participants are too few to show which sensor conditions differ ({LEAST_PARTICIPANTS} at least)."
    printed = [row for row in pairs if row["paper"]]
    both = sum(bool(row["differs"]) for row in printed)
    return f"{said}; of {len(printed)} pairs of sensor conditions that differ in the paper {both} differ here."
