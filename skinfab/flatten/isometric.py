"""Minimise d itself: a projected Newton method on the symmetric Dirichlet energy.

Each triangle's Hessian is projected by its analytic eigensystem (Smith, de Goes and Kim 2019, "Analytic
Eigensystems for Isotropic Distortion Energies", section 5): in 2D only the twist mode can be negative.
The sparsity never changes, so the symbolic analysis is done once; the line search stops before the first
triangle would collapse, so a start without flips stays without.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from skinfab.errors import InputError
from skinfab.flatten._barrier import barrier_energy, barrier_gradient, barrier_hessian, first_crossing, near_pairs
from skinfab.flatten._dirichlet import assemble, energies, extremes, first_collapse, gradient_of, vertex_pattern
from skinfab.flatten.distortion import local_triangles, shaped_areas
from skinfab.flatten.flexibility import Flexibility
from skinfab.flatten.laplacian import mollified_lengths
from skinfab.linalg import Cholesky, LowerTriangle
from skinfab.tolerances import MOLLIFY, NEWTON_DECREASE, NEWTON_RIDGE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Far from the optimum many steps follow that each promise little: from Tutte's start on a ramp of two turns and more,
#: twice the promise gave up 10 bounds of 25 that were reached in the end, 16 times gave up none and cost no time.
_HOPE = 16

#: Ten times what real pieces need.
MOST_STEPS = 60

#: A step by an earlier Hessian is taken when it promises less than this fraction of what the step before it did.
_CONTRACTION = 0.25

#: Boundary vertices and edges nearer than this many reaches of the barrier are joined in the matrix.
_SPARE = 1.5


@dataclass(frozen=True, eq=False)
class Refinement:
    """Flat coordinates with less distortion than they had.

    Parameters
    ----------
    UV : (n, 2) float64, mm
    energy : tuple of float
        Mean d at the start and after every step.
    converged : bool
        The last step promised less than the tolerance.
    """

    UV: FloatArray
    energy: tuple[float, ...]
    converged: bool


@dataclass(frozen=True, eq=False)
class Apart:
    """Keeps a boundary loop from crossing itself (after Smith and Schaefer 2015, "Bijective Parameterization with Free
    Boundaries"): a barrier within `reach`, and no step past the first contact.

    Parameters
    ----------
    loop : (b,) int64
        Boundary vertices in order.
    reach : float, mm
        Edges nearer to a vertex than this push it away.
    weight : float
        Of the barrier beside the mean d.
    """

    loop: IntArray
    reach: float
    weight: float


class IsometricSolver:
    """Built once for a mesh, it refines any flattening of it.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        Triangles without area are given the least width that can be computed with.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> solver = IsometricSolver(V, np.array([[0, 1, 2], [0, 2, 3]]))
    >>> round(solver.refine(V[:, :2] * [1.5, 1]).energy[-1], 6)
    4.0
    """

    def __init__(self, V: FloatArray, F: IntArray) -> None:
        self.F, self.n = np.ascontiguousarray(F), len(V)
        self.rest = rest_triangles(V, F)
        twice_area = self.rest[:, 0, 0] * self.rest[:, 1, 1]
        self.weight = twice_area / twice_area.sum()
        self.gradients = _basis_gradients(self.rest, twice_area)
        self._cholesky: Cholesky | None = None
        self._discarded = 0
        self._join(np.empty((0, 3), dtype=np.int64))

    def reopened(self, F: IntArray, n: int) -> IsometricSolver:
        """For the same triangles joined otherwise, (m, 3) of n vertices: their shapes are not measured anew."""
        other = copy(self)
        other.F, other.n = np.ascontiguousarray(F), n
        other._cholesky, other._discarded = None, 0
        other._join(np.empty((0, 3), dtype=np.int64))
        return other

    @property
    def factorisations(self) -> int:
        """How many numeric factorisations were done."""
        return self._discarded + (self._cholesky.factorisations if self._cholesky else 0)

    def refine(
        self,
        UV: FloatArray,
        *,
        max_steps: int = MOST_STEPS,
        tolerance: float = NEWTON_DECREASE,
        hopeless_above: float = np.inf,
        apart: Apart | None = None,
    ) -> Refinement:
        """Newton steps until the promised decrease of the mean d is below `tolerance` x (mean d - 4).

        Parameters
        ----------
        UV : (n, 2) float64, mm
            A flattening without flipped triangles.
        max_steps : int
        tolerance : float
        hopeless_above : float
            Stop when not even 16 times the promised decrease would bring the mean d down to this.
        apart : Apart, optional
            Keep the boundary from crossing itself; the start's must not.

        Raises
        ------
        InputError
            The start has a flipped or collapsed triangle.
        """
        u = np.ascontiguousarray(UV, dtype=np.float64).copy()
        energy = [self._energy(u, apart)]
        if not np.isfinite(energy[0]):
            raise InputError("the start of the refinement has flipped triangles; untangle it first")
        converged, before = False, 0.0
        while len(energy) <= max_steps:
            # The last factor's step is good while each promises far less than the one before, as it does near the end.
            step, slope = self._step(u, apart, renew=False) if before else (u, -np.inf)
            # The quadratic model promises -slope / 2.
            if not -slope <= _CONTRACTION * before or energy[-1] + _HOPE * slope / 2 > hopeless_above:
                before = 0.0
                step, slope = self._step(u, apart, renew=True)
                if energy[-1] + _HOPE * slope / 2 > hopeless_above:
                    break
            if -slope <= tolerance * max(energy[-1] - 4, tolerance):
                converged = True
                break
            t, u_next, e_next = self._line_search(u, step, slope, energy[-1], apart)
            if e_next >= energy[-1]:
                if before:
                    before = 0.0
                    continue
                converged = True
                break
            before = -slope if t == 1 else 0.0
            u = u_next
            energy.append(e_next)
        return Refinement(u, tuple(energy), converged)

    def best_scale(self, UV: FloatArray) -> tuple[float, float]:
        """The factor on `UV` of the least mean d, and the least singular value over the largest (not positive: flipped)."""
        stretch, squash, least, largest = extremes(np.ascontiguousarray(UV), self.F, self.gradients, self.weight)
        return ((squash / stretch) ** 0.25 if stretch > 0 else 1.0), (least / largest if largest > 0 else -1.0)

    def hessian(self, UV: FloatArray) -> tuple[csc_array, FloatArray]:
        """The mean d's projected Hessian at a layout without flips, (2n, 2n) lower, positive definite, and its gradient (2n,)."""
        data, gradient = assemble(UV, self.F, self.gradients, self.weight, self._place, self._indptr)
        self._hold(data)
        return csc_array((data, self._indices, self._indptr), shape=(2 * self.n, 2 * self.n)), gradient

    def flexibility(self, UV: FloatArray, apart: Apart | None = None) -> Flexibility:
        """Inverse of the Hessian at a layout without flips, with the barrier's where there is one."""
        u = np.ascontiguousarray(UV)
        self._renew(u, apart, near_pairs(u, apart.loop, apart.reach) if apart else None)
        assert self._cholesky is not None
        return Flexibility.of(self._cholesky)

    def descend(self, UV: FloatArray, step: FloatArray, slope: float) -> tuple[FloatArray, float]:
        """`UV` as far along `step` (n, 2) as d falls by its share of `slope` and nothing flips, and the mean d there."""
        _, u, energy = self._line_search(UV, step, slope, self._energy(UV, None), None)
        return u, energy

    def _energy(self, u: FloatArray, apart: Apart | None) -> float:
        d = energies(u, self.F, self.gradients, self.weight)
        return d + apart.weight * barrier_energy(u, apart.loop, apart.reach) if apart and np.isfinite(d) else d

    def _step(self, u: FloatArray, apart: Apart | None, *, renew: bool) -> tuple[FloatArray, float]:
        """Downhill by the Hessian here (`renew`) or by the last that was factored, and the energy's slope along it."""
        near = near_pairs(u, apart.loop, apart.reach) if apart else None
        renew = renew or self._cholesky is None
        gradient = self._renew(u, apart, near) if renew else gradient_of(u, self.F, self.gradients, self.weight)
        if apart and near is not None:
            barrier_gradient(u, near, apart.reach, apart.weight, gradient)
        assert self._cholesky is not None
        step = self._cholesky.solve(-gradient)
        return step.reshape(-1, 2), float(gradient @ step)

    def _renew(self, u: FloatArray, apart: Apart | None, near: IntArray | None) -> FloatArray:
        """The Hessian here factored, with `near` in contact; the gradient of d alone."""
        if apart and near is not None:
            self._couple(u, apart, near)
        data, gradient = assemble(u, self.F, self.gradients, self.weight, self._place, self._indptr)
        if apart:
            barrier_hessian(u, self._pairs, self._pair_place, apart.reach, apart.weight, self._indptr, data)
        self._factor(data)
        return gradient

    def _hold(self, data: FloatArray) -> None:
        # The rigid motions cost nothing: a ridge far below the stiffness fixes them.
        diagonal = self._indptr[:-1]
        data[diagonal] += NEWTON_RIDGE * data[diagonal].mean()

    def _couple(self, u: FloatArray, apart: Apart, near: IntArray) -> None:
        """Give what is in contact a place in the matrix; with some to spare, as each new pattern is to be analysed anew."""
        have = set(map(tuple, self._pairs.tolist()))
        if not have.issuperset(map(tuple, near.tolist())):
            self._join(near_pairs(u, apart.loop, _SPARE * apart.reach))

    def _join(self, pairs: IntArray) -> None:
        self._pairs = pairs
        self._indptr, self._indices, place = vertex_pattern(np.concatenate([self.F, pairs]), self.n)
        self._place, self._pair_place = place[: len(self.F)], place[len(self.F) :]
        self._discarded, self._cholesky = self.factorisations, None

    def _factor(self, data: FloatArray) -> None:
        self._hold(data)
        if self._cholesky is None:
            columns = np.repeat(np.arange(2 * self.n), np.diff(self._indptr))
            self._cholesky = Cholesky(LowerTriangle(data, self._indices, columns, 2 * self.n))
        else:
            self._cholesky.refactor(data)

    def _line_search(
        self, u: FloatArray, step: FloatArray, slope: float, start: float, apart: Apart | None
    ) -> tuple[float, FloatArray, float]:
        t = min(1.0, 0.9 * first_collapse(u, step, self.F))
        if apart:
            t = min(t, 0.9 * first_crossing(u, step, apart.loop, t))
        for _ in range(40):
            trial = u + t * step
            e = self._energy(trial, apart)
            if e <= start + 1e-4 * t * slope:
                return t, trial, e
            t /= 2
        return 0.0, u, start


def rest_triangles(V: FloatArray, F: IntArray) -> FloatArray:
    """Each triangle in its own plane, (m, 2, 2) mm; one without a shape gets the least that can be computed with."""
    rest = local_triangles(V, F)
    shapeless = ~shaped_areas(V, F)[1]
    if not shapeless.any():
        return rest
    opposite = mollified_lengths(V, F)[shapeless]
    base = opposite[:, 2]
    along = (base**2 + opposite[:, 1] ** 2 - opposite[:, 0] ** 2) / (2 * base)
    up = np.sqrt(np.maximum(opposite[:, 1] ** 2 - along**2, (MOLLIFY * base) ** 2))
    rest[shapeless] = np.stack([np.stack([base, np.zeros_like(base)], axis=1), np.stack([along, up], axis=1)], axis=1)
    return rest


def _basis_gradients(rest: FloatArray, twice_area: FloatArray) -> FloatArray:
    """Gradients of the three hat functions in each triangle's frame, (m, 3, 2) 1/mm: J = sum of u_k g_k^T."""
    g1 = np.stack([rest[:, 1, 1], -rest[:, 1, 0]], axis=1) / twice_area[:, None]
    g2 = np.stack([-rest[:, 0, 1], rest[:, 0, 0]], axis=1) / twice_area[:, None]
    return np.ascontiguousarray(np.stack([-g1 - g2, g1, g2], axis=1))
