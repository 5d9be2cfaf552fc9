"""Flatten a simplified mesh and carry the layout to the fine one, where that costs next to no distortion.

A smooth surface does not need all its triangles to be laid flat: d on a sixteenth of them is within a few
thousandths of d on all. The coarse layout is carried over and made good by a few products with the fine mesh's
Hessian, which is never factored; what d could still lose is measured, not assumed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.carry import carrier
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.holes import flatten_least
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.rigid_start import rigid_steps
from skinfab.flatten.two_level import CoarseCorrection, relax
from skinfab.mesh.decimate import Decimated, decimate
from skinfab.mesh.topology import Topology
from skinfab.tolerances import FLAT_START, SIMPLIFY_EFFECT

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Fine triangles to a coarse one; `skinfab bench simplify` draws the others.
SHARE = 16
#: With fewer coarse triangles than this there is nothing to gain: a mesh that small is flattened as it is.
LEAST_COARSE = 1000
#: A decimation that comes no further down than to one in so many (a flat strip has no vertex it could spare) saves nothing.
_LEAST_SAVING = 2


@dataclass(frozen=True, eq=False)
class Simplified:
    """A layout, and how it came about.

    Parameters
    ----------
    UV : (n, 2) float64, mm
    n_faces : int
        Of the mesh.
    n_coarse : int
        Triangles of the simplified mesh whose layout was carried over; 0 where the mesh was flattened as it is.
    effect : float
        What the mean d could lose at most, were every triangle solved for; 0 where they were.
    why : str
        What kept it from being carried over; empty where it was.
    """

    UV: FloatArray
    n_faces: int
    n_coarse: int
    effect: float
    why: str

    @property
    def sentence(self) -> str:
        """What was done, for the user."""
        if not self.n_coarse:
            return f"flattened on all {self.n_faces} triangles: {self.why}"
        return f"flattened on {self.n_coarse} of {self.n_faces} triangles; that costs at most {self.effect:.1g} of the mean d"


def flatten_simplified(
    V: FloatArray, F: IntArray, *, topology: Topology | None = None, share: int = SHARE, least_coarse: int = LEAST_COARSE
) -> Simplified:
    """The flattening of least d, by way of a mesh of a `share`-th of the triangles where that is as good.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk; every vertex in use.
    topology : Topology, optional
    share : int
        Triangles of the mesh to one of the simplified mesh.
    least_coarse : int
        Where the simplified mesh would have fewer triangles, the mesh is flattened as it is.

    Returns
    -------
    Simplified
        Without flips, its mean d within `SIMPLIFY_EFFECT` of the least, be it carried over or not.

    Raises
    ------
    InputError
        Not a disk, or a triangle has no area.

    Examples
    --------
    >>> a, r = np.meshgrid(np.linspace(0, 1, 161), np.linspace(0, 1, 161))
    >>> V = np.stack([50 * np.sin(a.ravel()), 40 * r.ravel(), 50 * np.cos(a.ravel())], axis=1)
    >>> k = (161 * np.arange(160)[:, None] + np.arange(160)).ravel()
    >>> F = np.concatenate([np.stack([k, k + 1, k + 162], axis=1), np.stack([k, k + 162, k + 161], axis=1)])
    >>> flat = flatten_simplified(V, F)  # a bent sheet
    >>> flat.n_coarse <= len(F) / 16, flat.effect < 1e-4
    (True, True)
    """
    topology = topology or Topology(F)

    def plain(why: str) -> Simplified:
        return Simplified(flatten_least(V, F, topology=topology), len(F), 0, 0.0, why)

    if len(F) < least_coarse * share:
        return plain("so few need no simplifying")
    if not np.isfinite(V).all() or not _is_disk(topology, len(V)):
        return plain("only a disk without holes is simplified")
    try:
        coarse = decimate(V, F, faces=len(F) // share)
    except InputError as fault:
        return plain(str(fault))
    if len(coarse.F) > len(F) / _LEAST_SAVING:
        return plain("next to none of them can be spared")
    few = Topology(coarse.F)
    if not (_is_disk(few, len(coarse.V)) and few.is_oriented_manifold):
        return plain("simplifying would tear it or close it")
    solver = IsometricSolver(V, F)
    carried, correction = _carried(V, coarse)
    start = _open(V, F, solver, carried)
    if start is None:
        return plain("the simplified mesh's layout turns some of them over")
    relaxed = relax(solver, start, correction)
    if relaxed.effect > SIMPLIFY_EFFECT:
        uv = solver.refine(relaxed.UV).UV
        return Simplified(uv, len(F), 0, 0.0, f"the simplified mesh left {relaxed.effect:.2g} of the mean d to gain")
    return Simplified(relaxed.UV, len(F), len(coarse.F), relaxed.effect, "")


def _carried(V: FloatArray, coarse: Decimated) -> tuple[FloatArray, CoarseCorrection]:
    """The coarse mesh's layout on the fine mesh, and the coarse solve that goes with it."""
    flat = flatten_isometric(coarse.V, coarse.F)
    onto = carrier(V, coarse)
    return onto.carry(flat), CoarseCorrection(IsometricSolver(coarse.V, coarse.F), flat, onto.interpolation)


def _open(V: FloatArray, F: IntArray, solver: IsometricSolver, start: FloatArray) -> FloatArray | None:
    """`start`, or where it has flips what one rigid step makes of it; None where flips are left."""
    if solver.best_scale(start)[1] >= FLAT_START:
        return start
    turned = rigid_steps(V, F, start, steps=1, rest=solver.rest)
    return turned if solver.best_scale(turned)[1] >= FLAT_START else None


def _is_disk(topology: Topology, n_vertices: int) -> bool:
    return (
        topology.euler == 1
        and len(topology.boundary_loops) == 1
        and topology.face_components()[0] == 1
        and len(topology.used_vertices) == n_vertices
    )
