"""How long one must look: accuracy on twelve edges against the length of the window, and against the time until the answer is there."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.flatten import read_csv, write_csv
from skinfab.bench.nail_terms import leave_out
from skinfab.bench.timing import one_processor
from skinfab.fingertip.confusion import grouped_accuracy
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.histogram_model import fit_histograms
from skinfab.fingertip.nail.improved import asked, frequency, label_of, learn
from skinfab.fingertip.nail.phasors import turned_phasors
from skinfab.fingertip.nail.protocol import Protocol, Session, sessions
from skinfab.fingertip.nail.published import modes
from skinfab.fingertip.nail.reader import Reader
from skinfab.fingertip.nail.regress import Regression, angle_apart, by_probability, targets_of
from skinfab.fingertip.nail.simulator import RATE_HZ
from skinfab.fingertip.nail.train import WINDOW
from skinfab.progress import Progress, part_of, silent

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

TEST = "edges12"
#: From 5.7 to 731 ms.
LENGTHS = (8, 12, 16, 24, 33, 64, 128, 256, 512, 1024)
PUBLISHED, TEN, IMPROVED = "published, one window", "published, mode of ten", "improved"
#: Part of the time that the lengths take; what is left out of the method is the rest.
_MEASURED = 0.8
#: Windows that are timed, each as it would come.
_TIMED = 40


@dataclass(frozen=True)
class Row:
    """One method at one length of window.

    Parameters
    ----------
    method : str
    samples : int
        Readings of a window.
    window_ms : float
        That all readings take which the answer needs.
    percent, low, high : float
        Right of all trials, and its 95 % interval (participants drawn anew).
    us_per_window : float
        Processor time of one decision on all that it needs: the least of the repeats' medians.
    latency_ms : float
        Both together.
    angle_deg, place_mm : float
        Mean errors against where the edge really lay, by regression; of the published method those of the class it says.
    weighted_angle_deg, weighted_place_mm : float
        The same by the classes' probabilities; NaN for the published method.
    default : bool
        What `skinfab nail run` does.
    simulated : bool
    """

    method: str
    samples: int
    window_ms: float
    percent: float
    low: float
    high: float
    us_per_window: float
    latency_ms: float
    angle_deg: float
    place_mm: float
    weighted_angle_deg: float
    weighted_place_mm: float
    default: bool
    simulated: bool = True


@dataclass
class _Gathered:
    """Answers of all participants to one method at one length."""

    right: list[NDArray[np.bool_]]
    errors: list[FloatArray]
    weighted: list[FloatArray]
    us: list[float]


def run(folder: Path, *, repeats: int = 3, progress: Progress = silent, protocol: Protocol | None = None, seed: int = 1) -> dict[str, Any]:
    """Measure, and write nail_window.csv, .png and .txt and nail_terms.csv into `folder`, which is there already.

    Parameters
    ----------
    folder : Path
    repeats : int
        Of the timings.
    progress : Progress
    protocol : Protocol, optional
        The paper's where it is left out.
    seed : int
        Of the participants; not that of the other tables, on which the method's constants were chosen.

    Returns
    -------
    dict
        "sentence", "notes" and "rows".
    """
    from skinfab.bench.nail_window_chart import draw
    from skinfab.files import atomic_write

    protocol = protocol or Protocol()
    notes = [f"{protocol.participants} simulated participants, {protocol.training} trials a class, {protocol.rounds} rounds"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(protocol, repeats=repeats, seed=seed, progress=part_of(progress, 0.0, _MEASURED))
    write_csv(rows, folder / "nail_window.csv")
    write_csv(leave_out(protocol, seed=seed, progress=part_of(progress, _MEASURED, 1.0)), folder / "nail_terms.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "nail_window.csv")
    said = sentence(table)
    atomic_write(folder / "nail_window.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "nail_window.png")
    return {"sentence": said, "notes": notes, "rows": table}


def measure(protocol: Protocol, *, repeats: int, seed: int, progress: Progress = silent) -> list[Row]:
    """A row for every method and length that the protocol's windows hold."""
    lengths = [n for n in LENGTHS if n <= protocol.samples]
    got: dict[tuple[str, int], _Gathered] = {}
    for k, each in enumerate(sessions(TEST, protocol=protocol, seed=seed)):
        progress(k / protocol.participants, f"participant {k + 1} of {protocol.participants}")
        truth = targets_of([label_of(touch) for touch in each.rounds.touches], true=True)
        model = learn(each)
        for n in lengths:
            _improved(each, model, n, truth, got, repeats)
            _published(each, n, truth, got, repeats)
    return [_row(method, n, of, protocol) for (method, n), of in sorted(got.items(), key=lambda item: (item[0][0], item[0][1]))]


def _improved(each: Session, model: NailModel, n: int, truth: FloatArray, got: dict[tuple[str, int], _Gathered], repeats: int) -> None:
    aimed = targets_of([label_of(touch) for touch in each.training.touches])
    windows = asked(each, n)
    drive_hz = frequency(windows, model)
    drive, _ = turned_phasors(windows, RATE_HZ, drive_hz, model.reference)
    decided = model.decide_phasors(drive, n)
    regression = Regression(model, aimed)
    estimate = regression.estimate(model.features(drive))
    weighted = by_probability(model, aimed, decided.probability)
    reader = Reader(model, n, regression=regression)
    drives = np.broadcast_to(drive_hz, (len(windows),)).tolist()
    us = _timed(lambda k: reader.decide(windows[k], drive_hz=drives[k]), len(windows), repeats)
    _add(got, (IMPROVED, n), decided.classes == each.rounds.classes, _errors(estimate, truth), _errors(weighted, truth), us)


