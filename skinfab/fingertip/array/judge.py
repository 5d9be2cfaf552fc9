"""How good a model is on logs that it has not learned from, beside the published way and the array as drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.learn import Learned, learn
from skinfab.fingertip.array.logs import ArrayLog
from skinfab.fingertip.array.matched import ArrayModel, Matcher
from skinfab.fingertip.array.study import PUBLISHED, locators, turners
from skinfab.fingertip.splits import leave_one_out
from skinfab.rates import DRAWS

FloatArray = NDArray[np.float64]

#: Ways by name: as published, matched with the array as drawn, matched with what was learned.
WAYS = ("published", "drawn", "learned")
#: What is judged, and its unit.
QUANTITIES = {"axial": "mm", "angle": "deg", "force": "part", "line": "deg"}
#: Forces of a model of the right skin are held out within 3 %, as drawn within 4: from this part on it is of another.
FORCE_POOR = 0.1


@dataclass(frozen=True)
class Error:
    """Root mean square error of a way, with the interval of drawing whole logs anew.

    Parameters
    ----------
    way, quantity : str
    rms, low, high, worst : float
    frames : int
    """

    way: str
    quantity: str
    rms: float
    low: float
    high: float
    worst: float
    frames: int


def held_out(logs: Sequence[ArrayLog], geometry: Geometry) -> tuple[Error, ...]:
    """Errors on each log by what was learned from all others.

    Raises
    ------
    InputError
        As `learn`; there are fewer than two logs.
    """
    pressed = [k for k, log in enumerate(logs) if _of(log, rods=False).size]
    if len(pressed) < 2:
        many = "is 1 log" if len(pressed) == 1 else "are no logs"
        raise InputError(f"there {many} of presses; give two or more, each is judged by what the others teach")
    errors: dict[tuple[str, str], list[FloatArray]] = {}
    for train, test in leave_one_out([logs[k].name for k in pressed]):
        made = learn([logs[pressed[k]] for k in train], geometry)
        for k in test:
            _add(errors, logs[pressed[k]], geometry, made)
    # Logs of rods alone teach nothing, so all that was learned may be judged on them.
    if rods := [log for k, log in enumerate(logs) if k not in pressed and _of(log, rods=True).size]:
        whole = learn([logs[k] for k in pressed], geometry)
        for log in rods:
            _add(errors, log, geometry, whole)
    return tuple(_error(way, quantity, each) for (way, quantity), each in errors.items())


def better(errors: Sequence[Error]) -> tuple[bool, tuple[str, ...]]:
    """Whether what was learned errs less than the drawing on logs held out, all in all, and the quantities in which it does not.

    Examples
    --------
    >>> def error(way, quantity, rms): return Error(way, quantity, rms, rms, rms, rms, 10)
    >>> drawn = [error("drawn", "axial", 0.05), error("drawn", "angle", 1.0)]
    >>> better([*drawn, error("learned", "axial", 0.03), error("learned", "angle", 1.1)])
    (True, ('angle',))
    """
    by = {(each.way, each.quantity): each.rms for each in errors}
    ratio = {name: by["learned", name] / max(by["drawn", name], 1e-300) for name in QUANTITIES if ("learned", name) in by}
    whole = math.prod(ratio[name] for name in ("axial", "angle") if name in ratio)
    return whole < 1, tuple(name for name, value in ratio.items() if value >= 1)


def poor(errors: Sequence[Error], way: str) -> tuple[str, ...]:
    """What speaks against a way on logs held out: quantities in which the published way errs less, and forces that are far off.

    Examples
    --------
    >>> def error(way, quantity, rms): return Error(way, quantity, rms, rms, rms, rms, 10)
    >>> errors = [error("published", "axial", 0.39), error("learned", "axial", 0.451), error("learned", "force", 0.93)]
    >>> poor(errors, "learned")
    ('axial errs by 0.451 mm, 0.39 as published', 'force errs by 93 %')
    """
    by = {(each.way, each.quantity): each.rms for each in errors}
    said = [
        f"{name} errs by {by[way, name]:.3g} {unit}, {by['published', name]:.3g} as published"
        for name, unit in QUANTITIES.items()
        if by.get((way, name), 0.0) >= by.get(("published", name), math.inf)
    ]
    if (force := by.get((way, "force"), 0.0)) > FORCE_POOR:
        said.append(f"force errs by {100 * force:.0f} %")
    return tuple(said)


def _of(log: ArrayLog, *, rods: bool) -> NDArray[np.int64]:
    """Frames of presses, or of rods."""
    touched = log.touched()
    line = log.truth.get("line_deg", np.full(len(log.time), np.nan))
    return touched[np.isfinite(line[touched]) == rods]


def _add(errors: dict[tuple[str, str], list[FloatArray]], log: ArrayLog, geometry: Geometry, learned: Learned) -> None:
    models = {"drawn": ArrayModel.nominal(geometry), "learned": learned.model}
    for way in WAYS:
        if (frames := _of(log, rods=False)).size:
            locate = locators(geometry, models.get(way))[PUBLISHED if way == "published" else "matched"]
            # What was learned says places as the labels do, shifted where they are.
            found = np.array([locate(log.Z[k]) for k in frames]) + (learned.shift if way == "learned" else 0.0)
            angle = [math.degrees(math.remainder(a, math.tau)) for a in found[:, 1] - np.radians(log.truth["angle_deg"][frames])]
            errors.setdefault((way, "axial"), []).append(found[:, 0] - log.truth["axial_mm"][frames])
            errors.setdefault((way, "angle"), []).append(np.array(angle))
            if way in models:
                matcher = Matcher(models[way])
                force = np.array([matcher.one(log.Z[k])[2] for k in frames])
                errors.setdefault((way, "force"), []).append(force / log.truth["force_n"][frames] - 1)
        if (frames := _of(log, rods=True)).size:
            turn = turners(geometry, models.get(way))["span" if way == "published" else "matched"]
            lines = np.array([turn(log.Z[k]).line_rad for k in frames])
            off = np.degrees(lines) - log.truth["line_deg"][frames]
            errors.setdefault((way, "line"), []).append(np.where(np.isfinite(off), off - 180 * np.floor(off / 180 + 0.5), 45.0))


def _error(way: str, quantity: str, each: Sequence[FloatArray]) -> Error:
    squares, counts = np.array([float((e**2).sum()) for e in each]), np.array([len(e) for e in each])
    drawn = np.random.default_rng(0).integers(0, len(each), (DRAWS, len(each)))
    low, high = np.quantile(np.sqrt(squares[drawn].sum(axis=1) / counts[drawn].sum(axis=1)), (0.025, 0.975))
    whole = np.concatenate(each)
    return Error(way, quantity, math.sqrt(squares.sum() / counts.sum()), float(low), float(high), float(np.abs(whole).max()), len(whole))
