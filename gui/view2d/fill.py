"""Which flat triangle each pixel shows: compiled, because 85k polygons are slow to draw and quick to fill."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

#: Pixel centres this far (pixels) outside an edge are still painted: rounding must open no gap between neighbours.
_EDGE = 1e-6


@numba.njit(cache=True, nogil=True)
def fill(points: NDArray[np.float64], F: NDArray[np.int32], face: NDArray[np.int32]) -> None:
    """Write the number of each triangle into the pixels whose centres it covers.

    Parameters
    ----------
    points : (n, 2) float64, pixels
        Column and row (counted down) of each vertex; the centre of the first pixel is at (0.5, 0.5).
    F : (m, 3) int32
        Wound either way.
    face : (rows, columns) int32
        Is filled with indices into `F`; -1 where there is none.
    """
    rows, columns = face.shape
    face[:] = -1
    for t in range(F.shape[0]):
        ax, ay = points[F[t, 0], 0], points[F[t, 0], 1]
        bx, by = points[F[t, 1], 0], points[F[t, 1], 1]
        cx, cy = points[F[t, 2], 0], points[F[t, 2], 1]
        if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0:
            bx, by, cx, cy = cx, cy, bx, by
        top, bottom = min(ay, by, cy), max(ay, by, cy)
        left, right = min(ax, bx, cx), max(ax, bx, cx)
        if bottom < 0 or top > rows or right < 0 or left > columns:
            continue
        # First and last pixel whose centre lies within the box.
        i0, i1 = max(int(np.ceil(top - 0.5)), 0), min(int(np.floor(bottom - 0.5)), rows - 1)
        j0, j1 = max(int(np.ceil(left - 0.5)), 0), min(int(np.floor(right - 0.5)), columns - 1)
        for i in range(i0, i1 + 1):
            y = i + 0.5
            for j in range(j0, j1 + 1):
                x = j + 0.5
                if (
                    (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= -_EDGE
                    and (cx - bx) * (y - by) - (cy - by) * (x - bx) >= -_EDGE
                    and (ax - cx) * (y - cy) - (ay - cy) * (x - cx) >= -_EDGE
                ):
                    face[i, j] = t
