"""What a curve covers of each column of pixels: its least and most there, however many samples lie in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Spans:
    """Least and most of each channel in each column.

    Parameters
    ----------
    low, high : (w, c) float
        In the channel's unit; NaN where it has no curve.
    """

    low: FloatArray
    high: FloatArray


def spans(time: FloatArray, rows: FloatArray, *, start: float, step: float, width: int, hole: float) -> Spans:
    """The polyline through the samples, cut into columns: no peak is lost, and neighbours touch.

    Parameters
    ----------
    time : (n,) float, s
        It only grows.
    rows : (n, c) float
        NaN where a channel said nothing: the line is broken there.
    start, step : float, s
        Where the first column begins, and how long each is.
    width : int
        Columns.
    hole : float, s
        The line is broken where the time between two samples is longer.

    Examples
    --------
    >>> found = spans(np.arange(5.0), np.array([[0.0], [9], [0], [1], [2]]), start=0.0, step=2.0, width=2, hole=1.5)
    >>> found.low[:, 0].tolist(), found.high[:, 0].tolist()
    ([0.0, 0.0], [9.0, 2.0])
    """
    c = rows.shape[1]
    if not len(time):
        return Spans(np.full((width, c), np.nan), np.full((width, c), np.nan))
    edges: FloatArray = start + step * np.arange(width + 1, dtype=np.float64)
    after = np.searchsorted(time, edges)
    at = _between(time, rows, edges, after, hole)
    low, high = np.fmin(at[:-1], at[1:]), np.fmax(at[:-1], at[1:])
    begin = after[:-1]
    some = np.flatnonzero(after[1:] > begin)
    if len(some):
        # Columns without a sample have none to skip either: the rows of the others follow one another.
        inside = rows[: after[-1]]
        low[some] = np.fmin(low[some], np.fmin.reduceat(inside, begin[some], axis=0))
        high[some] = np.fmax(high[some], np.fmax.reduceat(inside, begin[some], axis=0))
    return Spans(low, high)


def _between(time: FloatArray, rows: FloatArray, edges: FloatArray, after: NDArray[np.int64], hole: float) -> FloatArray:
    """The line's value where two columns meet, (w + 1, c)."""
    n = len(time)
    a, b = np.clip(after - 1, 0, n - 1), np.clip(after, 0, n - 1)
    apart = time[b] - time[a]
    known = (after > 0) & (after < n) & (apart <= hole) & (apart > 0)
    part = np.where(known, (edges - time[a]) / np.where(known, apart, 1.0), np.nan)
    found: FloatArray = rows[a] + part[:, None] * (rows[b] - rows[a])
    return found
