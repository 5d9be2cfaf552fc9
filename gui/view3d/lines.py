"""Seams, conductors and paths on the object: lines of any width, hidden where the object is in front of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from gui.state.selection import NOTHING, Target

Float32 = NDArray[np.float32]
Int32 = NDArray[np.int32]
Bytes = NDArray[np.uint8]


#: Pixels from one place of a stroke to the next at which is looked whether it is hidden, and how many such places at most.
_STEP, _MOST_STEPS = 1.5, 2048


@dataclass(frozen=True, eq=False)
class Strokes:
    """Straight strokes in space, grouped into items that have a colour, a width and a meaning; later items lie on top.

    Parameters
    ----------
    a, b : (s, 3) float32, mm
        Ends of each stroke.
    item : (s,) int32
    colour : (i, 3) uint8
        Of each item.
    width : (i,) float32, pixels
    targets : (i,) tuple of Target
        What an item stands for; `NOTHING` for what the pointer goes through.

    Examples
    --------
    >>> path = Strokes.polyline([[0, 0, 0], [1, 0, 0], [np.nan] * 3, [2, 0, 0], [3, 0, 0]], (200, 0, 0), 2.0)
    >>> both = Strokes.joined([path, path])
    >>> both.a.tolist(), both.item.tolist()
    ([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [0, 0, 1, 1])
    """

    a: Float32
    b: Float32
    item: Int32
    colour: Bytes
    width: Float32
    targets: tuple[Target, ...]

    @staticmethod
    def polyline(points: ArrayLike, colour: tuple[int, int, int], width: float, target: Target = NOTHING) -> Strokes:
        """One item along points (k, 3) mm; NaN breaks it, and a single point is a dot."""
        line = np.asarray(points, dtype=np.float32).reshape(-1, 3)
        a, b = (line[:-1], line[1:]) if len(line) != 1 else (line, line)
        there = np.isfinite(a).all(axis=1) & np.isfinite(b).all(axis=1)
        item = np.zeros(int(there.sum()), dtype=np.int32)
        return Strokes(a[there], b[there], item, np.array([colour], np.uint8), np.array([width], np.float32), (target,))

    @staticmethod
    def segments(a: ArrayLike, b: ArrayLike, colour: ArrayLike, width: ArrayLike, targets: Sequence[Target]) -> Strokes:
        """An item for each stroke from `a` to `b` (s, 3) mm, with a colour (s, 3) and a width (s,) each."""
        starts, ends = (np.asarray(each, dtype=np.float32).reshape(-1, 3) for each in (a, b))
        item = np.arange(len(starts), dtype=np.int32)
        colours = np.asarray(colour, dtype=np.uint8).reshape(-1, 3)
        return Strokes(starts, ends, item, colours, np.asarray(width, dtype=np.float32), tuple(targets))

    @staticmethod
    def joined(parts: Sequence[Strokes]) -> Strokes:
        """All of them, the last on top."""
        none = np.empty((0, 3), np.float32)
        before = np.cumsum([0, *(len(part.targets) for part in parts)])
        return Strokes(
            np.concatenate([none, *(part.a for part in parts)]),
            np.concatenate([none, *(part.b for part in parts)]),
            np.concatenate([np.empty(0, np.int32), *(part.item + np.int32(k) for part, k in zip(parts, before, strict=False))]),
            np.concatenate([np.empty((0, 3), np.uint8), *(part.colour for part in parts)]),
            np.concatenate([np.empty(0, np.float32), *(part.width for part in parts)]),
            tuple(target for part in parts for target in part.targets),
        )


@numba.njit(cache=True, nogil=True)
def seen(x: float, y: float, z: float, depth: Float32, slack: float, sharper: int) -> bool:
    """Whether a point at column x, row y of the picture and depth z is in it and not behind the surface by more than `slack`."""
    row, column = int(np.floor(y * sharper)), int(np.floor(x * sharper))
    if row < 0 or column < 0 or row >= depth.shape[0] or column >= depth.shape[1]:
        return False
    if np.isfinite(depth[row, column]):
        return z <= depth[row, column] + slack
    # On the outline the pixel itself may be beside the object; only a surface next to it says whether it is hidden.
    nearest = -np.inf
    for i in range(max(row - sharper, 0), min(row + sharper + 1, depth.shape[0])):
        for j in range(max(column - sharper, 0), min(column + sharper + 1, depth.shape[1])):
            if np.isfinite(depth[i, j]):
                nearest = max(nearest, depth[i, j])
    return z <= nearest + 0.25 * slack


@numba.njit(cache=True, nogil=True)
def seen_of(screen: Float32, depth: Float32, slack: float, sharper: int) -> NDArray[np.bool_]:
    """The same for points (k, 3), some of which may be NaN: (k,)."""
    found = np.zeros(len(screen), dtype=np.bool_)
    for k in range(len(screen)):
        x, y, z = screen[k, 0], screen[k, 1], screen[k, 2]
        found[k] = np.isfinite(x + y + z) and seen(x, y, z, depth, slack, sharper)
    return found


@numba.njit(cache=True, nogil=True)
def stroke(
    a: Float32, b: Float32, item: Int32, width: Float32, depth: Float32, slack: float, sharper: int, cover: Bytes, owner: Int32
) -> None:
    """Draw strokes with soft edges.

    Parameters
    ----------
    a, b : (s, 3) float32
        Column, row and depth of the ends.
    item : (s,) int32
    width : (i,) float32, pixels
        Of each item.
    depth : (sharper * rows, sharper * columns) float32, mm
        Of the object.
    slack : float, mm
        How far behind the surface a stroke may lie and still be seen: between two points of a surface it runs below it.
    cover : (rows, columns) uint8
        Is filled with how much of each pixel is covered, 0 to 255.
    owner : (rows, columns) int32
        Is filled with the item that covers it; -1 where there is none.
    """
    height, columns = cover.shape
    cover[:] = 0
    owner[:] = -1
    shown = np.empty(_MOST_STEPS + 1, dtype=np.bool_)
    for s in range(len(item)):
        ax, ay, az = a[s, 0], a[s, 1], a[s, 2]
        dx, dy, dz = b[s, 0] - ax, b[s, 1] - ay, b[s, 2] - az
        reach = np.float32(0.5) * width[item[s]] + np.float32(0.5)
        left, right = max(0, int(min(ax, ax + dx) - reach)), min(columns - 1, int(max(ax, ax + dx) + reach))
        top, bottom = max(0, int(min(ay, ay + dy) - reach)), min(height - 1, int(max(ay, ay + dy) + reach))
        if left > right or top > bottom:
            continue
        square = dx * dx + dy * dy
        # The stroke's own line decides what is hidden, so that a wide one is not cut off where the surface rises beside it.
        steps = min(int(np.sqrt(square) / _STEP) + 1, _MOST_STEPS)
        some = False
        for k in range(steps + 1):
            t = np.float32(k) / np.float32(steps)
            shown[k] = seen(ax + t * dx, ay + t * dy, az + t * dz, depth, slack, sharper)
            some = some or shown[k]
        if not some:
            continue
        inverse = np.float32(1) / square if square > 0 else np.float32(0)
        for row in range(top, bottom + 1):
            py = np.float32(row) + np.float32(0.5) - ay
            first, last = left, right
            if square > 16 * reach * reach and abs(dy) > np.float32(1e-6):
                # A long slanted stroke fills little of its box: only the columns near it on this row.
                middle = ax + py * dx / dy
                spread = reach * np.sqrt(square) / abs(dy) + 1
                first, last = max(left, int(max(middle - spread, 0))), min(right, int(min(middle + spread, columns)))
            for column in range(first, last + 1):
                if cover[row, column] == 255 and owner[row, column] == item[s]:
                    continue
                px = np.float32(column) + np.float32(0.5) - ax
                t = min(max((px * dx + py * dy) * inverse, np.float32(0)), np.float32(1))
                ex, ey = px - t * dx, py - t * dy
                apart = ex * ex + ey * ey
                if apart >= reach * reach or not shown[int(t * steps + np.float32(0.5))]:
                    continue
                much = np.uint8(255 * min(reach - np.sqrt(apart), np.float32(1)))
                if much > cover[row, column] or (item[s] != owner[row, column] and much > 127):
                    cover[row, column] = much
                    owner[row, column] = item[s]


@numba.njit(cache=True, nogil=True)
def lay_over(cover: Bytes, owner: Int32, colour: Bytes, image: Bytes) -> None:
    """Paint what `stroke` covered into a picture (rows, columns, 3) uint8."""
    for row in range(cover.shape[0]):
        for column in range(cover.shape[1]):
            much = np.int32(cover[row, column])
            if much:
                k = owner[row, column]
                for c in range(3):
                    old = np.int32(image[row, column, c])
                    image[row, column, c] = np.uint8(old + (np.int32(colour[k, c]) - old) * much // 255)
