"""The classic flattenings, through libigl: for comparison, and for those who want just these.

libigl trusts its input (a closed mesh ends the process) and has tolerances of its own, so a disk, with holes or without, is
asked for before each call and handed over at the size of one.
"""

from __future__ import annotations

import igl
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import RefusedError
from skinfab.flatten.distortion import best_scale, singular_values
from skinfab.flatten.holes import border_of, fill_holes
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Enough for both to settle on real meshes; SLIM's and ARAP's own papers use 10 to 20.
_ITERATIONS = 30


def lscm(V: FloatArray, F: IntArray) -> FloatArray:
    """Least squares conformal map (Levy et al. 2002), two far border vertices held, holes free; (n, 2) mm."""
    topology = Topology(F)
    loop = topology.boundary_loops[border_of(V, topology)]
    far = int(np.argmax(np.linalg.norm(V[loop] - V[loop[0]], axis=1)))
    held = np.array([loop[0], loop[far]], dtype=np.int64)
    uv = igl.lscm(_unit(V), F, held, np.array([[0.0, 0.0], [1.0, 0.0]]))[0]
    return _finished(V, F, uv, "lscm")


def harmonic(V: FloatArray, F: IntArray) -> FloatArray:
    """Harmonic map onto a circle (cotangent weights), holes filled; (n, 2) mm."""
    W, G = fill_holes(V, F)
    W = _unit(W)
    loop = Topology(G).boundary_loops[0]
    circle = igl.map_vertices_to_circle(np.asfortranarray(W), loop.astype(np.int32))
    uv = igl.harmonic(W, G, loop, np.ascontiguousarray(circle), 1)
    return _finished(V, F, uv[: len(V)], "harmonic")


def arap(V: FloatArray, F: IntArray) -> FloatArray:
    """As rigid as possible (Liu et al. 2008), from Tutte's embedding with holes filled; (n, 2) mm."""
    W, start, border = _embedded(V, F)
    data = igl.ARAPData()
    data.max_iter = _ITERATIONS
    # Nothing held, the system is singular, and rounding decides whether it factors.
    held = border[:1].astype(np.int32)
    igl.arap_precomputation(W, F, 2, held, data)
    return _finished(V, F, igl.arap_solve(start[held], data, start), "arap")


def slim(V: FloatArray, F: IntArray) -> FloatArray:
    """Scalable locally injective maps (Rabinovich et al. 2017) of least d, from Tutte's embedding with holes filled; (n, 2) mm."""
    # SLIM never returns from a start with a flip; Tutte's has none.
    W, start, _ = _embedded(V, F)
    data = igl.slim_precompute(
        np.asfortranarray(W),
        np.asfortranarray(F.astype(np.int32)),
        np.asfortranarray(start),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, dtype=np.int32),
        np.zeros((0, 2), order="F"),
        0.0,
    )
    return _finished(V, F, np.asarray(igl.slim_solve(data, _ITERATIONS))[:, :2], "slim")


def _unit(V: FloatArray) -> FloatArray:
    """About the origin, and of size 1."""
    box = np.ptp(V, axis=0)
    size = float(np.linalg.norm(box))
    return np.ascontiguousarray((V - V.min(axis=0) - box / 2) / (size if size > 0 else 1.0))


def _embedded(V: FloatArray, F: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """The surface at size 1, Tutte's embedding of it with its holes filled, and the border."""
    W, G = fill_holes(V, F)
    W, filled = _unit(W), Topology(G)
    return np.ascontiguousarray(W[: len(V)]), tutte_embedding(W, G, topology=filled)[: len(V)], filled.boundary_loops[0]


def _finished(V: FloatArray, F: IntArray, uv: FloatArray, method: str) -> FloatArray:
    """Right side up, at the scale of the least d."""
    uv = np.ascontiguousarray(uv)
    if not np.isfinite(uv).all():
        raise RefusedError(f"{method} gave coordinates that are not numbers on this mesh; use --method auto")
    s = singular_values(V, F, uv)
    if (s[:, 1] < 0).sum() * 2 > len(F):
        uv = uv * [1.0, -1.0]
    return uv * best_scale(V, F, uv)
