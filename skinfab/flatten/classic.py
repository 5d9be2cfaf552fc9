"""The classic flattenings, through libigl: for comparison, and for those who want just these.

libigl trusts its input (a closed mesh ends the process), so a disk is asked for before each call.
"""

from __future__ import annotations

import igl
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import RefusedError
from skinfab.flatten.bff import require_disk
from skinfab.flatten.distortion import best_scale, singular_values
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Enough for both to settle on real meshes; SLIM's and ARAP's own papers use 10 to 20.
_ITERATIONS = 30


def lscm(V: FloatArray, F: IntArray) -> FloatArray:
    """Least squares conformal map (Levy et al. 2002), two far boundary vertices held; (n, 2) mm."""
    loop = require_disk(Topology(F), len(V))
    far = int(np.argmax(np.linalg.norm(V[loop] - V[loop[0]], axis=1)))
    held = np.array([loop[0], loop[far]], dtype=np.int64)
    uv = igl.lscm(V, F, held, np.array([[0.0, 0.0], [1.0, 0.0]]))[0]
    return _finished(V, F, uv, "lscm")


def harmonic(V: FloatArray, F: IntArray) -> FloatArray:
    """Harmonic map onto a circle (cotangent weights); (n, 2) mm."""
    loop = require_disk(Topology(F), len(V))
    circle = igl.map_vertices_to_circle(np.asfortranarray(V), loop.astype(np.int32))
    return _finished(V, F, igl.harmonic(V, F, loop, np.ascontiguousarray(circle), 1), "harmonic")


def arap(V: FloatArray, F: IntArray) -> FloatArray:
    """As rigid as possible (Liu et al. 2008), from Tutte's embedding; (n, 2) mm."""
    loop = require_disk(Topology(F), len(V))
    start = tutte_embedding(V, F)
    data = igl.ARAPData()
    data.max_iter = _ITERATIONS
    # Nothing held, the system is singular, and rounding decides whether it factors.
    held = loop[:1].astype(np.int32)
    igl.arap_precomputation(V, F, 2, held, data)
    return _finished(V, F, igl.arap_solve(start[held], data, start), "arap")


def slim(V: FloatArray, F: IntArray) -> FloatArray:
    """Scalable locally injective maps (Rabinovich et al. 2017) on the energy d itself, from Tutte's embedding; (n, 2) mm."""
    require_disk(Topology(F), len(V))
    # SLIM never returns from a start with a flip; Tutte's has none.
    data = igl.slim_precompute(
        np.asfortranarray(V),
        np.asfortranarray(F.astype(np.int32)),
        np.asfortranarray(tutte_embedding(V, F)),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, dtype=np.int32),
        np.zeros((0, 2), order="F"),
        0.0,
    )
    return _finished(V, F, np.asarray(igl.slim_solve(data, _ITERATIONS))[:, :2], "slim")


def _finished(V: FloatArray, F: IntArray, uv: FloatArray, method: str) -> FloatArray:
    """Right side up, at the scale of the least d."""
    uv = np.ascontiguousarray(uv)
    if not np.isfinite(uv).all():
        raise RefusedError(f"{method} gave coordinates that are not numbers on this mesh; use --method auto")
    s = singular_values(V, F, uv)
    if (s[:, 1] < 0).sum() * 2 > len(F):
        uv = uv * [1.0, -1.0]
    return uv * best_scale(V, F, uv)