def _published(each: Session, n: int, truth: FloatArray, got: dict[tuple[str, int], _Gathered], repeats: int) -> None:
    names = learn_names(each)
    model = fit_histograms(names, each.training.classes, each.training.readings[:, 0, :n], rate_hz=RATE_HZ)
    trials = each.rounds.readings.reshape(len(each.rounds.readings), -1, 6)
    aimed = targets_of([label_of(touch) for touch in each.training.touches])
    own = np.array([np.nan_to_num(aimed[each.training.classes == k].mean(axis=0)) for k in range(len(names))])
    nothing = np.full((len(trials), 2), np.nan)
    for method, count in ((PUBLISHED, 1), (TEN, each.rounds.readings.shape[1])):
        windows = trials[:, : count * n].reshape(len(trials), count, n, 6)
        said = modes(np.array([model.decide(each_trial) for each_trial in windows]))

        def one(k: int, windows: FloatArray = windows) -> IntArray:
            return modes(model.decide(windows[k])[None])

        us = _timed(one, len(trials), repeats)
        _add(got, (method, n), said == each.rounds.classes, _errors(own[said], truth), nothing, us)


def learn_names(each: Session) -> tuple[str, ...]:
    """Names of a session's classes, by their numbers."""
    from skinfab.fingertip.nail.labels import NOTHING
    from skinfab.fingertip.nail.patterns import TESTS

    return (NOTHING, *(pattern.name for pattern in TESTS[each.test]))


def _timed(decide: Callable[[int], object], count: int, repeats: int) -> float:
    """Processor time of a decision, us: the least of the repeats' means over windows as they come."""
    least = np.inf
    for _ in range(repeats):
        began = time.process_time()
        for k in range(_TIMED):
            decide(k % count)
        least = min(least, (time.process_time() - began) / _TIMED)
    return float(1e6 * least)


def _errors(estimate: FloatArray, truth: FloatArray) -> FloatArray:
    """Errors of targets in degrees and mm, (n, 2)."""
    angle, true = (np.degrees(np.arctan2(of[:, 1], of[:, 0])) / 2 for of in (estimate, truth))
    return np.column_stack([angle_apart(angle, true), np.linalg.norm(estimate[:, 2:4] - truth[:, 2:4], axis=1)])


def _add(
    got: dict[Any, _Gathered], key: tuple[str, int], right: NDArray[np.bool_], errors: FloatArray, weighted: FloatArray, us: float
) -> None:
    of = got.setdefault(key, _Gathered([], [], [], []))
    of.right.append(right)
    of.errors.append(errors)
    of.weighted.append(weighted)
    of.us.append(us)


def _row(method: str, n: int, of: _Gathered, protocol: Protocol) -> Row:
    right = np.concatenate(of.right)
    rate = grouped_accuracy(right, np.repeat(np.arange(len(of.right)), [len(each) for each in of.right]).tolist())
    window_ms = 1000 * n / RATE_HZ * (protocol.estimates if method == TEN else 1)
    us = float(np.median(of.us))
    errors, weighted = np.concatenate(of.errors).mean(axis=0), np.concatenate(of.weighted).mean(axis=0)
    return Row(
        method, n, window_ms, 100 * rate.value, 100 * rate.low, 100 * rate.high, us, window_ms + us / 1000,
        float(errors[0]), float(errors[1]), float(weighted[0]), float(weighted[1]), method == IMPROVED and n == WINDOW,
    )  # fmt: skip


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is and what more or less looking would give: every number in it comes from the table."""
    rows = {(row["method"], row["samples"]): row for row in table}
    default = next(row for row in table if row["default"])
    short, long = (pick(row["samples"] for row in table if row["method"] == IMPROVED) for pick in (min, max))
    best = max((row for row in table if row["method"] != IMPROVED), key=lambda row: row["percent"])

    def words(row: Mapping[str, Any]) -> str:
        return f"{row['percent']:.1f} % [{row['low']:.1f}, {row['high']:.1f}] in {row['latency_ms']:.1f} ms"

    return (
        f"Nail, simulated, twelve edges: the default ({default['samples']} readings) is right in {words(default)}, of which "
        f"{default['us_per_window']:.0f} us are computing; {short} readings give {words(rows[IMPROVED, short])} and {long} "
        f"{words(rows[IMPROVED, long])}; the published method gives {words(rows[PUBLISHED, short])} and, at its best ({best['method']}, "
        f"{best['samples']} readings), {words(best)}; by regression the edge's direction is off by {default['angle_deg']:.1f} degrees and "
        f"its foot by {default['place_mm']:.2f} mm in the mean (weighted by probability {default['weighted_angle_deg']:.1f} and "
        f"{default['weighted_place_mm']:.2f}; the published class {best['angle_deg']:.1f} and {best['place_mm']:.2f})."
    )
