"""The classic flattenings, through libigl: for comparison, and for those who want just these.

libigl trusts its input (a closed mesh ends the process), so a disk, with holes or without, is asked for before each call.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import igl
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.distortion import best_scale, singular_values
from skinfab.flatten.holes import border_of, fill_holes
from skinfab.flatten.overlap import overlap_area
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology
from skinfab.tolerances import OVERLAP_FRACTION

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: More than the 10 to 20 of SLIM's and ARAP's own papers; far from flat neither has settled by then (`bench/optimum.py` waits).
_ITERATIONS = 30


def lscm(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """Least squares conformal map (Levy et al. 2002), two far border vertices held, holes free; (n, 2) mm."""
    topology = topology or Topology(F)
    loop = topology.boundary_loops[border_of(V, topology)]
    far = int(np.argmax(np.linalg.norm(V[loop] - V[loop[0]], axis=1)))
    if not np.any(V[loop[far]] != V[loop[0]]):
        raise InputError("the whole border lies in one point, so that lscm has nothing to hold; cut the surface open elsewhere")
    held = np.array([loop[0], loop[far]], dtype=np.int64)
    with _spoken_for("lscm"):
        uv = igl.lscm(V, F, held, np.array([[0.0, 0.0], [1.0, 0.0]]))[0]
    return _finished(V, F, uv, "lscm")


def harmonic(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """Harmonic map onto a circle (cotangent weights), holes filled; (n, 2) mm."""
    W, G = fill_holes(V, F, topology=topology)
    loop = Topology(G).boundary_loops[0]
    circle = igl.map_vertices_to_circle(np.asfortranarray(W), loop.astype(np.int32))
    with _spoken_for("harmonic"):
        uv = igl.harmonic(W, G, loop, np.ascontiguousarray(circle), 1)
    return _finished(V, F, uv[: len(V)], "harmonic")


def arap(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """As rigid as possible (Liu et al. 2008), from Tutte's embedding; (n, 2) mm."""
    return _from_tutte(V, F, _arap, topology or Topology(F), "arap")


def slim(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> FloatArray:
    """Scalable locally injective maps (Rabinovich et al. 2017) on the energy d itself, from Tutte's embedding; (n, 2) mm."""
    return _from_tutte(V, F, _slim, topology or Topology(F), "slim")


def _from_tutte(
    V: FloatArray, F: IntArray, lower: Callable[[FloatArray, IntArray, FloatArray], FloatArray], topology: Topology, method: str
) -> FloatArray:
    """Tutte's embedding of the filled surface, made better with the holes free, or filled where a rim would cover itself."""
    W, G = fill_holes(V, F, topology=topology)
    start = tutte_embedding(W, G, topology=topology if G is F else None)
    free = _finished(V, F, lower(V, F, start[: len(V)]), method)
    if G is F:
        return free
    twice = overlap_area(F, free, topology=topology)
    if twice <= OVERLAP_FRACTION * float(np.prod(np.ptp(free, axis=0))):
        return free
    filled = _finished(V, F, lower(W, G, start)[: len(V)], method)
    return filled if overlap_area(F, filled, topology=topology) < twice else free


def _arap(V: FloatArray, F: IntArray, start: FloatArray) -> FloatArray:
    data = igl.ARAPData()
    data.max_iter = _ITERATIONS
    # Nothing held, the system is singular, and rounding decides whether it factors.
    held = np.zeros(1, dtype=np.int32)
    igl.arap_precomputation(V, F, 2, held, data)
    laid: FloatArray = igl.arap_solve(start[held], data, np.ascontiguousarray(start))
    return laid


def _slim(V: FloatArray, F: IntArray, start: FloatArray) -> FloatArray:
    # SLIM never returns from a start with a flip (Tutte's has none), and has a tolerance with a unit: at a millionth
    # of the size another map comes out.
    size = float(np.linalg.norm(np.ptp(V, axis=0)))
    data = igl.slim_precompute(
        np.asfortranarray(V / size),
        np.asfortranarray(F.astype(np.int32)),
        np.asfortranarray(start / size),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, dtype=np.int32),
        np.zeros((0, 2), order="F"),
        0.0,
    )
    laid = start
    # One by one, so that an interrupt gets through on large meshes.
    for _ in range(_ITERATIONS):
        laid = np.asarray(igl.slim_solve(data, 1))[:, :2]
    return laid


@contextmanager
def _spoken_for(method: str) -> Iterator[None]:
    """libigl's own failures in our words."""
    try:
        yield
    except RuntimeError as fault:
        raise RefusedError(f"{method} found no map of this mesh ({fault}); use --method auto") from fault


def _finished(V: FloatArray, F: IntArray, uv: FloatArray, method: str) -> FloatArray:
    """Right side up, at the scale of the least d."""
    uv = np.ascontiguousarray(uv)
    if not np.isfinite(uv).all():
        raise RefusedError(f"{method} gave coordinates that are not numbers on this mesh; use --method auto")
    s = singular_values(V, F, uv)
    if (s[:, 1] < 0).sum() * 2 > len(F):
        uv = uv * [1.0, -1.0]
    return uv * best_scale(V, F, uv)
