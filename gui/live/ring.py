"""The last so many rows of a stream of numbers, always in one piece."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


class Ring:
    """Times that only grow, and a row of values for each; the oldest are let go.

    Parameters
    ----------
    columns : int
    capacity : int
        Rows that are kept.

    Examples
    --------
    >>> ring = Ring(1, capacity=3)
    >>> ring.add(np.arange(5.0), np.arange(5.0)[:, None])
    >>> ring.time.tolist(), ring.rows[:, 0].tolist()
    ([2.0, 3.0, 4.0], [2.0, 3.0, 4.0])
    """

    def __init__(self, columns: int, *, capacity: int) -> None:
        self.capacity = capacity
        # Twice the room: what is kept moves to the front only when the end is reached, once in `capacity` rows.
        self._time, self._rows = np.empty(2 * capacity), np.empty((2 * capacity, columns))
        self._end = 0

    def __len__(self) -> int:
        return min(self._end, self.capacity)

    @property
    def time(self) -> FloatArray:
        """(n,) s; a view."""
        return self._time[self._end - len(self) : self._end]

    @property
    def rows(self) -> FloatArray:
        """(n, c); a view."""
        return self._rows[self._end - len(self) : self._end]

    def add(self, time: FloatArray, rows: FloatArray) -> None:
        """Add rows (k, c) with their times (k,)."""
        time, rows = time[-self.capacity :], rows[-self.capacity :]
        k = len(time)
        if self._end + k > 2 * self.capacity:
            kept = min(len(self), self.capacity - k)
            self._time[:kept] = self._time[self._end - kept : self._end].copy()
            self._rows[:kept] = self._rows[self._end - kept : self._end].copy()
            self._end = kept
        self._time[self._end : self._end + k] = time
        self._rows[self._end : self._end + k] = rows
        self._end += k

    def clear(self) -> None:
        """Let all of it go."""
        self._end = 0

    def since(self, start: float) -> tuple[FloatArray, FloatArray]:
        """Times and rows from the last one before `start` on; views."""
        time = self.time
        first = max(int(np.searchsorted(time, start)) - 1, 0)
        return time[first:], self.rows[first:]
