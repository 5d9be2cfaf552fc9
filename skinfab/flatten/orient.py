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
    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shapely.MultiPoint(UV)))
    if len(box) < 4:
        return UV - UV.min(axis=0)
    sides = np.diff(box[:3], axis=0)
    long = sides[np.argmax(np.hypot(*sides.T))]
    c, s = long / np.hypot(*long)
    turned = UV @ np.array([[c, -s], [s, c]])
    return turned - turned.min(axis=0)
