"""How surely a contact's place is told: its standard deviation by what the readings' own comes to in the fit.

Whatever was fitted with the place (force, pull, radius, a line's direction and length, other contacts) takes part; what a frame can
hardly tell of these is bounded by what is known before: a line has some length, a pull is a part of the force.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.line_fit import Line
from skinfab.fingertip.array.matched import Contact
from skinfab.fingertip.array.spot_fit import Spot

FloatArray = NDArray[np.float64]
Shape = TypeVar("Shape", Line, Spot)
What = TypeVar("What")

#: Steps of derivatives: mm, and rad; a force's is this part of it.
_STEP_MM, _STEP_RAD, _STEP_PART = 1e-3, 1e-4, 1e-3
#: What is known of each number before, as a standard deviation: places, radii and lengths in mm, rad, pulls as a part of the force.
_PLACE_MM, _RADIUS_MM, _LENGTH_MM, _LINE_RAD, _PULL_PART = 20.0, 3.0, 5.0, 1.0, 0.5

#: Above this, mm, a fit bends within its standard deviation; so many of these from the middle of a stripe it may lie there.
_CURVED_MM, _NEAR_SIGMAS = 0.2, 3.0


def of_points(
    Z: FloatArray, contacts: Sequence[Contact], predict: Callable[[Sequence[Contact]], FloatArray], geometry: Geometry, *, noise: float
) -> list[tuple[float, float]]:
    """Standard deviations of each contact's place, mm along and around on the skin's outside.

    Examples
    --------
    >>> from skinfab.fingertip.array.matched import ArrayModel, Matcher
    >>> seed = Geometry()
    >>> predict = Matcher(ArrayModel.nominal(seed)).predicted
    >>> between, above = (Contact(13.0, angle, 0.5) for angle in (math.pi / 8, 0.0))
    >>> [round(of_points(predict([one]), [one], predict, seed, noise=2e-4)[0][1], 2) for one in (between, above)]
    [0.04, 0.35]
    """
    found = _of_points(Z, contacts, predict, geometry, noise)
    out = []
    for k, (each, (along, around)) in enumerate(zip(contacts, found, strict=True)):
        if around > _CURVED_MM:
            # It may as well be over the middle of its stripe, where least is told, and only seem surer beside it.
            pitch = 2 * math.pi / geometry.stripes
            middle = replace(each, angle_rad=pitch * math.floor(each.angle_rad / pitch + 0.5))
            there = _of_points(Z, [*contacts[:k], middle, *contacts[k + 1 :]], predict, geometry, noise)[k][1]
            if abs(middle.angle_rad - each.angle_rad) * geometry.finger_radius < _NEAR_SIGMAS * there:
                around = max(around, there)
        out.append((along, around))
    return out


def _of_points(
    Z: FloatArray, contacts: Sequence[Contact], predict: Callable[[Sequence[Contact]], FloatArray], geometry: Geometry, noise: float
) -> list[tuple[float, float]]:
    """As it comes out of the slopes at the contacts."""
    steps = []
    for k, each in enumerate(contacts):
        others = list(contacts)
        for name, step, prior in _of_place(geometry, each.force_n):
            others[k] = replace(each, **{name: getattr(each, name) + step})
            steps.append((list(others), step, prior))
        others[k] = each
    sd = _deviations(Z, predict, contacts, steps, noise)
    return [(sd[3 * k], sd[3 * k + 1] * geometry.finger_radius) for k in range(len(contacts))]


def of_spot(Z: FloatArray, spot: Spot, predict: Callable[[Spot], FloatArray], geometry: Geometry, *, noise: float) -> tuple[float, float]:
    """The same of a patch, or of a force that pulls along the skin."""
    steps = _of_place(geometry, spot.force_n)
    if spot.radius_mm > 0:
        steps.append(("radius_mm", _STEP_MM, _RADIUS_MM))
    if spot.along_n or spot.around_n:
        steps += [(name, _STEP_PART * abs(spot.force_n), _PULL_PART * abs(spot.force_n)) for name in ("along_n", "around_n")]
    sd = _deviations(Z, predict, spot, [(_stepped(spot, name, step), step, prior) for name, step, prior in steps], noise)
    return sd[0], sd[1] * geometry.finger_radius


def of_line(Z: FloatArray, line: Line, predict: Callable[[Line], FloatArray], geometry: Geometry, *, noise: float) -> tuple[float, float]:
    """The same of the middle of a line."""
    steps = [*_of_place(geometry, line.force_n), ("line_rad", _STEP_RAD, _LINE_RAD), ("length_mm", _STEP_MM, _LENGTH_MM)]
    sd = _deviations(Z, predict, line, [(_stepped(line, name, step), step, prior) for name, step, prior in steps], noise)
    return sd[0], sd[1] * geometry.finger_radius


def _of_place(geometry: Geometry, force_n: float) -> list[tuple[str, float, float]]:
    """Numbers of any contact: name, step, and what is known before."""
    force = max(abs(force_n), 1e-9)
    return [
        ("axial_mm", _STEP_MM, _PLACE_MM),
        ("angle_rad", _STEP_MM / geometry.finger_radius, _PLACE_MM / geometry.finger_radius),
        ("force_n", _STEP_PART * force, 10 * force),
    ]


def _stepped(one: Shape, name: str, step: float) -> Shape:
    return replace(one, **{name: getattr(one, name) + step})


def _deviations(
    Z: FloatArray, predict: Callable[[What], FloatArray], at: What, steps: Sequence[tuple[What, float, float]], noise: float
) -> list[float]:
    """Standard deviations of what is stepped: noise, or what is left of the frame where that is more, through the inverse of J^T J."""
    known, made = np.isfinite(Z), predict(at)
    J = np.array([((predict(other) - made) / step)[known] for other, step, _ in steps])
    left = float(((Z - made)[known] ** 2).sum()) / max(int(known.sum()) - len(steps), 1)
    variance = max(noise**2, left)
    if not variance > 0:
        return [0.0] * len(steps)
    prior = np.array([prior for *_, prior in steps])
    # In units of what is known before the matrix is well scaled.
    A = (J * prior[:, None]) @ (J * prior[:, None]).T / variance + np.eye(len(steps))
    return [math.sqrt(value) for value in (np.linalg.inv(A).diagonal() * prior**2).tolist()]
