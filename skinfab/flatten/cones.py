"""Cone singularities: take the curvature in at a few points and cut through them (BFF, section 5).

With u = 0 at the cones and on the boundary, u is the scale that lays everything else flat; the cone angles
follow from it. A cone put where |u| is largest takes most area distortion away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from skinfab.errors import InputError
from skinfab.flatten.laplacian import intrinsic
from skinfab.linalg import Cholesky
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Automatic placement stops when the largest log scale factor is below this: 5 % of length, d about 4.02.
_GOOD_SCALE = 0.05

#: ... or at this many cones.
_MOST_CONES = 64


def cone_scale(V: FloatArray, F: IntArray, cones: IntArray, *, topology: Topology | None = None) -> tuple[FloatArray, FloatArray]:
    """Log scale factors that flatten everything but the cones, and the cones' curvature.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        One component, every vertex in use.
    cones : (c,) int64
        Vertices; at least one when the mesh is closed.

    Returns
    -------
    u : (n,) float
        Zero at cones and on the boundary.
    curvature : (c,) float, rad
        2 pi minus the cone's angle. With the boundary's turning they sum to 2 pi times the Euler number.

    Raises
    ------
    InputError
        A closed mesh without cones: there is nowhere for its curvature to go.
    """
    topology = topology or Topology(F)
    fixed = np.zeros(len(V), dtype=bool)
    fixed[topology.E[topology.is_boundary].ravel()] = True
    fixed[cones] = True
    if not fixed.any():
        raise InputError("a closed mesh needs at least one cone; use --cones 8, --cones auto or a list of vertices")
    corners = intrinsic(V, F)
    L = corners.stiffness()
    defect = 2 * np.pi - corners.angle_sum
    free = np.flatnonzero(~fixed)
    u = np.zeros(len(V))
    if len(free):
        u[free] = Cholesky(csc_array(L[free][:, free])).solve(-defect[free])
    return u, defect[cones] + (L @ u)[cones]


def place_cones(V: FloatArray, F: IntArray, *, count: int | None = None, topology: Topology | None = None) -> IntArray:
    """Vertices for `count` cones, or for as many as the mesh needs.

    Each cone goes where the log scale factor is farthest from zero under the cones so far. On a closed mesh the
    first goes to the sharpest vertex.

    Parameters
    ----------
    V, F
        As for `cone_scale`.
    count : int, optional
        Default: until no scale factor is off by more than 5 %, at most 64.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> sorted(place_cones(V, F, count=4).tolist())
    [0, 1, 2, 3]
    """
    topology = topology or Topology(F)
    cones: list[int] = []
    sharpness = np.abs(2 * np.pi - intrinsic(V, F).angle_sum)
    if not topology.is_boundary.any():
        cones.append(int(np.argmax(sharpness)))
    most = _MOST_CONES if count is None else min(count, len(V))
    while len(cones) < most:
        u, _ = cone_scale(V, F, np.array(cones, dtype=np.int64), topology=topology)
        worst = int(np.argmax(np.abs(u)))
        if abs(u[worst]) < (_GOOD_SCALE if count is None else 1e-9):
            break
        cones.append(worst)
    if count is not None:
        cones += _sharpest_left(sharpness, cones, topology, count - len(cones))
    return np.array(cones, dtype=np.int64)


def _sharpest_left(sharpness: FloatArray, cones: list[int], topology: Topology, missing: int) -> list[int]:
    """When u is already zero everywhere (all vertices are cones), the rest are the sharpest inner vertices left."""
    score = sharpness.copy()
    score[cones] = -1
    score[topology.E[topology.is_boundary].ravel()] = -1
    order = np.argsort(-score, kind="stable")[: max(missing, 0)]
    return [int(v) for v in order if score[v] > 1e-9]
