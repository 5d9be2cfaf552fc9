"""An array's model learned from presses at known places: the skin's depth and Poisson's ratio, its modulus, and each tactel's gain.

For a depth and a ratio the gains are linear; these two are searched for. Gains are held to their common one, so that a tactel that was
never pressed keeps it; by how much, and whether depth and ratio are searched for at all, is what leaves least of presses that were
held out. Frames of one press count once. Labels that are all shifted by as much, because ring 0 or stripe 0 was taken for elsewhere,
are shifted back and told.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.logs import ArrayLog
from skinfab.fingertip.array.matched import ArrayModel, Matcher
from skinfab.fingertip.array.response import add_force
from skinfab.fingertip.array.simulator import Rubber
from skinfab.fingertip.saved import load_model, save_model

FloatArray = NDArray[np.float64]

KIND = "tactel array"
#: Weights of the common gain that are tried, as parts of what a tactel reads in the middle of all presses, squared and summed.
_HOLDS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, math.inf)
#: Fewer presses say nothing of an array; they are held out in so many parts.
LEAST_PRESSES, _FOLDS = 8, 4
#: A shift of the labels is one from so many standard errors and so many mm and degrees on; beyond half a tactel they are another's.
_SHIFT_SE, _SHIFT_MM, _SHIFT_DEG = 4.0, 0.15, 1.5
#: Young's moduli of soft skins, N/mm^2.
SOFT = (0.1, 10.0)
#: What the search may come to, as parts of the drawn depth.
_DEPTHS = (0.5, 1.8)
#: It stops at steps of this, mm.
_DEPTH_MM = 5e-3


@dataclass(frozen=True, eq=False)
class Learned:
    """A model, and what was found in learning it.

    Parameters
    ----------
    model : ArrayModel
    drawn : ArrayModel
        As drawn, but for the modulus, which no drawing knows.
    shift : tuple of float
        By how much the labels lie farther than the contacts, mm along and rad around; 0 where that is not sure.
    notes : tuple of str
    """

    model: ArrayModel
    drawn: ArrayModel
    shift: tuple[float, float]
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Presses:
    """Mean readings (n, rings, stripes), places (mm along and around the core, (n, 2)) and forces (n,) of presses."""

    Z: FloatArray
    places: FloatArray
    forces: FloatArray

    def __getitem__(self, which: NDArray[np.bool_]) -> _Presses:
        return _Presses(self.Z[which], self.places[which], self.forces[which])

    def __len__(self) -> int:
        return len(self.forces)


def learn(logs: Sequence[ArrayLog], geometry: Geometry) -> Learned:
    """Learn from the presses (not the rods) in labelled logs.

    Raises
    ------
    InputError
        The logs are of another array, do not say where they were touched, or hold too few presses.
    RefusedError
        The presses are not explained by any skin: their labels are not those of these readings.

    Examples
    --------
    >>> from skinfab.fingertip.array.logs import of_recording
    >>> from skinfab.fingertip.array.protocols import presses
    >>> from skinfab.fingertip.array.simulator import Device
    >>> device = Device(seed=3)
    >>> model = learn([of_recording(presses(device, 200), name="a")], device.geometry).model
    >>> bool(np.std(model.gains / model.gains.mean() / device.skin.gains) < 0.02), round(model.geometry.skin, 1)
    (True, 3.8)
    """
    presses = _presses(logs, geometry)
    shift = _shift(presses, geometry)
    presses = _Presses(presses.Z, presses.places - np.array([shift[0], shift[1] * geometry.core_radius]), presses.forces)
    free, hold = _chosen(presses, geometry)
    (depth, ratio), left = _skin(presses, geometry, free=free)
    if left > 0.5:
        raise RefusedError(
            f"no skin explains the presses: {100 * left:.0f} % of their readings are left; are the columns axial_mm (from ring 0) and "
            "angle_deg (from stripe 0) those of this array?"
        )
    scale, gains = _gains(presses.Z, _unit(presses.places, geometry, depth, ratio) * presses.forces[:, None, None], hold)
    drawn_as = asdict(geometry)
    # The depth is that of the model alone: the electrodes stay where they are, on the core.
    core = geometry.core_radius
    fitted = Geometry(**(drawn_as | {"skin": depth, "finger_radius": core + depth}))
    nominal = ArrayModel.nominal(geometry)
    plain, _ = _gains(
        presses.Z, _unit(presses.places, geometry, geometry.skin, nominal.rubber.poisson) * presses.forces[:, None, None], math.inf
    )
    drawn = replace(nominal, rubber=replace(nominal.rubber, young=1 / plain))
    return Learned(ArrayModel(fitted, Rubber(1 / scale, ratio), gains), drawn, shift, tuple(_notes(shift, 1 / scale, depth, geometry.skin)))


def _notes(shift: tuple[float, float], young: float, depth: float, drawn: float) -> list[str]:
    notes = []
    least, most = (part * drawn for part in _DEPTHS)
    if not least + _DEPTH_MM < depth < most - _DEPTH_MM:
        notes.append(
            f"a depth of {depth:.2f} mm is the {'least' if depth < drawn else 'most'} that is searched for about the {drawn:g} mm given; "
            "presses ask for still another: give the skin's thickness"
        )
    if any(shift):
        notes.append(
            f"the labels lie {shift[0]:+.2f} mm along and {math.degrees(shift[1]):+.1f} degrees around from where the array finds the "
            "presses; that was taken off: is ring 0 at 0 mm, and stripe 0 at 0 degrees?"
        )
    if not SOFT[0] <= young <= SOFT[1]:
        notes.append(f"a modulus of {young:.3g} N/mm^2 is no soft rubber's ({SOFT[0]:g} to {SOFT[1]:g}); is force_n in newtons?")
    return notes


def _presses(logs: Sequence[ArrayLog], geometry: Geometry) -> _Presses:
    """Frames that follow each other and say the same place and force are one press: their mean."""
    readings: list[FloatArray] = []
    labels: list[tuple[float, float, float]] = []
    for log in logs:
        if log.shape != geometry.shape:
            raise InputError(
                f"{log.name} is of an array of {log.shape[0]} x {log.shape[1]} tactels, not of {geometry.rings} x {geometry.stripes}"
            )
        touched = log.touched()
        line = log.truth.get("line_deg", np.full(len(log.time), np.nan))
        touched = touched[np.isnan(line[touched])]
        said = np.column_stack([log.truth[name][touched] for name in ("axial_mm", "angle_deg", "force_n")])
        begins = 1 + np.flatnonzero(np.any(said[1:] != said[:-1], axis=1) | (np.diff(touched) > 1))
        for frames in np.split(np.arange(len(touched)), begins) if len(touched) else ():
            Z = log.Z[touched[frames]]
            known = np.isfinite(Z)
            readings.append(np.where(known.any(axis=0), np.where(known, Z, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1), np.nan))
            axial, angle, force = (float(value) for value in said[frames[0]])
            labels.append((axial, math.radians(angle) * geometry.core_radius, force))
    if len(readings) < LEAST_PRESSES:
        raise InputError(f"the logs hold {len(readings)} presses on points; give at least {LEAST_PRESSES}, all over the array")
    table = np.array(labels)
    return _Presses(np.array(readings), table[:, :2], table[:, 2])


def _shift(presses: _Presses, geometry: Geometry) -> tuple[float, float]:
    """By how much labels lie farther, mm along and rad around, than the array as drawn finds the presses.

    Raises
    ------
    RefusedError
        By more than half a tactel.
    """
    matcher, core = Matcher(ArrayModel.nominal(geometry)), geometry.core_radius
    found = [matcher.one(Z)[:2] if np.isfinite(Z).any() else (np.nan, np.nan) for Z in presses.Z]
    off = presses.places - np.array(found)
    off[:, 1] = [core * math.remainder(value / core, math.tau) if math.isfinite(value) else np.nan for value in off[:, 1]]
    middle = np.nanmedian(off, axis=0)
    # 1.48 median absolute deviations are a standard deviation, and a median errs by 1.25 of the mean's error.
    error = 1.25 * 1.48 * np.nanmedian(np.abs(off - middle), axis=0) / math.sqrt(len(presses))
    least = (_SHIFT_MM, math.radians(_SHIFT_DEG) * core)
    shift = [float(m) if abs(m) > max(_SHIFT_SE * e, t) else 0.0 for m, e, t in zip(middle, error, least, strict=True)]
    if abs(shift[0]) > geometry.ring_pitch / 2 or abs(shift[1]) > geometry.stripe_pitch / 2:
        raise RefusedError(
            f"the labels lie {shift[0]:+.1f} mm along and {math.degrees(shift[1] / core):+.0f} degrees around from where the array finds "
            "the presses, more than half a tactel: count axial_mm from the middle of ring 0 and angle_deg from the middle of stripe 0"
        )
    return shift[0], shift[1] / core


def _chosen(presses: _Presses, geometry: Geometry) -> tuple[bool, float]:
    """Whether to search for depth and ratio, and how strongly to hold the gains: what leaves least of presses held out."""
    fold = np.arange(len(presses)) % _FOLDS
    left: dict[tuple[bool, float], float] = {}
    for free in (False, True):
        sums = np.zeros(len(_HOLDS))
        for part in range(_FOLDS):
            train, test = presses[fold != part], presses[fold == part]
            (depth, ratio), _ = _skin(train, geometry, free=free)
            U, V = (_unit(each.places, geometry, depth, ratio) * each.forces[:, None, None] for each in (train, test))
            for k, hold in enumerate(_HOLDS):
                scale, gains = _gains(train.Z, U, hold)
                sums[k] += float(np.nansum((test.Z - scale * gains * V) ** 2))
        left |= {(free, hold): value for hold, value in zip(_HOLDS, sums, strict=True)}
    return min(left, key=lambda one: left[one])


def _skin(presses: _Presses, geometry: Geometry, *, free: bool) -> tuple[tuple[float, float], float]:
    """Depth and ratio, searched for or as drawn, and the part of the readings that is left with one gain for all."""
    from scipy.optimize import minimize

    held = float(np.sqrt(np.nansum(presses.Z**2)))

    def left(parameters: FloatArray) -> float:
        depth, ratio = parameters
        U = _unit(presses.places, geometry, float(depth), float(ratio)) * presses.forces[:, None, None]
        scale, _ = _gains(presses.Z, U, math.inf)
        return float(np.sqrt(np.nansum((presses.Z - scale * U) ** 2))) / held

    drawn = np.array([geometry.skin, Rubber().poisson])
    if not free:
        return (float(drawn[0]), float(drawn[1])), left(drawn)
    found = minimize(
        left,
        np.array([geometry.skin, 0.45]),
        method="Nelder-Mead",
        bounds=[(_DEPTHS[0] * geometry.skin, _DEPTHS[1] * geometry.skin), (0.0, 0.5)],
        options={"xatol": _DEPTH_MM, "fatol": 1e-5, "maxfev": 80},
    )
    return (float(found.x[0]), float(found.x[1])), float(found.fun)


def _unit(places: FloatArray, geometry: Geometry, depth: float, ratio: float) -> FloatArray:
    """Readings times E of 1 N at each place; what was pressed several times running is computed once."""
    out = np.zeros((len(places), *geometry.shape))
    for k, (x, s) in enumerate(places):
        if k and (places[k] == places[k - 1]).all():
            out[k] = out[k - 1]
        else:
            add_force(out[k], (1.0, 0.0, 0.0), (float(x), float(s)), geometry.pitch, geometry.half, depth, ratio)
    return out


def _gains(Z: FloatArray, U: FloatArray, hold: float) -> tuple[float, FloatArray]:
    """1/E and the gains that leave least of Z = gain U / E; the more they are held, the more they are one."""
    known = np.isfinite(Z)
    z, u = np.where(known, Z, 0.0), np.where(known, U, 0.0)
    scale = float((z * u).sum() / max(float((u * u).sum()), 1e-300))
    v = scale * u
    read = (v * v).sum(axis=0)
    if math.isinf(hold):
        return scale, np.ones(Z.shape[1:])
    weight = hold * float(np.median(read)) + 1e-300
    gains: FloatArray = ((z * v).sum(axis=0) + weight) / (read + weight)
    return scale, gains


def save_array(path: str | Path, model: ArrayModel, facts: dict[str, Any]) -> None:
    """Write a model without pickle, whole or not at all."""
    known = {"geometry": asdict(model.geometry), "rubber": asdict(model.rubber)}
    save_model(path, kind=KIND, facts=known | facts, arrays={"gains": model.gains})


def load_array(path: str | Path) -> tuple[ArrayModel, dict[str, Any]]:
    """Read a model and what is known of it.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or it is damaged.
    """
    saved = load_model(path, kind=KIND)
    facts = dict(saved.facts)
    try:
        geometry, rubber = Geometry(**facts.pop("geometry")), Rubber(**facts.pop("rubber"))
        gains = np.asarray(saved.arrays["gains"], dtype=float)
        sound = rubber.young > 0 and 0 <= rubber.poisson <= 0.5 and gains.shape == geometry.shape and bool((gains > 0).all())
    except (KeyError, TypeError, ValueError) as fault:
        raise InputError(f"{path} is not a whole model of an array ({fault}); train it again") from fault
    if not sound:
        least = f", the least {gains.min():.3g}" if gains.size else ""
        raise InputError(
            f"{path}: gains of {gains.shape}{least} on {geometry.shape} tactels, E {rubber.young}, are no array; train it again"
        )
    return ArrayModel(geometry, rubber, gains), facts
