"""A contact that is no line: a round patch of pressure, a force that also pulls along the skin, or both.

A ball or a fingertip presses on a disc, by Hertz's law with sqrt(1 - r^2/R^2) of its middle's pressure at r. A tactel array this coarse
takes a disc for a line if nothing else is offered to it. And everyday friction pulls on the skin, which a force that is only
normal does not explain. One fit serves all three; what is not asked for stays as it was at the start.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.least_squares import normal_equations, solve
from skinfab.fingertip.array.matched import ArrayModel, skin_of
from skinfab.fingertip.array.response import add_force, normal_window
from skinfab.tolerances import MATCH_MM

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Columns to either side that are compared: as far as `skinfab.fingertip.array.line_fit`.
_AROUND_MM, _AROUND = 10.0, 2
#: Most steps; the radius at the start and the largest that is told, mm; by how much a place is shifted for derivatives of shear, mm.
_STEPS, _RADIUS_MM, LARGEST_MM, _SHIFT_MM = 30, 2.5, 8.0, 1e-3
#: Points that stand for a disc: with half of them one of 6 mm leaves more than noise.
_RINGS, _SPOKES = 3, 8
#: And those, with their radius, that stand for what pulls along the skin.
_RING, _RING_RADIUS = 6, math.sqrt(0.4)
#: Parameters of the fit: mm along and around the core, radius, and the normal, axial and circumferential force over E.
PUSH, PATCH, BOTH = (0, 1, 3, 4, 5), (0, 1, 2, 3), (0, 1, 2, 3, 4, 5)


@dataclass(frozen=True)
class Spot:
    """A contact about a point.

    Parameters
    ----------
    axial_mm, angle_rad : float
        Its middle.
    radius_mm : float
        Of a disc, on the skin's outside; 0 of a point.
    force_n, along_n, around_n : float
        Normal, and pulling along the skin.
    """

    axial_mm: float
    angle_rad: float
    radius_mm: float
    force_n: float
    along_n: float = 0.0
    around_n: float = 0.0

    @property
    def tilt_rad(self) -> tuple[float, float]:
        """Angle of the force from the normal, along and around."""
        return math.atan2(self.along_n, self.force_n), math.atan2(self.around_n, self.force_n)


def disc_nodes() -> FloatArray:
    """Places on the unit disc and shares of the force, (3, 24): three rings, exact for polynomials up to the seventh degree.

    Examples
    --------
    >>> u, v, w = disc_nodes()
    >>> round(float(w.sum()), 9), round(float(w @ u**2), 9)  # Hertz's pressure: 1/5
    (1.0, 0.2)
    """
    from scipy.special import roots_jacobi

    # In m = r^2 the force is spread as sqrt(1 - m).
    t, w = roots_jacobi(_RINGS, 0.5, 0.0)
    r, share = np.sqrt((t + 1) / 2), w / w.sum()
    angle = 2 * math.pi * np.arange(_SPOKES) / _SPOKES
    turned = [angle + k * math.pi / _SPOKES for k in range(_RINGS)]
    rings = [(r[k] * np.cos(turned[k]), r[k] * np.sin(turned[k]), np.full(_SPOKES, share[k] / _SPOKES)) for k in range(_RINGS)]
    return np.hstack([np.array(ring) for ring in rings])


@numba.njit(cache=True)
def _sheared(
    out: FloatArray,
    at: tuple[float, float],
    radius: float,
    skin: tuple[float, float, float, float, float, float],
    shrink: float,
) -> None:
    """Readings times E of what pulls along the skin, 1 N axially (first) and 1 N around (second): (2, rings, stripes)."""
    px, py, hx, hy, z, nu = skin
    out[:] = 0.0
    # A ring of the disc's mean square radius is as good as the disc: what pulls is the smaller part.
    count = _RING if radius > 0.0 else 1
    for k in range(count):
        angle = 2 * math.pi * k / count
        place = (at[0] + _RING_RADIUS * radius * math.cos(angle), at[1] + _RING_RADIUS * radius * math.sin(angle) * shrink)
        add_force(out[0], (0.0, 1.0 / count, 0.0), place, (px, py), (hx, hy), z, nu)
        add_force(out[1], (0.0, 0.0, 1.0 / count), place, (px, py), (hx, hy), z, nu)


@numba.njit(cache=True)
def _residual(
    Z: FloatArray,
    gains: FloatArray,
    p: FloatArray,
    pulled: bool,
    nodes: FloatArray,
    skin: tuple[float, float, float, float, float, float],
    shrink: float,
    window: tuple[int, int, int, int],
    r: FloatArray,
    J: FloatArray,
) -> float:
    """Readings less those of the spot p: r and its derivatives J (6, n); the sum of squares."""
    first_i, rows, first_j, columns = window
    px, py, hx, hy, z, nu = skin
    stripes = Z.shape[1]
    J[:] = 0.0
    one = np.empty((3, rows, columns))
    for k in range(nodes.shape[1]):
        u, v, w = nodes[0, k], nodes[1, k] * shrink, nodes[2, k]
        normal_window(one, window, (p[0] + u * p[2], p[1] + v * p[2]), (px, py), (hx, hy), z, nu)
        for a in range(rows):
            for b in range(columns):
                e = a * columns + b
                dx, dy = w * one[1, a, b] * p[3], w * one[2, a, b] * p[3]
                J[0, e] += dx
                J[1, e] += dy
                J[2, e] += u * dx + v * dy
                J[3, e] += w * one[0, a, b]
    if pulled:
        here, there = np.empty((2, *Z.shape)), np.empty((2, *Z.shape))
        _sheared(here, (p[0], p[1]), p[2], skin, shrink)
        for m in range(2):
            moved = (p[0] + _SHIFT_MM, p[1]) if m == 0 else (p[0], p[1] + _SHIFT_MM)
            _sheared(there, moved, p[2], skin, shrink)
            for a in range(rows):
                for b in range(columns):
                    i, j, e = first_i + a, (first_j + b) % stripes, a * columns + b
                    change = p[4] * (there[0, i, j] - here[0, i, j]) + p[5] * (there[1, i, j] - here[1, i, j])
                    J[m, e] += change / _SHIFT_MM
        for a in range(rows):
            for b in range(columns):
                i, j, e = first_i + a, (first_j + b) % stripes, a * columns + b
                J[4, e], J[5, e] = here[0, i, j], here[1, i, j]
    cost = 0.0
    for a in range(rows):
        for b in range(columns):
            i, j, e = first_i + a, (first_j + b) % stripes, a * columns + b
            g = gains[i, j] if math.isfinite(Z[i, j]) else 0.0
            for m in range(6):
                J[m, e] *= g
            r[e] = Z[i, j] - p[3] * J[3, e] - p[4] * J[4, e] - p[5] * J[5, e] if g != 0.0 else 0.0
            cost += r[e] * r[e]
    return cost


@numba.njit(cache=True)
def fit_spot(
    Z: FloatArray,
    gains: FloatArray,
    start: FloatArray,
    free: NDArray[np.int64],
    nodes: FloatArray,
    skin: tuple[float, float, float, float, float, float],
    shrink: float,
    tolerance: float,
) -> tuple[FloatArray, float]:
    """The spot of least squares from a start, and what it leaves around it.

    Parameters
    ----------
    Z, gains : (rings, stripes) float
        A gain of 0 leaves a tactel out.
    start : (6,) float
        mm along, mm around the core, radius in mm, forces over Young's modulus in mm^2: normal, axial, around.
    free : (k,) int
        Which of these are fitted.
    nodes : (3, n) float
        Places on the unit disc, and shares of the force.
    skin : tuple of float
        `skinfab.fingertip.array.matched.skin_of`.
    shrink : float
        mm on the core a mm on the outside.
    tolerance : float, mm
    """
    rings, stripes = Z.shape
    columns = min(2 * max(math.floor(_AROUND_MM / skin[1] + 0.5), _AROUND) + 1, stripes)
    window = (0, rings, math.floor(start[1] / skin[1] + 0.5) - columns // 2, columns)
    n, k = rings * columns, len(free)
    pulled = free[k - 1] == 5
    r, J, r_new, J_new, J_free = np.empty(n), np.empty((6, n)), np.empty(n), np.empty((6, n)), np.empty((k, n))
    A, b, s = np.empty((k, k)), np.empty(k), np.empty(k)
    at, trial, lam = start.copy(), start.copy(), 1e-3
    cost = _residual(Z, gains, at, pulled, nodes, skin, shrink, window, r, J)
    for _ in range(_STEPS):
        for m in range(k):  # loops here too: J[free] and trial[:] = at take 4 s to compile
            for e in range(n):
                J_free[m, e] = J[free[m], e]
        normal_equations(J_free, r, lam, A, b)
        solve(A, b, s)
        far = 1.0
        for m in range(k):
            if free[m] < 3:
                far = max(far, abs(s[m]) / (2.0 if free[m] == 2 else 0.6 * skin[free[m]]))
        moved = 0.0
        for m in range(k):
            trial[free[m]] = at[free[m]] + s[m] / far
        trial[2] = min(max(trial[2], 0.0), LARGEST_MM)
        for m in range(3):
            moved = max(moved, abs(trial[m] - at[m]))
        new = _residual(Z, gains, trial, pulled, nodes, skin, shrink, window, r_new, J_new)
        if new < cost:
            cost, lam = new, lam * 0.1
            at, trial = trial, at
            r, r_new = r_new, r
            J, J_new = J_new, J
        else:
            lam *= 10
        for m in range(6):
            trial[m] = at[m]
        if moved < tolerance or lam > 1e8:
            break
    return at, cost


class SpotFinder:
    """Finds patches, and forces that pull along the skin.

    Parameters
    ----------
    model : ArrayModel

    Examples
    --------
    >>> from skinfab.fingertip.array.geometry import Geometry
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> Z = Skin(seed).pressed(0.5, axial_mm=13.0, angle_rad=0.3, shear_n=(0.1, -0.05))
    >>> push = SpotFinder(ArrayModel.nominal(seed)).push(Z, (12.6, 0.32, 0.4))
    >>> [round(value, 3) for value in (push.axial_mm, push.force_n, push.along_n, push.around_n)]
    [13.0, 0.5, 0.1, -0.05]
    """

    def __init__(self, model: ArrayModel) -> None:
        self.model = model
        g = model.geometry
        self._skin, self._shrink = skin_of(model), g.core_radius / g.finger_radius
        self._point, self._disc = np.array([[0.0], [0.0], [1.0]]), disc_nodes()

    def push(self, Z: FloatArray, start: tuple[float, float, float]) -> Spot:
        """The force on a point, not only normal, from a place (mm, rad) and a force (N) near it."""
        return self._fit(Z, start, PUSH, 0.0)

    def patch(self, Z: FloatArray, start: tuple[float, float, float], *, pulled: bool = False) -> Spot:
        """The disc that presses, or presses and pulls along the skin."""
        return self._fit(Z, start, BOTH if pulled else PATCH, _RADIUS_MM)

    def _fit(self, Z: FloatArray, start: tuple[float, float, float], free: tuple[int, ...], radius: float) -> Spot:
        m, core = self.model, self.model.geometry.core_radius
        begin = np.array([start[0], start[1] * core, radius, start[2] / m.rubber.young, 0.0, 0.0])
        nodes = self._disc if radius else self._point
        p, _ = fit_spot(Z, m.gains, begin, np.array(free), nodes, self._skin, self._shrink, MATCH_MM)
        force = (float(value) * m.rubber.young for value in p[3:])
        return Spot(float(p[0]), math.remainder(float(p[1]) / core, math.tau), float(p[2]), *force)

    def predicted(self, spot: Spot) -> FloatArray:
        """The deflections of a spot by the model, (rings, stripes)."""
        m, g = self.model, self.model.geometry
        out, pulled = np.zeros(g.shape), np.zeros((2, *g.shape))
        at = (spot.axial_mm, spot.angle_rad * g.core_radius)
        for u, v, share in (self._disc if spot.radius_mm > 0 else self._point).T:
            place = (at[0] + u * spot.radius_mm, at[1] + v * spot.radius_mm * self._shrink)
            add_force(out, (spot.force_n * share, 0.0, 0.0), place, g.pitch, g.half, g.skin, m.rubber.poisson)
        if spot.along_n or spot.around_n:
            _sheared(pulled, at, spot.radius_mm, self._skin, self._shrink)
        return (out + spot.along_n * pulled[0] + spot.around_n * pulled[1]) * m.gains / m.rubber.young
