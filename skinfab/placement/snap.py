"""Where a sensor that is moved by hand comes to lie: on a grid, in line with others, at round angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Snapped:
    """A point and what it was drawn to.

    Parameters
    ----------
    point : (2,) float, mm
    lines : (k, 2, 2) float, mm
        From the point to each of the others it is in line with.
    """

    point: Float
    lines: Float


def snap_point(point: ArrayLike, *, grid: float, others: ArrayLike = (), reach: float = 0.0) -> Snapped:
    """The nearest place in line with one of the others, across or up, else on the grid.

    Parameters
    ----------
    point : (2,) float, mm
    grid : float, mm
        0 for none.
    others : (k, 2) float, mm
        Points to be in line with.
    reach : float, mm
        Others draw from as far as this.

    Examples
    --------
    >>> snap_point((9.8, 3.3), grid=1.0, others=[(10.1, 40.0)], reach=0.5).point.tolist()
    [10.1, 3.0]
    """
    point = np.asarray(point, dtype=float)
    targets = np.asarray(others, dtype=float).reshape(-1, 2)
    placed = point.copy() if grid <= 0 else np.round(point / grid) * grid
    lines = []
    for axis in (0, 1):
        away = np.abs(targets[:, axis] - point[axis])
        if len(away) and away.min() <= reach:
            placed[axis] = targets[int(np.argmin(away)), axis]
            lines.append(targets[int(np.argmin(away))])
    return Snapped(placed, np.array([(placed, line) for line in lines]).reshape(-1, 2, 2))


def snap_angle(angle: float, *, step: float) -> float:
    """The multiple of `step` nearest to an angle, rad.

    Examples
    --------
    >>> round(float(np.degrees(snap_angle(np.radians(52.0), step=np.radians(15.0)))), 9)
    45.0
    """
    return round(angle / step) * step
