"""Boundary places on a target curve, by descent of the conformal energy.

The harmonic extension of boundary places g has the Dirichlet energy g.S g / 2, S being the Dirichlet-to-Neumann
map, and covers the area A of the polygon g. Their difference is the conformal energy (Levy et al. 2002): never
negative, and zero for a conformal map only. So the boundary slides along the curve until it is least (Douglas'
solution of Plateau's problem), which needs no turning angle of a corner that falls between two vertices.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.tolerances import CURVE_DECREASE

FloatArray = NDArray[np.float64]
Linear = Callable[[FloatArray], FloatArray]

#: Windows over which the curve is averaged, one after the other, in mean distances of boundary vertices: wide ones let a vertex
#: find its way round a corner, the last is under what the mesh can tell.
_WINDOWS = (4.0, 1.0, 0.25)

#: Steps in each window, at most; most stop for lack of decrease after five to ten.
_STEPS = 20

#: Steps remembered by the quasi-Newton direction.
_MEMORY = 8

#: A step takes no more than this part of the way to the vertex ahead.
_WAY = 0.9


class SlidingCurve:
    """A closed polygon averaged along itself over 2 w, so that it has a tangent everywhere.

    Parameters
    ----------
    target : (k, 2) float, mm
        Not repeated at the end.

    Examples
    --------
    >>> square = SlidingCurve(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))
    >>> place, tangent = square.averaged(np.array([0.5, 1.0]), 0.1)
    >>> place.round(9).tolist(), tangent.round(9).tolist()
    ([[0.5, 0.0], [0.975, 0.025]], [[1.0, 0.0], [0.5, 0.5]])
    """

    def __init__(self, target: FloatArray) -> None:
        self._closed = closed = np.vstack([target, target[:1]])
        self._step = np.diff(closed, axis=0)
        self._length = np.linalg.norm(self._step, axis=1)
        self._way = np.concatenate([[0.0], np.cumsum(self._length)])
        middle = (closed[1:] + closed[:-1]) / 2
        self._integral = np.vstack([np.zeros((1, 2)), np.cumsum(middle * self._length[:, None], axis=0)])

    @property
    def total_mm(self) -> float:
        """Once around."""
        return float(self._way[-1])

    def point(self, at: FloatArray) -> FloatArray:
        """(b, 2) mm at the ways `at` (b,) mm from the first point."""
        way = np.mod(at, self.total_mm)
        return np.column_stack([np.interp(way, self._way, self._closed[:, 0]), np.interp(way, self._way, self._closed[:, 1])])

    def averaged(self, at: FloatArray, w: float) -> tuple[FloatArray, FloatArray]:
        """Mean place (b, 2) mm of the curve within `w` mm of `at` to either side, and its derivative (b, 2)."""
        return (self._to(at + w) - self._to(at - w)) / (2 * w), (self.point(at + w) - self.point(at - w)) / (2 * w)

    def _to(self, at: FloatArray) -> FloatArray:
        """Integral of the places from the first point to `at`, which may go around more than once."""
        turns = np.floor(at / self.total_mm)
        way = at - turns * self.total_mm
        k = np.clip(np.searchsorted(self._way, way, side="right") - 1, 0, len(self._length) - 1)
        x = (way - self._way[k])[:, None]
        slant = np.divide(self._step, self._length[:, None], out=np.zeros_like(self._step), where=self._length[:, None] > 0)[k]
        whole: FloatArray = self._integral[k] + self._closed[k] * x + slant * x**2 / 2 + turns[:, None] * self._integral[-1]
        return whole


def conformal_energy(points: FloatArray, slope_of: Linear) -> tuple[float, FloatArray, float]:
    """Conformal energy of the harmonic extension of a boundary, its gradient, and the area enclosed.

    Parameters
    ----------
    points : (b, 2) float, mm
    slope_of : function
        S: from boundary values (b, 2) to the slopes (b, 2) of their harmonic extension.
    """
    slope = slope_of(points)
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    area = float((points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]).sum() / 2)
    chord = after - before
    gradient = slope - np.column_stack([chord[:, 1], -chord[:, 0]]) / 2
    return float((points * slope).sum() / 2) - area, gradient, area


def slide(curve: SlidingCurve, at: FloatArray, *, slope_of: Linear, values_of: Linear) -> FloatArray:
    """Ways (b,) mm along `curve` at which the conformal energy is least, from a first guess `at`; the first vertex stays.

    Quasi-Newton steps (L-BFGS) whose first guess at the inverse Hessian is the Neumann-to-Dirichlet map, in
    windows that narrow down. No step lets a vertex overtake the next; none raises the energy.

    Parameters
    ----------
    slope_of : function
        As for `conformal_energy`.
    values_of : function
        Its inverse (b,) -> (b,) with the first value 0.
    """
    for window in _WINDOWS:
        at = _descend(curve, at, window * curve.total_mm / len(at), slope_of, values_of)
    return at


def _descend(curve: SlidingCurve, at: FloatArray, w: float, slope_of: Linear, values_of: Linear) -> FloatArray:
    def energy(at: FloatArray) -> tuple[float, FloatArray]:
        points, tangent = curve.averaged(at, w)
        value, gradient, _ = conformal_energy(points, slope_of)
        along = np.einsum("ki,ki->k", gradient, tangent)
        along[0] = 0.0
        return value, along

    memory: list[tuple[FloatArray, FloatArray]] = []
    here, gradient = energy(at)
    for _ in range(_STEPS):
        direction = _quasi_newton(gradient, memory, values_of)
        step, promised = _room(at, direction, curve.total_mm), float(gradient @ direction)
        if not promised < 0:
            break
        there, ahead = energy(at + step * direction)
        while there > here + 1e-4 * step * promised and -step * promised > CURVE_DECREASE * here:
            step /= 2
            there, ahead = energy(at + step * direction)
        if not there < here:
            break
        moved, turned = step * direction, ahead - gradient
        if moved @ turned > 0:
            memory = [*memory, (moved, turned)][-_MEMORY:]
        gained, at, here, gradient = here - there, at + moved, there, ahead
        if gained <= CURVE_DECREASE * here:
            break
    return at


def _quasi_newton(gradient: FloatArray, memory: list[tuple[FloatArray, FloatArray]], values_of: Linear) -> FloatArray:
    """L-BFGS's two loops (Nocedal and Wright, algorithm 7.4)."""
    q, shares = gradient, []
    for moved, turned in reversed(memory):
        shares.append((moved @ q) / (moved @ turned))
        q = q - shares[-1] * turned
    r = values_of(q)
    for (moved, turned), share in zip(memory, reversed(shares), strict=True):
        r = r + moved * (share - (turned @ r) / (moved @ turned))
    return -r


def _room(at: FloatArray, direction: FloatArray, total: float) -> float:
    """The longest step up to 1 that keeps the vertices in order."""
    gap, closing = np.diff(np.append(at, total)), -np.diff(np.append(direction, 0.0))
    narrowing = closing > 0
    return min(1.0, _WAY * float((gap[narrowing] / closing[narrowing]).min(initial=np.inf)))
