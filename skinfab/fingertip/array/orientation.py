"""Which way a rod lies on the finger: the seed's way by the contour at three quarters of the peak, and by the skin's own answer.

Angles count from across the finger (0) to along it (90 degrees), between -90 and 90, on the skin's outside.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.contours import contour
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.interpolate import Coefficients, on_grid
from skinfab.fingertip.array.peak import Peak, PeakFinder

FloatArray = NDArray[np.float64]

#: The seed's contour, and how much longer than wide it has to be to point anywhere: rounder ones are mistaken by up to 90 degrees.
PART, LEAST_RATIO = 0.75, 1.15


@dataclass(frozen=True)
class Orientation:
    """The direction of a line of contact.

    Parameters
    ----------
    line_rad : float
        From across the finger, -pi/2 to pi/2; NaN where there is none.
    ratio : float
        Length over width of what was looked at; near 1 it points nowhere.
    sure : bool
    """

    line_rad: float
    ratio: float
    sure: bool


def folded(angle: float) -> float:
    """A line's angle between -pi/2 and pi/2.

    Examples
    --------
    >>> round(math.degrees(folded(math.radians(100))), 6)
    -80.0
    """
    return angle - math.pi * math.floor(angle / math.pi + 0.5)


def line_of_ends(half_length_mm: float, width_mm: float) -> float:
    """gamma = atan(2 z_e / w) of the ends of a rod's contact (the seed's equation 12).

    Examples
    --------
    >>> round(math.degrees(line_of_ends(3.75, 7.5)), 1)
    45.0
    """
    return math.atan2(2 * half_length_mm, width_mm)


def contact_width(dent_mm: float, radius_mm: float) -> float:
    """w = 2 sqrt(d (2 r - d)) (the seed's first equation 11).

    Raises
    ------
    InputError
        The dent is deeper than the finger.

    Examples
    --------
    >>> round(contact_width(0.6, 12.7), 2)  # the seed prints 7.5
    7.71
    """
    if not 0 <= dent_mm <= 2 * radius_mm:
        raise InputError(f"a dent of {dent_mm:g} mm in a finger of radius {radius_mm:g} mm is none; give one from 0 to {2 * radius_mm:g}")
    return 2 * math.sqrt(dent_mm * (2 * radius_mm - dent_mm))


def worst_error(half_length_mm: float, width_mm: float, half_length_error_mm: float, width_error_mm: float) -> float:
    """What errors of the ends do to the angle at worst, rad (the seed's equation 14, both parts against each other).

    Examples
    --------
    >>> w = 7.5 * math.cos(math.pi / 4)
    >>> round(math.degrees(worst_error(3.75, 7.5, 0.5, 4.6)), 1)
    21.4
    """
    parts = abs(width_mm * half_length_error_mm) + abs(half_length_mm * width_error_mm)
    return parts / 2 / ((width_mm / 2) ** 2 + half_length_mm**2)


@numba.njit(cache=True)
def _span(points: FloatArray) -> tuple[float, float, float]:
    """The two points farthest apart: their difference, and the extent across it."""
    best, dx, dy = -1.0, 0.0, 0.0
    for a in range(len(points)):
        for b in range(a):
            u, v = points[a, 0] - points[b, 0], points[a, 1] - points[b, 1]
            if u * u + v * v > best:
                best, dx, dy = u * u + v * v, u, v
    length = math.sqrt(best)
    low, high = math.inf, -math.inf
    for a in range(len(points)):
        across = (points[a, 0] * dy - points[a, 1] * dx) / max(length, 1e-300)
        low, high = min(low, across), max(high, across)
    return dx, dy, high - low


class SpanFinder:
    """The seed's way: the longest span of the contour at 75 % of the peak.

    The seed does not say at which radius a length around is measured. On the core it errs least.

    Parameters
    ----------
    geometry : Geometry

    Examples
    --------
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> Z = Skin(seed).lined(2.0, axial_mm=11.1, angle_rad=0.0, line_rad=math.radians(90))
    >>> found = SpanFinder(seed)(Z)
    >>> round(abs(math.degrees(found.line_rad))), found.sure
    (90, True)
    """

    def __init__(self, geometry: Geometry) -> None:
        self.geometry = geometry
        self._coefficients = Coefficients("sinc", geometry.shape)
        self._peaks = PeakFinder(geometry, "sinc")

    def outline(self, Z: FloatArray) -> FloatArray:
        """The contour at 75 %, (n, 2), mm along and mm around on the core, where the tactels are; empty where there is none."""
        Z = np.where(np.isfinite(Z), Z, 0.0)
        C = self._coefficients(Z)
        peak = self._highest(Z, C)
        if not peak.height > 0:
            return np.empty((0, 2))
        points, _ = contour(C, self._coefficients.kind, self.geometry, peak, part=PART)
        return points * np.array([1.0, self.geometry.core_radius])

    def _highest(self, Z: FloatArray, C: FloatArray) -> Peak:
        """The peak; where the top is flat, or at the end, the highest place of a fine raster around it."""
        peak = self._peaks(Z)
        if peak.state in ("peak", "none"):
            return peak
        x, y = self.geometry.to_tactels(peak.axial_mm, peak.angle_rad)
        xs = np.linspace(max(x - 3, 0), min(x + 3, len(Z) - 1), 61)
        ys = np.linspace(y - 2, y + 2, 41)
        f = on_grid(C, self._coefficients.kind, xs, ys)
        a, b = np.unravel_index(int(f.argmax()), f.shape)
        return Peak(*self.geometry.from_tactels(float(xs[a]), float(ys[b])), float(f[a, b]), peak.steps, "peak")

    def __call__(self, Z: FloatArray) -> Orientation:
        """The direction of a frame's contact."""
        points = self.outline(Z)
        if len(points) < 3:
            return Orientation(math.nan, 1.0, False)
        dx, dy, across = _span(points)
        ratio = math.hypot(dx, dy) / max(across, 1e-300)
        return Orientation(folded(math.atan2(dx, dy)), ratio, ratio >= LEAST_RATIO)


def combined(each: Sequence[Orientation]) -> Orientation:
    """The direction of one rod that several fingers feel: lines are averaged as doubled angles, long ones count for more.

    Raises
    ------
    InputError
        There is none.

    Examples
    --------
    >>> made = combined([Orientation(math.radians(a), 2.0, True) for a in (85, -85, 88)])
    >>> round(math.degrees(made.line_rad), 1)
    89.3
    """
    if not each:
        raise InputError("no finger feels the rod; give at least one direction")
    known = [one for one in each if math.isfinite(one.line_rad)]
    weights = [max(one.ratio - 1, 0.0) for one in known]
    if not sum(weights) > 0:
        return Orientation(math.nan, 1.0, False)
    c = sum(w * math.cos(2 * one.line_rad) for w, one in zip(weights, known, strict=True)) / sum(weights)
    s = sum(w * math.sin(2 * one.line_rad) for w, one in zip(weights, known, strict=True)) / sum(weights)
    ratio = 1 + math.hypot(c, s) * sum(weights) / len(weights)
    return Orientation(math.atan2(s, c) / 2, ratio, ratio >= LEAST_RATIO)
