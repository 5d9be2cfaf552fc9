"""Polygons into triangles: fans where they are convex, a planar triangulation where they are not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

IntArray = NDArray[np.int64]

# The planar triangulation takes time with the square of the corners: 1.8 s for 20,000 of a star.
_MOST_CORNERS = 10_000


def triangulate(V: NDArray[np.float64], corners: IntArray, sizes: IntArray) -> IntArray:
    """Triangles of polygons given one after the other.

    Parameters
    ----------
    V : (n, 3) float64
    corners : (c,) int64
        Indices into `V`, polygon after polygon.
    sizes : (p,) int64
        Corners of each polygon, 3 or more; they sum to c.

    Returns
    -------
    (c - 2 p, 3) int64
        In the order of the polygons, with their winding.

    Raises
    ------
    InputError
        A polygon is not convex and has more than 10,000 corners.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 1, 0], [2, 0, 0], [1, 3, 0]])  # a dart: its fan from corner 0 would fold
    >>> triangulate(V, np.array([0, 1, 2, 3]), np.array([4])).tolist()
    [[1, 2, 3], [1, 3, 0]]
    """
    if (sizes == 3).all():
        return corners.reshape(-1, 3)
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    polygon = np.repeat(np.arange(len(sizes)), sizes - 2)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(sizes - 2) - (sizes - 2), sizes - 2)
    F = np.column_stack([corners[first[polygon]], corners[first[polygon] + step + 1], corners[first[polygon] + step + 2]])
    p = V[F]
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    total = np.column_stack([np.bincount(polygon, weights=n, minlength=len(sizes)) for n in normal.T])
    folded = np.zeros(len(sizes), dtype=bool)
    folded[polygon[(normal * total[polygon]).sum(axis=1) < 0]] = True
    if folded.any():
        start = np.cumsum(sizes - 2) - (sizes - 2)
        for k in np.flatnonzero(folded):
            ring = corners[first[k] : first[k] + sizes[k]]
            F[start[k] : start[k] + sizes[k] - 2] = _quad(V, ring) if len(ring) == 4 else _planar(V, ring, total[k])
    return F


def _quad(V: NDArray[np.float64], ring: IntArray) -> IntArray:
    """A folded fan from corner 0 of a quad: the other diagonal."""
    return ring[[[1, 2, 3], [1, 3, 0]]]


def _planar(V: NDArray[np.float64], ring: IntArray, normal: NDArray[np.float64]) -> IntArray:
    """Triangulate in the plane across the polygon's normal; the fan where that cannot be done."""
    import manifold3d

    fan = np.column_stack([np.full(len(ring) - 2, ring[0]), ring[1:-1], ring[2:]])
    length = np.linalg.norm(normal)
    if len(ring) > _MOST_CORNERS:
        raise InputError(f"a face has {len(ring)} corners and is not convex; triangulate it in a mesh editor first")
    if not length > 0 or len(np.unique(ring)) < len(ring):
        return fan
    across = np.eye(3)[np.argmin(np.abs(normal))]
    u = np.cross(across, normal)
    u /= np.linalg.norm(u)
    v = np.cross(normal / length, u)
    flat = np.column_stack([V[ring] @ u, V[ring] @ v])
    flat = (flat - flat.mean(axis=0)) / np.ptp(flat, axis=0).max()
    triangles = np.asarray(manifold3d.triangulate([flat]), dtype=np.int64)
    return ring[triangles] if len(triangles) == len(ring) - 2 else fan
