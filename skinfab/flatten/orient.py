"""Turn and shift flat coordinates into the piece frame."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray


def orient(UV: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lay the smallest enclosing rectangle along the axes, the long side along x, its lower left corner at (0, 0).

    Parameters
    ----------
    UV : (n, 2) float64, mm

    Returns
    -------
    (n, 2) float64, mm

    Examples
    --------
    >>> orient(np.array([[0.0, 0], [1, 1], [-1, 3], [-2, 2]])).max(axis=0).round(6).tolist()
    [2.828427, 1.414214]
    """
    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shapely.MultiPoint(_outer(UV))))
    if len(box) < 4:
        return UV - UV.min(axis=0)
    sides = np.diff(box[:3], axis=0)
    long = sides[np.argmax(np.hypot(*sides.T))]
    c, s = long / np.hypot(*long)
    turned = UV @ np.array([[c, -s], [s, c]])
    return turned - turned.min(axis=0)


# Directions whose farthest points span the polygon within which no point can be on the hull.
_DIRECTIONS = 16


def _outer(UV: NDArray[np.float64]) -> NDArray[np.float64]:
    """The points that may lie on the convex hull: those not well inside the polygon of the farthest ones (Akl and Toussaint 1978)."""
    angle = np.arange(_DIRECTIONS) * (2 * np.pi / _DIRECTIONS)
    x, y = np.ascontiguousarray(UV.T)
    far = np.array([np.argmax(c * x + s * y) for c, s in zip(np.cos(angle), np.sin(angle), strict=True)])
    corners = UV[far]
    inside = np.ones(len(UV), dtype=bool)
    rounding = np.finfo(float).eps * 64 * np.ptp(UV, axis=0).max() * np.abs(UV).max()
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if ax != bx or ay != by:
            inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) > rounding
    # A polygon of one or two corners has no inside.
    return UV[~inside] if len(set(far.tolist())) > 2 else UV
