"""Which triangle each pixel of a picture shows: a small z-buffer, quick where matplotlib's polygons are slow.

85k triangles take a fraction of a second here and some ten seconds as a matplotlib collection of polygons.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

#: Pixels worked on at a time: bounds the memory, not the result.
_BATCH = 2_000_000

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def rasterise(points: FloatArray, F: IntArray, *, shape: tuple[int, int]) -> tuple[IntArray, FloatArray]:
    """Draw triangles into a grid of pixels, nearest on top.

    Parameters
    ----------
    points : (n, 3) float64, pixels
        Column, row and depth (larger is farther) of each vertex; the centre of pixel (row i, column j) is (j, i).
    F : (m, 3) int64
    shape : (rows, columns)

    Returns
    -------
    face : (rows, columns) int64
        The face each pixel shows, -1 where there is none.
    depth : (rows, columns) float64
        Its depth there; infinite where there is none.

    Examples
    --------
    >>> points = np.array([[0.0, 0, 1], [2, 0, 1], [0, 2, 1]])
    >>> rasterise(points, np.array([[0, 1, 2]]), shape=(3, 4))[0].tolist()
    [[0, 0, 0, -1], [0, 0, -1, -1], [0, -1, -1, -1]]
    """
    rows, columns = shape
    face = np.full(rows * columns, -1, dtype=np.int64)
    depth = np.full(rows * columns, np.inf)
    corners = points[F]
    planes = _planes(corners)
    first = np.clip(np.ceil(corners[:, :, 1].min(axis=1)), 0, rows).astype(np.int64)
    last = np.clip(np.floor(corners[:, :, 1].max(axis=1)), -1, rows - 1).astype(np.int64)
    width = np.ptp(corners[:, :, 0], axis=1) + 1
    work = np.cumsum(np.maximum(last - first + 1, 0) * np.minimum(width, columns))
    stops: Sequence[int] = (
        np.unique(np.searchsorted(work, np.arange(_BATCH, work[-1] + _BATCH, _BATCH), side="right")).tolist() if len(F) else []
    )
    start = 0
    for stop in [*stops, len(F)]:
        mine = np.arange(start, max(stop, start))
        start = max(stop, start)
        triangle, row = _expand(mine, first[mine], last[mine])
        at, which, z = _spans(corners, planes, triangle, row, columns)
        np.minimum.at(depth, at, z)
        on_top = z == depth[at]
        face[at[on_top]] = which[on_top]
    return face.reshape(shape), depth.reshape(shape)


def _expand(what: IntArray, first: IntArray, last: IntArray) -> tuple[IntArray, IntArray]:
    """Each of `what` once for every whole number from its `first` to its `last`, and that number."""
    count = np.maximum(last - first + 1, 0)
    before = np.cumsum(count) - count
    return np.repeat(what, count), np.arange(count.sum()) - np.repeat(before - first, count)


def _spans(
    corners: FloatArray, planes: FloatArray, triangle: IntArray, row: IntArray, columns: int
) -> tuple[IntArray, IntArray, FloatArray]:
    """Pixels of each triangle on each of its rows: index into the flat picture, triangle, depth."""
    # Where the row crosses the three edges; an edge that it does not cross gives nothing.
    a, b = corners[triangle], np.roll(corners, -1, axis=1)[triangle]
    rise = b[:, :, 1] - a[:, :, 1]
    t = np.divide(row[:, None] - a[:, :, 1], rise, out=np.full(rise.shape, np.nan), where=rise != 0)
    inside = (t >= 0) & (t <= 1)
    x = a[:, :, 0] + t * (b[:, :, 0] - a[:, :, 0])
    level = (rise == 0) & (a[:, :, 1] == row[:, None])  # an edge that lies on the row counts with its start; its neighbours have the end
    x = np.where(level, a[:, :, 0], x)
    inside |= level
    low = np.where(inside, x, np.inf).min(axis=1)
    high = np.where(inside, x, -np.inf).max(axis=1)
    crossed = low <= high
    left = np.where(crossed, np.clip(np.ceil(low), 0, columns), 0).astype(np.int64)
    right = np.where(crossed, np.clip(np.floor(high), -1, columns - 1), -1).astype(np.int64)
    which, column = _expand(np.arange(len(triangle)), left, right)
    chosen = triangle[which]
    plane = planes[chosen]
    z = plane[:, 0] + plane[:, 1] * column + plane[:, 2] * row[which]
    # A sliver's plane is steep enough for rounding to throw z far off.
    return row[which] * columns + column, chosen, np.clip(z, plane[:, 3], plane[:, 4])


def _planes(corners: FloatArray) -> FloatArray:
    """Depth over each triangle as z = p0 + p1 x + p2 y (that of its first corner where it is seen edge on), and its bounds: (m, 5)."""
    e, f = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]
    rise_x, rise_y = e[:, 2] * f[:, 1] - f[:, 2] * e[:, 1], f[:, 2] * e[:, 0] - e[:, 2] * f[:, 0]
    gx, gy = (np.divide(rise, area, out=np.zeros_like(area), where=area != 0) for rise in (rise_x, rise_y))
    z = corners[:, :, 2]
    return np.stack([z[:, 0] - gx * corners[:, 0, 0] - gy * corners[:, 0, 1], gx, gy, z.min(axis=1), z.max(axis=1)], axis=1)


def is_visible(points: FloatArray, depth: FloatArray, *, slack: float) -> NDArray[np.bool_]:
    """Which of the `points` (k, 3) lie in the picture and no farther than the surface there by more than `slack`, (k,)."""
    column, row = np.rint(points[:, 0]).astype(np.int64), np.rint(points[:, 1]).astype(np.int64)
    inside = (row >= 0) & (row < depth.shape[0]) & (column >= 0) & (column < depth.shape[1])
    surface = np.full(len(points), np.inf)
    surface[inside] = depth[row[inside], column[inside]]
    # At the outline a hidden point may round to a pixel beyond the surface that hides it.
    seen: NDArray[np.bool_] = np.isfinite(surface) & (points[:, 2] <= surface + slack)
    return seen
