"""A rod on the finger, found by the skin's own answer to a line of pressure: place, direction, length and force that fit best.

The pressure falls as a parabola to zero at the ends of the line. Its length is found with the rest, as no law of contact is known well
enough; but it is no shorter than the width that the seed's equation 11 gives for the found force, because a line that is nearly a
point may lie any way. A direction is not sure where its standard deviation is large, or where another one, or a contact without any
(`skinfab.fingertip.array.spot_fit`), explains the frame as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.interpolate import SINC
from skinfab.fingertip.array.least_squares import normal_equations, solve
from skinfab.fingertip.array.matched import ArrayModel, Matcher, skin_of
from skinfab.fingertip.array.orientation import Orientation, folded
from skinfab.fingertip.array.peak import find, highest, without_nan
from skinfab.fingertip.array.response import add_force, normal_window
from skinfab.fingertip.array.simulator import LONGEST_MM, STRETCH, contact_line, line_nodes
from skinfab.fingertip.array.spot_fit import Spot, SpotFinder
from skinfab.tolerances import LINE_BETTER, LINE_RIVAL, LINE_STEP_RAD, LINE_UNSURE_RAD, NEWTON_TACTELS, PEAK_FLAT

FloatArray = NDArray[np.float64]

#: Points that stand for the line, directions and lengths that are tried first (mm).
_NODES, _DIRECTIONS, _LENGTHS = 7, 8, (6.0, 12.0)
_FIRST_STEPS, _SECTORS, _STEPS = 3, 8, 25
#: Before the force is known no contact is shorter, mm.
_SHORTEST_MM = 4.0
#: Tactels so far around are compared, mm, and two to either side at least.
_AROUND_MM, _AROUND = 10.0, 2


@dataclass(frozen=True)
class Line:
    """A line of contact.

    Parameters
    ----------
    axial_mm, angle_rad : float
        Its middle.
    line_rad : float
        From across the finger, -pi/2 to pi/2; on the skin's outside.
    length_mm, force_n : float
    line_sd_rad : float
        Standard deviation of the direction, from what is left unexplained.
    unexplained : float
    ambiguous : bool
        Another direction, or a contact without any, explains the frame as well.
    """

    axial_mm: float
    angle_rad: float
    line_rad: float
    length_mm: float
    force_n: float
    line_sd_rad: float
    unexplained: float
    ambiguous: bool

    @property
    def orientation(self) -> Orientation:
        """Its direction; sure where its standard deviation is small."""
        ratio = LINE_UNSURE_RAD / max(self.line_sd_rad, 1e-6)
        return Orientation(self.line_rad, 1 + ratio, self.line_sd_rad < LINE_UNSURE_RAD and not self.ambiguous)


@numba.njit(cache=True)
def _residual(
    Z: FloatArray,
    gains: FloatArray,
    p: FloatArray,
    nodes: FloatArray,
    skin: tuple[float, float, float, float, float, float],
    shrink: float,
    window: tuple[int, int, int, int],
    one: FloatArray,
    r: FloatArray,
    J: FloatArray,
) -> float:
    """Readings less those of the line p (as `start` of `fit_line`): r and its derivatives J; the sum of squares."""
    first_i, rows, first_j, columns = window
    px, py, hx, hy, z, nu = skin
    stripes = Z.shape[1]
    for m in range(5):
        for e in range(rows * columns):
            J[m, e] = 0.0
    c, s = math.cos(p[2]), math.sin(p[2])
    for k in range(nodes.shape[1]):
        t = nodes[0, k] * p[3]
        normal_window(one, window, (p[0] + t * s, p[1] + t * c * shrink), (px, py), (hx, hy), z, nu)
        for a in range(rows):
            for b in range(columns):
                e = a * columns + b
                w = nodes[1, k]
                value, dx, dy = w * one[0, a, b], w * one[1, a, b] * p[4], w * one[2, a, b] * p[4]
                J[0, e] += dx
                J[1, e] += dy
                J[2, e] += dx * t * c - dy * t * s * shrink
                J[3, e] += nodes[0, k] * (dx * s + dy * c * shrink)
                J[4, e] += value
    cost = 0.0
    for a in range(rows):
        for b in range(columns):
            i, j, e = first_i + a, (first_j + b) % stripes, a * columns + b
            g = gains[i, j] if math.isfinite(Z[i, j]) else 0.0
            for m in range(5):
                J[m, e] *= g
            r[e] = Z[i, j] - p[4] * J[4, e] if g != 0.0 else 0.0
            cost += r[e] * r[e]
    return cost


@numba.njit(cache=True)
def fit_line(
    Z: FloatArray,
    gains: FloatArray,
    start: FloatArray,
    nodes: FloatArray,
    skin: tuple[float, float, float, float, float, float],
    shrink: float,
    lengths: tuple[float, float],
    tolerance: float,
    steps: int,
) -> tuple[FloatArray, float, float, int]:
    """The line of least squares from a start: its parameters, what it leaves (sum of squares), the direction's variance, tactels compared.

    Parameters
    ----------
    Z, gains : (rings, stripes) float
        A gain of 0 leaves a tactel out.
    start : (5,) float
        mm along, mm around the core, rad, half length in mm, force over Young's modulus in mm^2.
    nodes : (2, n) float
        Places on -1 to 1, and shares of the force.
    skin : tuple of float
        `skinfab.fingertip.array.matched.skin_of`.
    shrink : float
        mm on the core a mm on the outside.
    lengths : tuple of float
        Least and largest half length.
    tolerance : float, rad
    steps : int
        At most.
    """
    rings, stripes = Z.shape
    reach = max(math.floor(_AROUND_MM / skin[1] + 0.5), _AROUND)
    columns = min(2 * reach + 1, stripes)
    window = (0, rings, math.floor(start[1] / skin[1] + 0.5) - columns // 2, columns)
    n = rings * columns
    one, r, J = np.empty((3, rings, columns)), np.empty(n), np.empty((5, n))
    r_new, J_new = np.empty(n), np.empty((5, n))
    at, trial, lam = start.copy(), start.copy(), 1e-3
    cost = _residual(Z, gains, at, nodes, skin, shrink, window, one, r, J)
    A, b, s = np.empty((5, 5)), np.empty(5), np.empty(5)
    for _ in range(steps):
        normal_equations(J, r, lam, A, b)
        if (at[3] <= lengths[0] and b[3] < 0) or (at[3] >= lengths[1] and b[3] > 0):
            # At its bound the length stays, and the others go on without it.
            for i in range(5):
                A[3, i] = A[i, 3] = 0.0
            A[3, 3], b[3] = 1.0, 0.0
        solve(A, b, s)
        far = max(abs(s[0]) / (0.6 * skin[0]), abs(s[1]) / (0.6 * skin[1]), abs(s[2]) / 0.4, abs(s[3]) / 3.0, 1.0)
        for i in range(5):
            trial[i] = at[i] + s[i] / far
        trial[3] = min(max(trial[3], lengths[0]), lengths[1])
        new = _residual(Z, gains, trial, nodes, skin, shrink, window, one, r_new, J_new)
        if new < cost:
            moved = max(abs(trial[2] - at[2]), abs(trial[0] - at[0]) / skin[0], abs(trial[1] - at[1]) / skin[1])
            small = cost - new < 1e-7 * cost
            cost, lam = new, lam * 0.1
            at, trial = trial, at
            r, r_new = r_new, r
            J, J_new = J_new, J
            if moved < tolerance or small:
                break
        else:
            lam *= 10
            if lam > 1e6:
                break
    normal_equations(J, r, 1e-9, A, b)
    for i in range(5):
        b[i] = 0.0
    b[2] = 1.0
    solve(A, b, s)
    return at, cost, s[2] * cost / max(n - 5, 1), n


class LineFinder:
    """Finds the line of contact of frame after frame.

    Parameters
    ----------
    model : ArrayModel
    floor : float
        A frame whose highest tactel reads less has no contact.
    noise : float
        Standard deviation of a reading: a direction is no surer than this allows.

    Examples
    --------
    >>> from skinfab.fingertip.array.geometry import Geometry
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> Z = Skin(seed).lined(2.0, axial_mm=13.0, angle_rad=0.2, line_rad=math.radians(50))
    >>> line = LineFinder(ArrayModel.nominal(seed))(Z)
    >>> round(math.degrees(line.line_rad), 1), round(line.force_n, 2)
    (50.0, 2.0)
    """

    def __init__(self, model: ArrayModel, *, floor: float = 0.0, noise: float = 0.0) -> None:
        self.model, self._floor, self._noise = model, floor, noise
        self._matcher, self._spots = Matcher(model), SpotFinder(model)
        g = model.geometry
        self._nodes = np.array(line_nodes(2.0, _NODES))
        self._shrink = g.core_radius / g.finger_radius
        self._skin = skin_of(model)

    def __call__(self, Z: FloatArray, rivals: Sequence[Spot] = ()) -> Line | None:
        """The line of a frame's deflections (rings, stripes), and the contacts without a direction that explain it as well, where known.

        None where nothing touches it.
        """
        top = highest(Z)
        if not top > self._floor:
            return None
        m, g = self.model, self.model.geometry
        known = without_nan(Z)
        x, y, _, _, _ = find(known, known, SINC, 0.0, NEWTON_TACTELS, PEAK_FLAT)
        (p, cost, variance, used), ambiguous = self._best(Z, x * g.ring_pitch, y * g.stripe_pitch, top)
        # Where there is next to nothing left, the noise that is known of still moves the line.
        floor = self._noise**2 * (used - 5)
        line = Line(
            float(p[0]),
            math.remainder(float(p[1]) / g.core_radius, math.tau),
            folded(float(p[2])),
            float(2 * p[3]),
            float(p[4]) * m.rubber.young,
            math.sqrt(max(variance, 0.0) * (max(cost, floor) / cost if cost > 0 else 1.0)),
            cost / max(float((known * known).sum()), 1e-300),
            ambiguous,
        )
        return line if ambiguous else replace(line, ambiguous=not all(self.better(Z, line, spot) for spot in rivals or self.rivals(Z)))

    def rivals(self, Z: FloatArray) -> tuple[Spot, Spot]:
        """The force on a point, not only normal, and the patch that are most like a frame; the frame must hold a finite reading."""
        x, s, force, *_ = self._matcher.one(Z)
        start = (x, s / self.model.geometry.core_radius, force)
        return self._spots.push(Z, start), self._spots.patch(Z, start)

    def better(self, Z: FloatArray, line: Line, spot: Spot) -> bool:
        """Whether a line leaves less of a frame than a spot does by more than noise and gains may."""
        of_line, of_spot = (float(np.nansum((Z - made) ** 2)) for made in (self.predicted(line), self._spots.predicted(spot)))
        return of_spot - of_line > max(LINE_RIVAL * self._noise**2, LINE_BETTER * of_line)

    def predicted(self, line: Line) -> FloatArray:
        """The deflections of a line by the model, (rings, stripes)."""
        m, g = self.model, self.model.geometry
        out = np.zeros(g.shape)
        for t, share in self._nodes.T:
            along = line.axial_mm + t * line.length_mm / 2 * math.sin(line.line_rad)
            around = line.angle_rad * g.core_radius + t * line.length_mm / 2 * math.cos(line.line_rad) * self._shrink
            add_force(out, (line.force_n * share, 0.0, 0.0), (along, around), g.pitch, g.half, g.skin, m.rubber.poisson)
        return out * m.gains / m.rubber.young

    def _best(self, Z: FloatArray, x: float, s: float, top: float) -> tuple[tuple[FloatArray, float, float, int], bool]:
        """Starts in all directions go a few steps; the best of each sector is followed to its end. And whether two are as good."""
        m, g = self.model, self.model.geometry
        fixed = (self._nodes, self._skin, self._shrink)
        # A force on a point reads about this much over the tactel below it.
        height = top * 2 * math.pi * g.skin**2 / 3
        begun = []
        for k in range(_DIRECTIONS):
            for length in _LENGTHS:
                start = np.array([x, s, math.pi * k / _DIRECTIONS, length / 2, height])
                begun.append(fit_line(Z, m.gains, start, *fixed, (_SHORTEST_MM / 2, LONGEST_MM / 2), LINE_STEP_RAD, _FIRST_STEPS))
        force = max(min(begun, key=lambda each: each[1])[0][4] * m.rubber.young, 0.0)
        shortest = min(contact_line(force, 0.0, g.finger_radius) / STRETCH, LONGEST_MM / 2)
        ends = []
        per_sector = len(begun) // _SECTORS
        for k in range(_SECTORS):
            start = min(begun[k * per_sector : (k + 1) * per_sector], key=lambda each: each[1])[0]
            start[3] = max(start[3], shortest / 2)
            ends.append(fit_line(Z, m.gains, start, *fixed, (shortest / 2, LONGEST_MM / 2), LINE_STEP_RAD, _STEPS))
        ends.sort(key=lambda each: each[1])
        best, rest = ends[0], ends[1:]
        per = max(best[1] / max(best[3] - 5, 1), self._noise**2)
        rivals = (each for each in rest if each[1] - best[1] < LINE_RIVAL * per)
        return best, any(abs(folded(float(each[0][2] - best[0][2]))) > 4 * LINE_UNSURE_RAD for each in rivals)
