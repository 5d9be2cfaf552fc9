"""The part of a surface round a point, as a brush covers it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.mesh.model import Mesh


def faces_within(mesh: Mesh, face: int, point: ArrayLike, radius: float) -> NDArray[np.int64]:
    """Faces that hang together with `face` and whose middles lie within `radius` of `point`; `face` itself always does.

    Parameters
    ----------
    mesh : Mesh
    face : int
    point : (3,) float, mm
    radius : float, mm

    Returns
    -------
    (k,) int64, ascending

    Examples
    --------
    >>> strip = Mesh(np.array([[0.0, 0, 0], [0, 3, 0], [3, 0, 0], [3, 3, 0]]), np.array([[0, 2, 1], [1, 2, 3]]))
    >>> faces_within(strip, 0, [0, 0, 0], 1.0).tolist(), faces_within(strip, 0, [0, 0, 0], 3.0).tolist()
    ([0], [0, 1])
    """
    corners = mesh.V[mesh.F]
    near = np.einsum("ni,ni->n", *(2 * [corners.mean(axis=1) - np.asarray(point, dtype=np.float64)])) <= radius**2
    near[face] = True
    chosen = np.flatnonzero(near)
    # The far side of a thin wall is as near, but does not hang together with this one inside the brush.
    neighbours = mesh.topology.EF[mesh.topology.FE[chosen]]
    beside = np.where(neighbours[..., 0] == chosen[:, None], neighbours[..., 1], neighbours[..., 0])
    local = np.full(len(mesh.F) + 1, -1)
    local[chosen] = np.arange(len(chosen))
    to = local[beside]
    reached = np.zeros(len(chosen), dtype=bool)
    front = local[[face]]
    while len(front):
        reached[front] = True
        front = np.unique(to[front])
        front = front[(front >= 0) & ~reached[np.maximum(front, 0)]]
    return chosen[reached]
