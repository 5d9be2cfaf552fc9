"""Lines of equal deflection, f = k, followed by a predictor and a corrector.

The seed prints that both slopes vanish on them (its equation 11), which they do only where a line shrinks to a point; its
direction (equation 12) has lost a quadrant: along a line it is atan2(-fx, fy).
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.interpolate import surface_at
from skinfab.fingertip.array.peak import Peak
from skinfab.tolerances import CONTOUR_HEIGHT

FloatArray = NDArray[np.float64]

#: Length of a step, tactels, and the most steps: a line round the whole finger is 50 tactels long.
STEP, _MOST = 0.05, 4000
_CORRECTIONS = 6


@numba.njit(cache=True)
def follow(C: FloatArray, kind: int, x: float, y: float, k: float, step: float, tolerance: float) -> tuple[FloatArray, bool]:
    """The line of height k from a point near it: its points (n, 2) in tactels, and whether it closes.

    It goes with the high side on its right. A line that leaves the array is followed from its start the other way as well. A closed
    line's first point is its last.
    """
    top = C.shape[0] - 1.0
    turn = float(C.shape[1])
    for way in (1.0, -1.0):
        points = np.empty((_MOST, 2))
        px, py, n, closed, left = x, y, 0, False, False
        for _ in range(_MOST):
            for _ in range(_CORRECTIONS):  # onto the line, by Newton along the slope
                f, fx, fy, _a, _b, _c = surface_at(C, kind, px, py)
                g = fx * fx + fy * fy
                if g == 0.0 or abs(f - k) < tolerance * abs(k):
                    break
                shift = (k - f) / g
                length = abs(shift) * math.sqrt(g)
                if length > 0.5:
                    shift *= 0.5 / length
                px, py = px + shift * fx, py + shift * fy
            f, fx, fy, _a, _b, _c = surface_at(C, kind, px, py)
            slope = math.hypot(fx, fy)
            if px < 0.0 or px > top or slope == 0.0 or abs(f - k) > 100 * tolerance * abs(k):
                left = True
                break
            points[n, 0], points[n, 1] = px, py
            n += 1
            if n > 3:
                dx, dy = px - points[0, 0], py - points[0, 1]
                round_it = abs(abs(dy) - turn) < 1e-9 + step and abs(dx) < step
                if math.hypot(dx, dy) < 0.75 * step or (round_it and abs(abs(dy) - turn) < 0.75 * step):
                    closed = True
                    break
            if n == _MOST:
                break
            px, py = px - way * step * fy / slope, py + way * step * fx / slope
        if way > 0:
            first, n_first = np.empty((n, 2)), n
            for m in range(n):
                first[m, 0], first[m, 1] = points[m, 0], points[m, 1]
            if closed or not left:
                if closed and n:
                    first[n - 1, 0] = first[0, 0]
                    if abs(first[n - 1, 1] - first[0, 1]) < turn / 2:
                        first[n - 1, 1] = first[0, 1]
                return first, closed
        elif n > 1:
            whole = np.empty((n_first + n - 1, 2))
            for m in range(n - 1):
                whole[m, 0], whole[m, 1] = points[n - 1 - m, 0], points[n - 1 - m, 1]
            for m in range(n_first):
                whole[n - 1 + m, 0], whole[n - 1 + m, 1] = first[m, 0], first[m, 1]
            return whole, False
    return first, False


def contour(C: FloatArray, kind: int, geometry: Geometry, peak: Peak, *, part: float) -> tuple[FloatArray, bool]:
    """The line around a peak at a part of its height.

    Parameters
    ----------
    C : (rings, stripes) float
        Coefficients of the interpolated deflection.
    kind : int
    geometry : Geometry
    peak : Peak
    part : float
        Of the peak's height, from 0 to 1.

    Returns
    -------
    points : (n, 2) float
        Axial place and angle (mm, rad; the angle goes on beyond pi). Empty where the height is not met on the way from the peak.
    closed : bool
        False for a line that leaves the array.

    Raises
    ------
    InputError
        The part is not between 0 and 1.
    """
    if not 0 < part < 1:
        raise InputError(f"a contour at {part:g} of the peak's height is none; give a part between 0 and 1")
    x, y = geometry.to_tactels(peak.axial_mm, peak.angle_rad)
    k = part * peak.height
    start = _outward(C, kind, x, y, k)
    if start is None:
        return np.empty((0, 2)), False
    points, closed = follow(C, kind, *start, k, STEP, CONTOUR_HEIGHT)
    return points * np.array([geometry.ring_pitch, 2 * math.pi / geometry.stripes]), bool(closed)


def _outward(C: FloatArray, kind: int, x: float, y: float, k: float) -> tuple[float, float] | None:
    """Where the surface first falls to k on the way from a peak: around, and where that does not end, along."""
    reach = np.arange(0.0, max(C.shape), 0.1)
    for dx, dy in ((0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)):
        for r in reach[1:]:
            if not 0 <= x + r * dx <= len(C) - 1 or r * abs(dy) > C.shape[1] / 2:
                break
            if surface_at(C, kind, x + r * dx, y + r * dy)[0] < k:
                return x + (r - 0.1) * dx, y + (r - 0.1) * dy
    return None


def enclosed(points: FloatArray) -> float:
    """Area inside a closed line, mm rad.

    Examples
    --------
    >>> enclosed(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0], [0.0, 0.0]]))
    2.0
    """
    x, y = points[:, 0], points[:, 1]
    return abs(float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))) / 2
