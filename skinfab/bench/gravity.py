"""How far and how often the hand is turned against the error of the centre of gravity: as published, offset fitted, hand weighed.

The paper's five places, each held many times; and the errors of its table 3 beside those of ten poses within 45 degrees. "Hand
weighed": the same hand was weighed empty three times, ten poses within 45 degrees each; its offsets drift by 0.01 N in between.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.errors import RefusedError
from skinfab.fingertip.force.gravity import WORST_SD_MM, Centre, centre_of_gravity, published_centre
from skinfab.fingertip.force.gravity_fit import learn_hand
from skinfab.fingertip.force.gravity_model import HandModel, centre_with
from skinfab.fingertip.force.gravity_simulator import PAPER_ESTIMATE, PAPER_TRUTH, HandScene, hold
from skinfab.fingertip.force.poses import Poses, poses_of
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.progress import Progress, silent

WAYS = {"published": published_centre, "offset fitted": centre_of_gravity}
WEIGHED = "hand weighed"
#: Degrees to which the hand is turned either way, and poses.
SPANS, POSES = (3.0, 5.0, 10.0, 20.0, 45.0, 90.0), (2, 3, 5, 10, 20)
#: Times that a hand is weighed empty, and how far its offsets drift in between, N.
WEIGHINGS, DRIFT_N = 3, 0.01
#: The hand without one term.
TERMS = {
    "all terms": {},
    "force offsets": {"offset_n": 0.0},
    "fingertips' error": {"kinematics_mm": 0.0},
    "force noise": {"noise": SensorNoise(1e-6, SensorNoise().moment_nmm)},
    "moment noise": {"noise": SensorNoise(SensorNoise().force_n, 1e-5)},
}
#: What the paper did, and what is measured beside it: ten poses; its span is not told.
USUAL = (45.0, 10)
TRIALS = 20
#: 95 % of a Gaussian error in three dimensions lie within this squared distance.
_ELLIPSOID = 7.814727903251179


@dataclass(frozen=True)
class Row:
    """One way, span and number of poses.

    Parameters
    ----------
    way : str
    span_deg : float
    poses : int
    median_mm, p95_mm : float
        Of the error.
    covered : float
        Part of the errors within the stated 95 % ellipsoid, where the hand knows exactly where its fingertips are.
    refused : float
        Part whose stated standard deviation is above the limit.
    stated_sd_mm : float
        Median, in the worst direction.
    us : float
        Least processor time.
    """

    way: str
    span_deg: float
    poses: int
    median_mm: float
    p95_mm: float
    covered: float
    refused: float
    stated_sd_mm: float
    us: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write gravity.csv, gravity_ablation.csv, gravity.png and gravity.txt into `folder`, which is there already.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows" and "ablation".
    """
    from skinfab.bench.gravity_chart import draw
    from skinfab.files import atomic_write

    notes = [f"simulated: a ball of 170 g at the paper's five places, each held {TRIALS} times for every span and number of poses"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=lambda done, what: progress(0.9 * done, what))
    write_csv(rows, folder / "gravity.csv")
    write_csv(without(), folder / "gravity_ablation.csv")
    table = read_csv(folder / "gravity.csv")
    said = sentence(table)
    atomic_write(folder / "gravity.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "gravity.png")
    return {"sentence": said, "notes": notes, "rows": table, "ablation": read_csv(folder / "gravity_ablation.csv")}


@dataclass(frozen=True)
class TermRow:
    """The usual poses without one term of the simulator: median errors, as published and with the offset fitted."""

    without: str
    published_mm: float
    fitted_mm: float


def without(*, trials: int = TRIALS) -> list[TermRow]:
    """A row for each of `TERMS`."""
    rows = []
    for name, terms in TERMS.items():
        held = _held(replace(HandScene(), **terms), trials, weigh=False)  # type: ignore[arg-type]
        off = [[float(np.linalg.norm(c.point - each.truth)) for each in held if (c := _found(way, each)) is not None] for way in WAYS]
        rows.append(TermRow(name, *(float(np.median(each)) for each in off)))
    return rows


def measure(
    *,
    spans: Sequence[float] = SPANS,
    poses: Sequence[int] = POSES,
    trials: int = TRIALS,
    repeats: int = REPEATS,
    progress: Progress = silent,
) -> list[Row]:
    """A row for every way at each span with the usual number of poses, and at each number of poses with the usual span."""
    settings = [(span, USUAL[1]) for span in spans] + [(USUAL[0], n) for n in poses if n != USUAL[1]]
    rows = []
    for k, (span, n) in enumerate(settings):
        progress(k / len(settings), f"{n} poses within {span:g} degrees")
        scene = HandScene(span_deg=span, poses=n, drift_n=DRIFT_N)
        blind, exact = (_held(each, trials) for each in (scene, replace(scene, kinematics_mm=0.0)))
        # Two poses cannot tell an offset, whose fit needs three.
        rows += [_row(way, scene, blind, exact, repeats) for way in (*WAYS, WEIGHED) if n > 2 or way != "offset fitted"]
    return rows


@dataclass(frozen=True, eq=False)
class _Case:
    truth: Any
    poses: Poses
    hand: HandModel | None


def _held(scene: HandScene, trials: int, *, weigh: bool = True) -> list[_Case]:
    usual, out = replace(scene, poses=USUAL[1], span_deg=USUAL[0]), []
    for k, centre in enumerate(PAPER_TRUTH):
        for j in range(trials):
            seed = [k, j, scene.poses]
            held = hold(centre, seed=seed, scene=scene)
            empty = [poses_of(hold(centre, seed=seed, scene=usual, weighing=i).log) for i in range(WEIGHINGS)] if weigh else []
            out.append(_Case(held.centre, poses_of(held.log), learn_hand(empty) if weigh else None))
    return out


def _row(way: str, scene: HandScene, blind: list[_Case], exact: list[_Case], repeats: int) -> Row:
    found = [_found(way, each) for each in blind]
    errors = [float(np.linalg.norm(c.point - each.truth)) for c, each in zip(found, blind, strict=True) if c is not None]
    covered = []
    for each in exact:
        if (c := _found(way, each)) is not None:
            covered.append(float((c.point - each.truth) @ np.linalg.solve(c.covariance, c.point - each.truth)) <= _ELLIPSOID)
    sd = np.array([np.inf if c is None else c.sd_mm for c in found])
    work = partial(_found, way, blind[0])
    us = 1e6 * min(timed_twice(work)[1] for _ in range(repeats))
    return Row(
        way,
        scene.span_deg,
        scene.poses,
        float(np.median(errors)),
        float(np.quantile(errors, 0.95)),
        float(np.mean(covered)),
        float(np.mean(sd > WORST_SD_MM)),
        float(np.median(sd)),
        us,
    )


def _found(way: str, case: _Case) -> Centre | None:
    poses = case.poses
    try:
        if way == WEIGHED:
            assert case.hand is not None
            return centre_with(case.hand, poses)
        return WAYS[way](poses.force, poses.moment, poses.covariance)
    except RefusedError:
        return None


def paper_errors() -> list[float]:
    """Of the paper's table 3, mm."""
    errors: list[float] = np.linalg.norm(np.array(PAPER_ESTIMATE) - np.array(PAPER_TRUTH), axis=1).tolist()
    return errors


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What fitting the offset is worth, and what the poses are: every number comes from the table, but for the paper's own."""
    theirs, ours = (next(r for r in table if r["way"] == way and (r["span_deg"], r["poses"]) == USUAL) for way in WAYS)
    few = next(r for r in table if r["way"] == WEIGHED and r["poses"] == min(r["poses"] for r in table))
    narrow = min((r for r in table if r["way"] == ours["way"] and r["poses"] == USUAL[1]), key=lambda r: r["span_deg"])
    paper = paper_errors()
    return (
        f"Centre of gravity, simulated: from {USUAL[1]} poses within {USUAL[0]:g} degrees {ours['median_mm']:.2f} mm (median) with the "
        f"offset fitted and {theirs['median_mm']:.2f} mm as published (the paper's table 3: {min(paper):.1f} to {max(paper):.1f} mm); the "
        f"stated 95 % hold {100 * ours['covered']:.1f} % of the errors and {100 * theirs['covered']:.1f} %; within "
        f"{narrow['span_deg']:g} degrees {narrow['median_mm']:.1f} mm, of which {100 * narrow['refused']:.0f} % are refused; a hand "
        "that was weighed empty tells "
        "it from "
        f"{few['poses']} poses to {few['median_mm']:.2f} mm."
    )
