"""Contacts found by the skin's own answer: the forces and places whose computed readings are nearest to those read.

Interpolation takes each tactel for a point sample of a band-limited surface, which an array this coarse does not give: its peak is
off by up to 0.55 mm along and 12 degrees around. A model of what a tactel reads of a force, whole electrodes included, has no such
error; what is left is noise, and what the model does not know. It also says what its one force does not explain: two contacts that
have one peak between them, contacts beyond the end, and wide ones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.interpolate import SINC
from skinfab.fingertip.array.least_squares import normal_equations, solve
from skinfab.fingertip.array.peak import find, highest, without_nan
from skinfab.fingertip.array.response import add_force, normal_window
from skinfab.fingertip.array.simulator import Rubber
from skinfab.tolerances import (
    MATCH_APART,
    MATCH_MM,
    MATCH_UNEXPLAINED,
    NEWTON_TACTELS,
    PEAK_FLAT,
    SEVERAL_LIGHT,
    SEVERAL_OTHER,
    SEVERAL_TACTELS,
)

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Tactels so far from the force are compared, mm, and two to either side at least: beyond, the answer to a force is under its noise.
_REACH_MM, _REACH = 8.0, 2
#: Contacts that are told apart at most, and how often each is found anew in what the others leave.
_MOST, _ROUNDS = 4, 4
#: Most steps, and how far one may go, pitches.
_STEPS, _FARTHEST = 30, 0.6
#: A place so many pitches beyond the last ring's middle is no longer told from others.
_BEYOND = 0.75


@dataclass(frozen=True, eq=False)
class ArrayModel:
    """What is known of an array: its geometry, rubber, and the gain of each tactel.

    Parameters
    ----------
    geometry : Geometry
    rubber : Rubber
    gains : (rings, stripes) float
    """

    geometry: Geometry
    rubber: Rubber
    gains: FloatArray

    @classmethod
    def nominal(cls, geometry: Geometry) -> ArrayModel:
        """As drawn: every gain 1."""
        return cls(geometry, Rubber(), np.ones(geometry.shape))


@dataclass(frozen=True)
class Contact:
    """One force on the skin.

    Parameters
    ----------
    axial_mm, angle_rad : float
    force_n : float
    """

    axial_mm: float
    angle_rad: float
    force_n: float


@dataclass(frozen=True)
class Match:
    """The contacts that explain a frame.

    Parameters
    ----------
    contacts : tuple of Contact
        None, one or two, the strongest first.
    unexplained : float
        Sum of squares that is left, as a part of that of the readings compared.
    state : str
        ``one``; ``two``; ``edge``: beyond the first or last ring's middle, where only one side is read; ``past``: farther out than can
        be told; ``wide``: neither one nor two forces explain it; ``none``.
    steps : int
    """

    contacts: tuple[Contact, ...]
    unexplained: float
    state: str
    steps: int


@numba.njit(cache=True)
def _residual(
    Z: FloatArray,
    gains: FloatArray,
    at: FloatArray,
    window: tuple[int, int, int, int],
    skin: tuple[float, float, float, float, float, float],
    one: FloatArray,
    r: FloatArray,
    J: FloatArray,
) -> float:
    """Readings of the window less those of the forces: r and its derivatives J; the sum of squares."""
    first_i, p, first_j, q = window
    px, py, hx, hy, z, nu = skin
    stripes = Z.shape[1]
    for a in range(p):
        for c in range(q):
            i, j = first_i + a, (first_j + c) % stripes
            r[a * q + c] = Z[i, j] if gains[i, j] != 0.0 and math.isfinite(Z[i, j]) else 0.0
    for m in range(len(at)):
        normal_window(one, window, (at[m, 0], at[m, 1]), (px, py), (hx, hy), z, nu)
        for a in range(p):
            for c in range(q):
                i, j, e = first_i + a, (first_j + c) % stripes, a * q + c
                g = gains[i, j] if math.isfinite(Z[i, j]) else 0.0
                J[3 * m, e] = at[m, 2] * g * one[1, a, c]
                J[3 * m + 1, e] = at[m, 2] * g * one[2, a, c]
                J[3 * m + 2, e] = g * one[0, a, c]
                r[e] -= at[m, 2] * J[3 * m + 2, e]
    cost = 0.0
    for e in range(p * q):
        cost += r[e] * r[e]
    return cost


@numba.njit(cache=True)
def fit_forces(
    Z: FloatArray,
    gains: FloatArray,
    start: FloatArray,
    skin: tuple[float, float, float, float, float, float],
    tolerance: float,
) -> tuple[FloatArray, float, int, int]:
    """Forces and places with the least squares of what they leave of the readings around them.

    Levenberg and Marquardt's method.

    Parameters
    ----------
    Z, gains : (rings, stripes) float
        Deflections; a gain of 0 leaves a tactel out.
    start : (k, 3) float
        Axial place and place around on the core, mm, and force over Young's modulus, mm^2, of each.
    skin : tuple of float
        Both pitches, half of an electrode's sizes, the skin's depth, Poisson's ratio: `skin_of`.
    tolerance : float, mm
        Stop at steps below this.

    Returns
    -------
    fitted : (k, 3) float
    unexplained : float
    steps : int
    used : int
        How many tactels were compared.
    """
    rings, stripes = Z.shape
    k = len(start)
    px, py = skin[0], skin[1]
    mx = my = 0.0
    for m in range(k):
        mx, my = mx + start[m, 0] / (k * px), my + start[m, 1] / (k * py)
    ci, cj = math.floor(mx + 0.5), math.floor(my + 0.5)
    along, around = max(math.floor(_REACH_MM / px + 0.5), _REACH), max(math.floor(_REACH_MM / py + 0.5), _REACH)
    first_i = max(min(ci - along, rings - 1), 0)
    p, q = max(min(ci + along, rings - 1), 0) - first_i + 1, min(2 * around + 1, stripes)
    window = (first_i, p, cj - q // 2, q)
    total, used = 0.0, 0
    for a in range(p):
        for c in range(q):
            i, j = first_i + a, (window[2] + c) % stripes
            if gains[i, j] != 0.0 and math.isfinite(Z[i, j]):
                total, used = total + Z[i, j] * Z[i, j], used + 1
    total = max(total, 1e-300)
    n = 3 * k
    one, r, J = np.empty((3, p, q)), np.empty(p * q), np.empty((n, p * q))
    r_new, J_new = np.empty(p * q), np.empty((n, p * q))
    A, b, s = np.empty((n, n)), np.empty(n), np.empty(n)
    at, trial, lam = start.copy(), start.copy(), 1e-3
    cost = _residual(Z, gains, at, window, skin, one, r, J)
    for step in range(1, _STEPS + 1):
        normal_equations(J, r, lam, A, b)
        solve(A, b, s)
        moved = 0.0
        for m in range(k):
            scale = max(abs(s[3 * m]) / (_FARTHEST * px), abs(s[3 * m + 1]) / (_FARTHEST * py), 1.0)
            for c in range(3):
                trial[m, c] = at[m, c] + s[3 * m + c] / scale
            moved = max(moved, abs(trial[m, 0] - at[m, 0]), abs(trial[m, 1] - at[m, 1]))
        new = _residual(Z, gains, trial, window, skin, one, r_new, J_new)
        if new < cost:
            cost, lam = new, lam * 0.1
            at, trial = trial, at
            r, r_new = r_new, r
            J, J_new = J_new, J
        else:
            lam *= 10
        if moved < tolerance or lam > 1e8:
            return at, cost / total, step, used
    return at, cost / total, _STEPS, used


def skin_of(model: ArrayModel) -> tuple[float, float, float, float, float, float]:
    """What `fit_forces` needs to know of an array."""
    g = model.geometry
    return (*g.pitch, *g.half, g.skin, model.rubber.poisson)


class Matcher:
    """Finds the contacts of frame after frame.

    Parameters
    ----------
    model : ArrayModel
    floor : float
        A frame whose highest tactel reads less has no contact.
    noise : float
        Standard deviation of a reading; what it leaves unexplained is not held against a contact.

    Examples
    --------
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> found = Matcher(ArrayModel.nominal(seed))(Skin(seed).pressed(0.5, axial_mm=13.0, angle_rad=-0.4))
    >>> found.state, [round(value, 3) for value in (found.contacts[0].axial_mm, found.contacts[0].angle_rad, found.contacts[0].force_n)]
    ('one', [13.0, -0.4, 0.5])
    """

    def __init__(self, model: ArrayModel, *, floor: float = 0.0, noise: float = 0.0) -> None:
        self.model, self._floor, self._noise = model, floor, noise
        g = model.geometry
        unit = np.zeros(g.shape)
        middle = (g.rings // 2 * g.ring_pitch, 0.0)
        add_force(unit, (1.0, 0.0, 0.0), middle, g.pitch, g.half, g.skin, model.rubber.poisson)
        self._per_force = float(unit.max())
        self._skin = skin_of(model)

    def reading_of(self, force_n: float) -> float:
        """What a tactel reads of a force on its middle."""
        return force_n * self._per_force / self.model.rubber.young

    def end(self, axial_mm: float) -> str:
        """``point``, ``edge`` beyond the first or last ring's middle, or ``past`` farther out than can be told."""
        g = self.model.geometry
        out = max(-axial_mm, axial_mm - (g.rings - 1) * g.ring_pitch) / g.ring_pitch
        return "past" if out > _BEYOND else "edge" if out > 0 else "point"

    def one(self, Z: FloatArray) -> tuple[float, float, float, float, int, int]:
        """The one force that explains most, as bare numbers: mm, mm around the core, N, unexplained, steps, tactels compared.

        The readings must hold a finite one.
        """
        (px, ps), known = self.model.geometry.pitch, without_nan(Z)
        x, y, height, *_ = find(known, known, SINC, 0.0, NEWTON_TACTELS, PEAK_FLAT)
        at, unexplained, steps, used = self._fit(Z, np.array([[x * px, y * ps, height / self._per_force]]))
        return at[0, 0], at[0, 1], at[0, 2] * self.model.rubber.young, unexplained, steps, used

    def point(self, Z: FloatArray) -> Contact:
        """The one force that explains most; the readings must hold a finite one."""
        return self._contact(*self.one(Z)[:3])

    def _fit(self, Z: FloatArray, start: FloatArray) -> tuple[FloatArray, float, int, int]:
        out: tuple[FloatArray, float, int, int] = fit_forces(Z, self.model.gains, start, self._skin, MATCH_MM)
        return out

    def __call__(self, Z: FloatArray) -> Match:
        """The contacts of a frame's deflections (rings, stripes); tactels that are NaN are left out."""
        top = highest(Z)
        if not top > self._floor:
            return Match((), 0.0, "none", 0)
        x, s, force, unexplained, steps, used = self.one(Z)
        allowed = MATCH_UNEXPLAINED + 3 * used * self._noise**2 / max(top, 1e-300) ** 2
        end = self.end(x)
        single = self._contact(x, s, force)
        if end == "past":
            return Match((single,), unexplained, end, steps)
        if unexplained <= allowed:
            return Match((single,), unexplained, "one" if end == "point" else end, steps)
        two, left = self._two(Z, x, s, force)
        if left <= max(allowed, MATCH_APART * unexplained) and left < unexplained:
            pair = sorted((self._contact(*row) for row in two), key=lambda c: -c.force_n)
            return Match(tuple(pair), left, "two", steps)
        return Match((single,), unexplained, "wide", steps)

    def predicted(self, contacts: Sequence[Contact]) -> FloatArray:
        """The deflections of contacts by the model, (rings, stripes)."""
        m, g = self.model, self.model.geometry
        out = np.zeros(g.shape)
        for each in contacts:
            place = (each.axial_mm, each.angle_rad * g.core_radius)
            add_force(out, (each.force_n, 0.0, 0.0), place, g.pitch, g.half, g.skin, m.rubber.poisson)
        return out * m.gains / m.rubber.young

    def several(self, Z: FloatArray, *, enough: float = 0.0) -> tuple[Contact, ...]:
        """Up to four contacts, the strongest first: each found in what the others leave, over and over.

        Two that have one peak between them are told as in a call. Light ones count only apart from all others: beside a wide contact,
        which no few points explain, they are what the strong ones leave of it.

        Parameters
        ----------
        Z : (rings, stripes) float
        enough : float
            Sum of squares that may be left: no more contacts are looked for.
        """
        found = list(self(Z).contacts)
        floor = max(self._floor, SEVERAL_OTHER * highest(Z))
        while found and len(found) < _MOST:
            rest = Z - self.predicted(found)
            if not highest(rest) > floor or float(np.nansum(rest**2)) <= enough:
                break
            found.append(self.point(rest))
            for _ in range(_ROUNDS):
                for k in range(len(found)):
                    rest = Z - self.predicted(found[:k] + found[k + 1 :])
                    found[k] = self.point(rest)
        light = SEVERAL_LIGHT * max((each.force_n for each in found), default=0.0)
        apart = [
            one
            for one in found
            if one.force_n >= light or all(self.tactels(one, two) >= SEVERAL_TACTELS for two in found if two is not one)
        ]
        return tuple(sorted((each for each in apart if each.force_n > 0), key=lambda c: -c.force_n))

    def tactels(self, one: Contact, two: Contact) -> float:
        """How far apart two contacts lie, tactels."""
        g = self.model.geometry
        along, around = one.axial_mm - two.axial_mm, g.core_radius * math.remainder(one.angle_rad - two.angle_rad, math.tau)
        return math.hypot(along / g.pitch[0], around / g.pitch[1])

    def _contact(self, x: float, s: float, force: float) -> Contact:
        return Contact(float(x), math.remainder(float(s) / self.model.geometry.core_radius, math.tau), float(force))

    def _two(self, Z: FloatArray, x: float, s: float, force: float) -> tuple[FloatArray, float]:
        """The best two forces that push, of starts half a pitch to either side of the one, along and around."""
        px, ps = self.model.geometry.pitch
        best, least = np.zeros((2, 3)), math.inf
        for dx, ds in ((0.6 * px, 0.0), (0.0, 0.6 * ps), (0.45 * px, 0.45 * ps), (0.45 * px, -0.45 * ps)):
            half = force / 2 / self.model.rubber.young
            at, left, _, _ = self._fit(Z, np.array([[x - dx, s - ds, half], [x + dx, s + ds, half]]))
            if left < least and (at[:, 2] > 0).all():
                best, least = at, left
        return best * np.array([1.0, 1.0, self.model.rubber.young]), least
