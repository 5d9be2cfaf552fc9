"""Where labels go in a picture: the nearest place that covers no line and no other label."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

#: Side of the cells in which free room is kept, pixels: finer than the eye sees a label's place.
_CELL = 2


class Room:
    """What of a picture is taken; x to the right and y up, in pixels.

    Parameters
    ----------
    width, height : float, pixels

    Examples
    --------
    >>> room = Room(100, 60)
    >>> room.take(np.column_stack([np.arange(100), np.full(100, 30)]), radius=4)  # a line across
    >>> x, y = room.place((20, 10), near=(50, 28))
    >>> abs(x - 50) <= 2, 12 <= y <= 21
    (True, True)
    >>> room.place((20, 50), near=(50, 30)) is None
    True
    """

    def __init__(self, width: float, height: float) -> None:
        self._taken = np.zeros((max(int(height) // _CELL, 1), max(int(width) // _CELL, 1)), dtype=bool)

    def take(self, points: ArrayLike, *, radius: float) -> None:
        """Let nothing come nearer than `radius` to these points (k, 2); a line is points at most two pixels apart."""
        cells = np.unique(np.floor(np.asarray(points, dtype=float) / _CELL).astype(np.int64), axis=0)
        reach = int(np.ceil(radius / _CELL))
        for dx in range(-reach, reach + 1):
            for dy in range(-reach, reach + 1):
                column, row = cells[:, 0] + dx, cells[:, 1] + dy
                inside = (row >= 0) & (row < self._taken.shape[0]) & (column >= 0) & (column < self._taken.shape[1])
                self._taken[row[inside], column[inside]] = True

    def fill(self, taken: NDArray[np.bool_]) -> None:
        """Take what a picture (height, width) has marked, besides what is taken already."""
        rows, columns = (each * _CELL for each in self._taken.shape)
        padded = np.ones((rows, columns), dtype=bool)
        part = taken[:rows, :columns]
        padded[: part.shape[0], : part.shape[1]] = part
        self._taken |= padded.reshape(rows // _CELL, _CELL, columns // _CELL, _CELL).any(axis=(1, 3))

    def place(self, size: tuple[float, float], *, near: ArrayLike) -> tuple[float, float] | None:
        """Centre of the free box of that width and height that is nearest to a point, which it takes; None where none is free."""
        columns, rows = (int(np.ceil(each / _CELL)) + 1 for each in size)
        if rows > self._taken.shape[0] or columns > self._taken.shape[1]:
            return None
        total = np.zeros(np.add(self._taken.shape, 1), dtype=np.int64)
        total[1:, 1:] = self._taken.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
        inside = total[rows:, columns:] - total[:-rows, columns:] - total[rows:, :-columns] + total[:-rows, :-columns]
        row, column = np.nonzero(inside == 0)
        if not len(row):
            return None
        x, y = (column + columns / 2) * _CELL, (row + rows / 2) * _CELL
        to_x, to_y = np.asarray(near, dtype=float)
        best = int(np.argmin((x - to_x) ** 2 + (y - to_y) ** 2))
        self._taken[row[best] : row[best] + rows, column[best] : column[best] + columns] = True
        return float(x[best]), float(y[best])


def dense(line: FloatArray, *, closed: bool = False, step: float = 2.0) -> FloatArray:
    """Points along a polyline (k, 2) at most `step` apart, its own among them.

    Examples
    --------
    >>> dense(np.array([[0.0, 0], [3, 0]])).tolist()
    [[0.0, 0.0], [1.5, 0.0], [3.0, 0.0]]
    """
    ends = np.vstack([line, line[:1]]) if closed else line
    edge = np.diff(ends, axis=0)
    count = np.maximum(np.ceil(np.linalg.norm(edge, axis=1) / step), 1).astype(np.int64)
    which = np.repeat(np.arange(len(edge)), count)
    t = (np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)) / count[which]
    return np.vstack([ends[which] + t[:, None] * edge[which], ends[-1:]])
