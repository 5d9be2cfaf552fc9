"""A connected surface with seams that leave it one disk, laid flat; seams are opened and closed a few edges at a time.

The layout is carried along: an opened seam leaves every triangle where it is, a closed one moves them as little as it can.
What does not depend on the seams is kept with the surface, so that a change costs little more than its Newton steps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numba
import numpy as np
import shapely
from numpy.typing import NDArray

from skinfab.flatten._dirichlet import distortions
from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import quantiles
from skinfab.flatten.flexibility import Flexibility
from skinfab.flatten.isometric import Apart, IsometricSolver
from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.model import Mesh
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import APART_REACH, APART_WEIGHT

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: In the search d is known to 1 % of what is above 4.
DECREASE = 1e-2

#: Sides in contact creep past each other in hundreds of steps: if so many bring less than this part of what is above 4, it is
#: enough.
_STEPS, _CREEP = 12, 0.1


@dataclass(frozen=True, eq=False)
class Surface:
    """What is to be cut.

    Parameters
    ----------
    mesh : Mesh
        Connected, manifold, consistently wound; every vertex in use.
    weight : (e,) float64
        Cost of cutting each edge.
    forbidden : (e,) bool
        Never cut.
    """

    mesh: Mesh
    weight: FloatArray
    forbidden: BoolArray

    @cached_property
    def size(self) -> float:
        """Root of the area, mm."""
        return float(np.sqrt(self.mesh.area))

    @cached_property
    def lengths(self) -> FloatArray:
        """(e,) mm: of each edge, times what marks make it dearer or cheaper; creases are no shorter."""
        lengths: FloatArray = self.mesh.edge_lengths * self.weight / seam_weights(self.mesh)
        return lengths

    @cached_property
    def curvature(self) -> FloatArray:
        """(n,) size of the angle defect of each vertex, rad; of no meaning on the boundary."""
        return np.abs(2 * np.pi - intrinsic(self.mesh.V, self.mesh.F).angle_sum)

    @cached_property
    def neighbours(self) -> tuple[IntArray, IntArray, IntArray]:
        """CSR: where each vertex begins (n + 1,), its neighbours, and the edges to them."""
        E, n = self.mesh.topology.E, len(self.mesh.V)
        near, edge = np.r_[E[:, 1], E[:, 0]], np.tile(np.arange(len(E)), 2)
        at = np.r_[E[:, 0], E[:, 1]]
        order = np.argsort(at, kind="stable")
        return np.r_[0, np.cumsum(np.bincount(at, minlength=n))], near[order], edge[order]

    @cached_property
    def solver(self) -> IsometricSolver:
        """Of the surface without any seam: it lends its triangles to those of sheets."""
        return IsometricSolver(self.mesh.V, self.mesh.F)


@dataclass(frozen=True, eq=False)
class Sheet:
    """A surface opened to one disk, and laid flat.

    Parameters
    ----------
    surface : Surface
    cut : (e,) bool
        Edges of the surface that are open; not its boundary.
    F : (m, 3) int64
        The faces by vertices of the disk.
    origin : (p,) int64
        The surface's vertex of each of these.
    EF : (e, 2) int64
        Faces at each edge of the surface; only one where it is open.
    loop : (b,) int64
        Vertices of the disk along its boundary, in face order.
    solver : IsometricSolver
    UV : (p, 2) float64, mm
    mean : float
        Its mean d.
    apart : Apart, optional
        What keeps the layout from covering itself; without it, it is free.
    """

    surface: Surface
    cut: BoolArray
    F: IntArray
    origin: IntArray
    EF: IntArray
    loop: IntArray
    solver: IsometricSolver
    UV: FloatArray
    mean: float = np.inf
    apart: Apart | None = None

    @property
    def FE(self) -> IntArray:
        """(m, 3) int64: edges of the surface."""
        return self.surface.mesh.topology.FE

    @cached_property
    def length(self) -> float:
        """Of the seams, mm, as `Surface.lengths`."""
        return float(self.surface.lengths[self.cut].sum())

    @cached_property
    def d(self) -> FloatArray:
        """(m,) d of each triangle."""
        d: FloatArray = distortions(self.UV, self.F, self.solver.gradients)
        return d

    @property
    def p99(self) -> float:
        """What 99 % of the area keep to."""
        return float(quantiles(self.d, self.solver.weight, (0.99,))[0])

    @cached_property
    def is_simple(self) -> bool:
        """Whether the boundary neither crosses nor touches itself: nothing is covered twice."""
        return bool(shapely.LinearRing(self.UV[self.loop]).is_simple)

    @cached_property
    def flexibility(self) -> Flexibility:
        """Of the layout, and of what keeps it apart."""
        return self.solver.flexibility(self.UV, self.apart)

    def within(self, mean: float, p99: float) -> bool:
        """Whether it keeps to both bounds."""
        return self.mean <= mean and (not np.isfinite(p99) or self.p99 <= p99)


def sheet_of(surface: Surface, cut: BoolArray) -> Sheet | None:
    """The surface opened along `cut` (e,), not laid out; None where that is not one disk."""
    topology = surface.mesh.topology
    F, origin = _corners(surface.mesh.F, topology.FE, topology.EF, cut)
    open_ = cut | topology.is_boundary
    loop, loops = _boundary(surface.mesh.F, F, topology.FE, topology.EF, open_)
    edges = len(topology.E) + int((cut & ~topology.is_boundary).sum())
    if loops != 1 or len(origin) - edges + len(F) != 1:
        return None
    EF = topology.EF.copy()
    EF[cut, 1] = -1
    return Sheet(surface, cut, F, origin, EF, loop, surface.solver.reopened(F, len(origin)), np.empty((0, 2)))


def lay_out(sheet: Sheet) -> Sheet:
    """At its least d."""
    uv = flatten_isometric(sheet.surface.mesh.V[sheet.origin], sheet.F, tolerance=DECREASE)
    return _laid(replace(sheet, apart=None), uv)


def lay_apart(sheet: Sheet, *, hopeless_above: float = np.inf) -> Sheet:
    """At its least d without covering itself; only begun where that is far above `hopeless_above`."""
    uv = flatten_bijective(sheet.surface.mesh.V[sheet.origin], sheet.F, tolerance=DECREASE, hopeless_above=hopeless_above)
    return _laid(replace(sheet, apart=keep_apart(sheet)), uv)


def refined(sheet: Sheet, UV: FloatArray) -> Sheet:
    """From another layout without flips to its least d; with the boundary kept apart where it was."""
    while True:
        step = sheet.solver.refine(UV, tolerance=DECREASE, apart=sheet.apart, max_steps=_STEPS)
        UV, (first, *_, last) = step.UV, (*step.energy, step.energy[-1])
        if step.converged or first - last < _CREEP * (first - 4):
            return _laid(sheet, UV)


def keep_apart(sheet: Sheet) -> Apart:
    """The barrier for its boundary."""
    at = sheet.surface.mesh.V[sheet.origin[sheet.loop]]
    edge = np.linalg.norm(at - np.roll(at, -1, axis=0), axis=1)
    return Apart(sheet.loop, APART_REACH * float(np.median(edge)), APART_WEIGHT)


def carried(one: Sheet, other: Sheet) -> FloatArray:
    """The layout of one sheet for another of the same surface with more seams, (p, 2) mm."""
    uv = np.empty((len(other.origin), 2))
    uv[other.F.ravel()] = one.UV[one.F.ravel()]
    return uv


def _laid(sheet: Sheet, uv: FloatArray) -> Sheet:
    now = replace(sheet, UV=uv)
    return replace(now, mean=float(now.d @ sheet.solver.weight))


@numba.njit(cache=True)
def _corners(F: IntArray, FE: IntArray, EF: IntArray, cut: BoolArray) -> tuple[IntArray, IntArray]:
    """Corners that edges join, which are not cut, become one vertex."""
    new = np.full(F.shape, -1)
    origin = np.empty(3 * F.shape[0], dtype=np.int64)
    count = 0
    for first in range(F.shape[0]):
        for corner in range(3):
            if new[first, corner] >= 0:
                continue
            v = F[first, corner]
            new[first, corner], origin[count] = count, v
            for side in range(2):
                face, at = first, corner
                edge = FE[face, at if side == 0 else (at + 2) % 3]
                while EF[edge, 1] >= 0 and not cut[edge]:
                    face = EF[edge, 0] + EF[edge, 1] - face
                    at = 0
                    while F[face, at] != v:
                        at += 1
                    if new[face, at] >= 0:
                        break
                    new[face, at] = count
                    edge = FE[face, at] + FE[face, (at + 2) % 3] - edge
            count += 1
    return new, origin[:count].copy()


@numba.njit(cache=True)
def _boundary(mesh_F: IntArray, F: IntArray, FE: IntArray, EF: IntArray, is_open: BoolArray) -> tuple[IntArray, int]:
    """Vertices along the first loop of open edges, and how many loops there are."""
    done = np.zeros(F.shape, dtype=np.bool_)
    loop = np.empty(3 * F.shape[0], dtype=np.int64)
    loops, length = 0, 0
    for first in range(F.shape[0]):
        for side in range(3):
            if done[first, side] or not is_open[FE[first, side]]:
                continue
            loops += 1
            face, at = first, side
            while not done[face, at]:
                done[face, at] = True
                if loops == 1:
                    loop[length] = F[face, at]
                    length += 1
                at = (at + 1) % 3
                v = mesh_F[face, at]
                while not is_open[FE[face, at]]:
                    edge = FE[face, at]
                    face = EF[edge, 0] + EF[edge, 1] - face
                    at = 0
                    while mesh_F[face, at] != v:
                        at += 1
    return loop[:length].copy(), loops
