"""Which step each pixel of the picture shows: compiled, so that a picture of 100,000 moves is redrawn by a table look-up."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray


@numba.njit(cache=True, nogil=True)
def mark(
    parts: NDArray[np.float64],
    reach: NDArray[np.float64],
    layer: NDArray[np.int64],
    step: NDArray[np.int64],
    marks: NDArray[np.int32],
    layers: NDArray[np.int8],
) -> None:
    """Write the number of each part's step into the pixels it covers; a higher layer hides a lower one, an earlier step a later one.

    Parameters
    ----------
    parts : (k, 2, 2) float64, pixels
        Column and row (counted down) of both ends; the centre of the first pixel is at (0.5, 0.5).
    reach : (k,) float64, pixels
        How far from the part its pixels may be.
    layer : (k,) int64
        0 and up.
    step : (k,) int64
    marks : (rows, columns) int32
        Is filled; -1 where there is nothing.
    layers : (rows, columns) int8
        Is filled with the layers that are seen; -1 where there is nothing.
    """
    rows, columns = marks.shape
    marks[:] = -1
    layers[:] = -1
    for k in range(parts.shape[0]):
        ax, ay, bx, by = parts[k, 0, 0], parts[k, 0, 1], parts[k, 1, 0], parts[k, 1, 1]
        r = reach[k]
        left, right = min(ax, bx) - r, max(ax, bx) + r
        top, bottom = min(ay, by) - r, max(ay, by) + r
        if right < 0 or left > columns or bottom < 0 or top > rows:
            continue
        dx, dy = bx - ax, by - ay
        square = dx * dx + dy * dy
        steep = abs(dy) > 1e-9
        half = r * np.sqrt(square) / abs(dy) if steep else 0.0
        for i in range(max(int(np.ceil(top - 0.5)), 0), min(int(np.floor(bottom - 0.5)), rows - 1) + 1):
            y = i + 0.5
            low, high = left, right
            if steep:  # of a long slanting line only few pixels of each row are near
                middle = ax + (y - ay) * dx / dy
                low, high = max(left, middle - half - r), min(right, middle + half + r)
            for j in range(max(int(np.ceil(low - 0.5)), 0), min(int(np.floor(high - 0.5)), columns - 1) + 1):
                if layers[i, j] > layer[k] or (layers[i, j] == layer[k] and marks[i, j] <= step[k]):
                    continue
                x = j + 0.5
                t = ((x - ax) * dx + (y - ay) * dy) / square if square > 0 else 0.0
                t = min(max(t, 0.0), 1.0)
                ex, ey = x - ax - t * dx, y - ay - t * dy
                if ex * ex + ey * ey <= r * r:
                    marks[i, j] = step[k]
                    layers[i, j] = layer[k]


def warm() -> None:
    """Compile it, or load what was compiled before: some tenths of a second that the window should not stand still for."""
    nothing = np.zeros(0, dtype=np.int64)
    mark(np.zeros((0, 2, 2)), np.zeros(0), nothing, nothing, np.zeros((1, 1), dtype=np.int32), np.zeros((1, 1), dtype=np.int8))
