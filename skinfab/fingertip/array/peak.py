"""Where the interpolated deflection is largest: Newton's method with a trust region, and what to make of it.

The seed asks for both slopes to vanish and both second derivatives to be negative (its equation 8), which a saddle fulfils as
well: the determinant of the second derivatives has to be positive too. Its bare Newton steps run into saddles and leave the
array; here a step goes no farther than half a tactel, is taken only uphill, and goes along the slope where the surface does not
bend down both ways.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.interpolate import Coefficients, surface_at
from skinfab.tolerances import NEWTON_TACTELS, PEAK_FLAT, PEAK_OTHER

FloatArray = NDArray[np.float64]

#: Longest step, tactels; and the most steps.
_RADIUS, _STEPS = 0.5, 40
#: What became of a search, by number.
STATES = ("peak", "edge", "flat", "lost", "none")
_PEAK, _EDGE, _FLAT, _LOST, _NONE = range(5)


@dataclass(frozen=True)
class Peak:
    """The largest deflection.

    Parameters
    ----------
    axial_mm, angle_rad : float
        NaN where there is none.
    height : float
        Of the surface there.
    steps : int
        Evaluations beyond the first.
    state : str
        ``peak``; ``edge``: it lies beyond the first or last ring, or could (the place is the last one on the array); ``flat``: three
        tactels or more in a row read nearly the same (the place is their middle), or one beside the highest reads nothing or is at the end
        of its range (the place is that with as much there); ``lost``: no peak within a tactel and a half of the highest; ``none``:
        nothing reads as much as was asked for.
    """

    axial_mm: float
    angle_rad: float
    height: float
    steps: int
    state: str


@numba.njit(cache=True)
def climb(Z: FloatArray, kind: int, x: float, y: float, tolerance: float) -> tuple[float, float, float, int, bool]:
    """From (x, y) to the next maximum: its place and height in tactel spacings, the steps, and whether it is one.

    Parameters
    ----------
    Z : (rings, stripes) float
        Coefficients.
    kind : int
    x, y : float
    tolerance : float
        The step at which to stop, tactels.
    """
    top = Z.shape[0] - 1.0
    radius = _RADIUS
    f, fx, fy, fxx, fxy, fyy = surface_at(Z, kind, x, y)
    for step in range(1, _STEPS):
        bends_down = fxx < 0 and fxx * fyy - fxy * fxy > 0
        if bends_down:
            D = fxx * fyy - fxy * fxy
            dx, dy = -(fyy * fx - fxy * fy) / D, -(fxx * fy - fxy * fx) / D
        else:
            slope = math.hypot(fx, fy)
            if slope == 0.0:  # a saddle's middle, or a plain: no way is up
                return x, y, f, step - 1, False
            dx, dy = radius * fx / slope, radius * fy / slope
        length = math.hypot(dx, dy)
        if length > radius:
            dx, dy, length = dx * radius / length, dy * radius / length, radius
        nx = min(max(x + dx, 0.0), top)
        g, gx, gy, gxx, gxy, gyy = surface_at(Z, kind, nx, y + dy)
        if g < f - 1e-12 * abs(f):
            radius = length / 4
            if radius < tolerance / 16:
                return x, y, f, step, bends_down
            continue
        moved = math.hypot(nx - x, dy)
        x, y, f, fx, fy, fxx, fxy, fyy = nx, y + dy, g, gx, gy, gxx, gxy, gyy
        if moved < tolerance:
            return x, y, f, step, fxx < 0 and fxx * fyy - fxy * fxy > 0
    return x, y, f, _STEPS, False


@numba.njit(cache=True)
def without_nan(Z: FloatArray) -> FloatArray:
    """A copy in which NaN is 0."""
    out = np.empty(Z.shape)
    for i in range(Z.shape[0]):
        for j in range(Z.shape[1]):
            out[i, j] = Z[i, j] if math.isfinite(Z[i, j]) else 0.0
    return out


@numba.njit(cache=True)
def highest(Z: FloatArray) -> float:
    """The highest reading; NaN where there is none."""
    top = math.nan
    for i in range(Z.shape[0]):
        for j in range(Z.shape[1]):
            if not Z[i, j] <= top and math.isfinite(Z[i, j]):
                top = Z[i, j]
    return top


@numba.njit(cache=True)
def _row(Z: FloatArray, i: int, j: int, di: int, dj: int, least: float) -> int:
    """How many tactels in a row, that one among them, read at least so much."""
    rings, stripes = Z.shape
    count = 1
    for sign in (-1, 1):
        for k in range(1, max(rings, stripes)):
            a, b = i + sign * k * di, (j + sign * k * dj) % stripes
            if a < 0 or a >= rings or Z[a, b] < least or count >= max(rings, stripes):
                break
            count += 1
    return count


@numba.njit(cache=True)
def find(Z: FloatArray, C: FloatArray, kind: int, floor: float, tolerance: float, flat: float) -> tuple[float, float, float, int, int]:
    """From the highest tactel of readings `Z`, coefficients `C`: ring, stripe, height, steps, state."""
    rings, stripes = Z.shape
    top, bi, bj = -math.inf, 0, 0
    for i in range(rings):
        for j in range(stripes):
            if Z[i, j] > top:
                top, bi, bj = Z[i, j], i, j
    if not top >= floor:  # NaN reads nothing either
        return math.nan, math.nan, math.nan, 0, _NONE
    along, around = _row(Z, bi, bj, 1, 0, flat * top), _row(Z, bi, bj, 0, 1, flat * top)
    if along >= 3 or around >= 3:
        x, y = _middle(Z, bi, bj, flat * top)
        return x, y, surface_at(C, kind, x, y)[0], 0, _FLAT
    x, y, f, steps, found = climb(C, kind, float(bi), float(bj), tolerance)
    if abs(x - bi) > 1.5 or abs(y - bj) > 1.5:
        return x, y, f, steps, _LOST
    if x <= 0.0 or x >= rings - 1.0 or ((bi == 0 or bi == rings - 1) and not found):
        return x, y, f, steps, _EDGE
    return x, y, f, steps, _PEAK if found else _LOST


@numba.njit(cache=True)
def _middle(Z: FloatArray, bi: int, bj: int, least: float) -> tuple[float, float]:
    """Of the tactels that read at least so much, as seen from the highest."""
    rings, stripes = Z.shape
    n, sx, sy = 0, 0.0, 0.0
    for i in range(rings):
        for j in range(stripes):
            if Z[i, j] >= least:
                d = (j - bj + stripes // 2) % stripes - stripes // 2
                n, sx, sy = n + 1, sx + i, sy + bj + d
    return sx / n, sy / n


class PeakFinder:
    """Finds the peak of frame after frame by one interpolator.

    Parameters
    ----------
    geometry : Geometry
    method : str
        ``sinc`` (the seed's), ``bspline`` or ``gaussian``.
    floor : float
        A frame whose highest tactel reads less has no peak.

    Examples
    --------
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> peak = PeakFinder(seed)(Skin(seed).pressed(0.5, axial_mm=11.1, angle_rad=0.0))
    >>> round(peak.axial_mm, 6), round(peak.angle_rad, 6), peak.state  # on a tactel the interpolated peak is exact
    (11.1, 0.0, 'peak')
    """

    def __init__(self, geometry: Geometry, method: str = "sinc", *, floor: float = 0.0) -> None:
        self.geometry = geometry
        self._coefficients = Coefficients(method, geometry.shape)
        self._kind, self._floor = self._coefficients.kind, floor

    def __call__(self, Z: FloatArray) -> Peak:
        """The peak of a frame's deflections (rings, stripes).

        Tactels that are NaN count as not deflected, but beside the highest one as much as that: there may be the summit.
        """
        beside = self._missing_beside_the_highest(Z)
        x, y, height, steps, state = self.tactels(np.where(beside, highest(Z), Z) if beside.any() else Z)
        state = _FLAT if beside.any() and state != _NONE else state
        axial, angle = self.geometry.from_tactels(x, y) if state != _NONE else (math.nan, math.nan)
        return Peak(axial, angle, height, steps, STATES[state])

    def _missing_beside_the_highest(self, Z: FloatArray) -> NDArray[np.bool_]:
        missing: NDArray[np.bool_] = ~np.isfinite(Z)
        if not missing.any() or missing.all():
            return np.zeros(Z.shape, dtype=bool)
        i, j = np.unravel_index(int(np.where(missing, -np.inf, Z).argmax()), Z.shape)
        ring, stripe = np.arange(len(Z)) - i, (np.arange(Z.shape[1]) - j + 1) % Z.shape[1]
        return missing & (np.abs(ring) <= 1)[:, None] & (stripe <= 2)

    def tactels(self, Z: FloatArray) -> tuple[float, float, float, int, int]:
        """The same as bare numbers: ring, stripe, height, steps, and the number of the state in `STATES`."""
        Z = without_nan(Z)
        found: tuple[float, float, float, int, int] = find(Z, self._coefficients(Z), self._kind, self._floor, NEWTON_TACTELS, PEAK_FLAT)
        return found

    def all(self, Z: FloatArray) -> tuple[Peak, ...]:
        """Every peak of at least a third of the highest one's height, the highest first: several contacts far enough apart.

        Contacts less than two tactels apart have one peak between them; `skinfab.fingertip.array.matched` tells those.
        """
        Z = without_nan(Z)
        C = self._coefficients(Z)
        floor = max(self._floor, PEAK_OTHER * float(Z.max()))
        found: list[Peak] = []
        for i, j in np.argwhere(_local_maxima(Z) & (floor <= Z)):
            x, y, f, steps, is_one = climb(C, self._kind, float(i), float(j), NEWTON_TACTELS)
            if is_one and f >= floor:
                found.append(Peak(*self.geometry.from_tactels(x, y), f, steps, "edge" if x <= 0 or x >= len(Z) - 1 else "peak"))
        found.sort(key=lambda each: -each.height)
        apart = math.radians(360 / self.geometry.stripes / 2)
        kept: list[Peak] = []
        for each in found:
            if all(
                abs(each.axial_mm - one.axial_mm) > self.geometry.ring_pitch / 2
                or abs(math.remainder(each.angle_rad - one.angle_rad, math.tau)) > apart
                for one in kept
            ):
                kept.append(each)
        return tuple(kept)


def _local_maxima(Z: FloatArray) -> NDArray[np.bool_]:
    """Tactels that no neighbour exceeds; the second axis is closed."""
    padded = np.pad(Z, ((1, 1), (0, 0)), constant_values=-np.inf)
    out = np.ones(Z.shape, dtype=bool)
    for di in (-1, 0, 1):
        for dj in (-1, 0, 1):
            out &= np.roll(padded, -dj, axis=1)[1 + di : len(Z) + 1 + di] <= Z
    return out
