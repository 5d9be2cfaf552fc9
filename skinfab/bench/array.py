"""The tactel array: interpolators and densities against the error of place and direction and microseconds; the seed's figures redrawn."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor
from skinfab.fingertip.array.ablation import ablation
from skinfab.fingertip.array.false_events import HOW, RATES, Stood, false_events
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.study import (
    IMPROVED,
    PUBLISHED,
    locators,
    on_a_layer,
    rms,
    rods_on,
    scan,
    three_fingers,
    tilts,
    turners,
    twirls,
    worst,
)
from skinfab.progress import Progress, silent

DENSITIES = ("8x8", "8x16", "16x16")
#: Arrays that each figure is taken of; rods in each direction on each; logs of twirling.
DEVICES, RODS, TWIRLS = 10, 6, 20
#: Presses that pull along the skin, on each array.
TILTS = 12
#: Arrays under another field, the seed's of 8 x 8.
LAYERS = 4
#: Touches in each row of those that stand, and of those that slip and roll.
STOOD, MOVED = 10, 5
#: Frames whose reading is timed.
_TIMED = 60
SPAN = "span"
#: What the seed measured, by experiment; `line between` is its figure 11, `line of three` its guess for three fingers.
SEED = {"along": 0.5, "around": 10.0, "line between": 20.0, "line of three": 7.0}
UNITS = {
    "along": "mm",
    "around": "deg",
    "line": "deg",
    "line between": "deg",
    "tilt along": "deg",
    "tilt around": "deg",
    "line of three": "deg",
    "layer along": "mm",
    "layer around": "deg",
}


@dataclass(frozen=True)
class Row:
    """One way on one density in one experiment.

    Parameters
    ----------
    experiment : str
        Of `UNITS`, which says the unit of the errors.
    density : str
    method : str
    worst, rms : float
        Error, over all arrays.
    us : float
        Least processor time a frame; NaN where it was not measured.
    n : int
        Frames.
    simulated : bool
    """

    experiment: str
    density: str
    method: str
    worst: float
    rms: float
    us: float
    n: int
    simulated: bool = True


@dataclass(frozen=True)
class Tracked:
    """Events of twirling that were found one way."""

    method: str
    kind: str
    true: int
    right: int
    found: int
    off_mm: float
    simulated: bool = True


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write array.csv, .png and .txt, array_seed.png, and array_twirl, _still and _ablation.csv into `folder`, which is there.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows" and "twirl".
    """
    from skinfab.bench.array_chart import draw, draw_seed
    from skinfab.files import atomic_write

    notes = [f"simulated arrays, {DEVICES} of each density with gains and noise of their own; the array is known as drawn"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows = measure(repeats=repeats, progress=progress)
    write_csv(rows, folder / "array.csv")
    write_csv(track(), folder / "array_twirl.csv")
    progress(0.99, "fingers that stand, slip and roll")
    write_csv(stood(), folder / "array_still.csv")
    write_csv(ablation(), folder / "array_ablation.csv")
    # From here on only what the tables hold is used, so that chart and sentence cannot say anything else.
    table, twirl = read_csv(folder / "array.csv"), read_csv(folder / "array_twirl.csv")
    said = sentence(table, twirl)
    atomic_write(folder / "array.txt", "\n".join([said, *notes]) + "\n")
    draw(table, folder / "array.png")
    draw_seed(folder / "array_seed.png")
    return {"sentence": said, "notes": notes, "rows": table, "twirl": twirl}


def measure(
    *,
    densities: Sequence[str] = DENSITIES,
    devices: int = DEVICES,
    rods: int = RODS,
    layers: int = LAYERS,
    repeats: int = REPEATS,
    progress: Progress = silent,
) -> list[Row]:
    """A row for every experiment, density and way."""
    rows: list[Row] = []
    for k, density in enumerate(densities):
        geometry = Geometry.of_density(density)
        each = [Device(geometry, seed=seed) for seed in range(devices)]
        for axis in ("along", "around"):
            progress((k + 0.2 * (axis == "around")) / len(densities), f"{density} tactels, {axis}")
            scans = [scan(device, axis, seed=device.seed) for device in each]
            for name, locate in locators(geometry).items():
                errors = np.concatenate([one.errors(locate) for one in scans])
                us = least_us(locate, scans[0].Z[:_TIMED], repeats)
                rows.append(Row(axis, density, name, worst(errors), rms(errors), us, len(errors)))
        for experiment in ("line", "line between"):
            progress((k + 0.4 + 0.3 * (experiment == "line")) / len(densities), f"{density} tactels, rods")
            laid = [rods_on(device, rods, seed=device.seed, between=experiment != "line") for device in each]
            for name, turn in turners(geometry).items():
                judged = [one.judged(turn) for one in laid]
                errors, sure = np.concatenate([e for e, _ in judged]), np.concatenate([s for _, s in judged])
                us = least_us(turn, laid[0].Z[:_TIMED], repeats)
                rows.append(Row(experiment, density, name, worst(errors), rms(errors), us, len(errors)))
                if sure.any():
                    rows.append(
                        Row(experiment, density, f"{name}, where sure", worst(errors[sure]), rms(errors[sure]), us, int(sure.sum()))
                    )
        off = tilts(each, TILTS)
        for k_axis, experiment in enumerate(("tilt along", "tilt around")):
            for name, errors in off.items():
                known = errors[np.isfinite(errors[:, k_axis]), k_axis]
                rows.append(Row(experiment, density, name, worst(known), rms(known), float("nan"), len(known)))
        fingers = [Device(geometry, seed=100 + j) for j in range(3)]
        for name, errors in three_fingers(fingers, rods).items():
            rows.append(Row("line of three", density, name, worst(errors), rms(errors), float("nan"), len(errors)))
    progress(0.98, "another field")
    for axis, by in on_a_layer(range(layers)).items():
        for name, errors in by.items():
            rows.append(Row(f"layer {axis}", densities[0], name, worst(errors), rms(errors), float("nan"), len(errors)))
    return rows


def least_us(work: Callable[[NDArray[np.float64]], object], Z: NDArray[np.float64], repeats: int) -> float:
    """Least processor time of a frame, microseconds."""
    work(Z[0])
    taken = []
    for _ in range(repeats):
        began = time.process_time()
        for frame in Z:
            work(frame)
        taken.append(time.process_time() - began)
    return min(taken) / len(Z) * 1e6


def track(logs: int = TWIRLS) -> list[Tracked]:
    """A row for every way and kind of event."""
    return [
        Tracked("matched line" if not published else "centre of pressure", kind, each.true, each.right, each.found, each.off_mm)
        for published in (True, False)
        for kind, each in twirls(range(1000, 1000 + logs), published=published).items()
    ]


def stood(touches: tuple[int, int] = (STOOD, MOVED), rates: Sequence[float] = RATES) -> list[Stood]:
    """A row for every force and rate of fingers that stand, and of those that move."""
    return [*false_events(touches[0], rates=rates, how=HOW[:2]), *false_events(touches[1], rates=rates, how=HOW[2:])]


def pick(table: Sequence[Mapping[str, Any]], experiment: str, density: str, method: str) -> Mapping[str, Any]:
    """The row of an experiment."""
    return next(row for row in table if (row["experiment"], row["density"], row["method"]) == (experiment, density, method))


def sentence(table: Sequence[Mapping[str, Any]], twirl: Sequence[Mapping[str, Any]]) -> str:
    """Published beside improved, and what density gives: every number in it comes from the tables."""
    first, *_, last = [row["density"] for row in table if not row["experiment"].startswith("layer")]
    said = []
    for experiment, words, published in (
        ("along", "mm along", PUBLISHED),
        ("around", "degrees around", PUBLISHED),
        ("line between", "degrees of a rod's direction between two stripes", SPAN),
        ("line", "degrees of it anywhere", SPAN),
    ):
        old, new = (pick(table, experiment, first, name) for name in (published, IMPROVED))
        seed = f" (the seed measured {SEED[experiment]:g})" if experiment in SEED else ""
        also = ""
        if experiment.startswith("line"):
            sure = pick(table, experiment, first, f"{IMPROVED}, where sure")
            also = f" ({sure['worst']:.2g} in the {sure['n']} of {new['n']} frames where it is called sure)"
        said.append(
            f"{words} at worst: {old['worst']:.2g} as published{seed} at {old['us']:.0f} us a frame, {new['worst']:.2g} matched{also} at "
            f"{new['us']:.0f} us"
        )
    denser = pick(table, "line", last, SPAN)
    slips = {row["method"]: row for row in twirl if row["kind"] == "slip"}
    events = "; ".join(
        f"{name} finds {row['right']} of {row['true']} slips and {row['found'] - row['right']} that are none" for name, row in slips.items()
    )
    tilt = " and ".join(f"{pick(table, f'tilt {axis}', first, IMPROVED)['rms']:.2g} {axis}" for axis in ("along", "around"))
    field = [pick(table, f"layer {axis}", first, IMPROVED)["worst"] for axis in ("along", "around")]
    return (
        f"On {first} simulated tactels, {'; '.join(said)}; {last} tactels leave the published way {denser['worst']:.2g} degrees of "
        f"direction; a force's angle is off by {tilt} degrees rms; on another field than its own matched errs by "
        f"{field[0]:.2g} mm and {field[1]:.2g} degrees at worst; in twirling {events}. "
        f"The default is {IMPROVED}, because aliasing, not noise, is what the others err by."
    )
