"""Which flat triangle a point lies in."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.tolerances import BARYCENTRIC


class Locator:
    """Point location in flat triangles: build once, ask for many points at a time.

    Parameters
    ----------
    UV : (k, 2) float, mm
    F : (m, 3) int

    Examples
    --------
    >>> where = Locator(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> where.faces([[0.9, 0.1], [0.1, 0.9], [2, 2]]).tolist()
    [0, 1, -1]
    """

    def __init__(self, UV: NDArray[np.float64], F: NDArray[np.int64]) -> None:
        import shapely

        self._corners = UV[F]
        low, high = self._corners.min(axis=1), self._corners.max(axis=1)
        self._tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))

    def faces(self, points: ArrayLike) -> NDArray[np.int64]:
        """Index of the triangle each point lies in, (n,); -1 where it lies in none.

        A point on an edge belongs to one of the triangles there.
        """
        return self.barycentric(points)[0]

    def barycentric(self, points: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Triangle (n,), -1 for none, and barycentric coordinates in it, (n, 3)."""
        import shapely

        xy = np.asarray(points, dtype=float).reshape(-1, 2)
        # No predicate: the envelope of a box is the box, and a point has nothing but its envelope.
        which, tri = self._tree.query(shapely.points(xy))
        a, b, c = np.moveaxis(self._corners[tri], 1, 0)
        p = xy[which]
        double = _cross(b - a, c - a)
        size = np.where(double != 0, double, 1.0)
        weights = np.column_stack([_cross(c - b, p - b), _cross(a - c, p - c), _cross(b - a, p - a)]) / size[:, None]
        depth = np.where(double != 0, weights.min(axis=1), -np.inf)
        # The deepest triangle wins; the last written stays, so shallow ones go first.
        order = np.argsort(depth, kind="stable")
        order = order[depth[order] >= -BARYCENTRIC]
        face = np.full(len(xy), -1, dtype=np.int64)
        coordinates = np.zeros((len(xy), 3))
        face[which[order]] = tri[order]
        coordinates[which[order]] = weights[order]
        return face, coordinates


def _cross(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
