"""A piece as a grid: how far every place is from the nearest thing a sensor must keep off.

Only for looking for places; what is found is verified exactly by `check`.
"""

from __future__ import annotations

import copy

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from skinfab.tolerances import RASTER_CELLS, RASTER_STEP_MM

Array = NDArray[np.float64]

#: About so many points of a shape are looked at before all the others.
_FEW = 12


class Raster:
    """Free space of a flat shape.

    Parameters
    ----------
    edges : (n, 2, 2) float, mm
        The whole boundary, holes and darts included, in any order.
    creases : (c, 2, 2) float, mm
        Further lines to keep off.

    Attributes
    ----------
    step : float, mm
        Side of a cell.
    free : (rows, columns) bool
        Inside, and no edge or crease runs through the cell.
    """

    def __init__(self, edges: Array, creases: Array) -> None:
        corners = edges.reshape(-1, 2)
        size = np.ptp(corners, axis=0)
        self.step = float(max(np.sqrt(size.prod() / RASTER_CELLS), RASTER_STEP_MM))
        # A rim of free cells' width all round is outside.
        self._origin = corners.min(axis=0) - 2 * self.step
        shape = np.ceil(size / self.step).astype(int) + 5
        self.free = _inside((edges - self._origin) / self.step, (int(shape[1]), int(shape[0])))
        self.block_lines(edges)
        self.block_lines(creases)
        self._clearance: Array | None = None

    def copy(self) -> Raster:
        """One to try things on."""
        twin = copy.copy(self)
        twin.free = self.free.copy()
        return twin

    def block_lines(self, lines: Array) -> None:
        """Take out the cells that lines (n, 2, 2) mm run through."""
        if not len(lines):
            return
        self.free[self._crossed(lines)] = False
        self._clearance = None

    def block_polygon(self, polygon: Array) -> None:
        """Take out all cells inside a polygon (k, 2) mm and on its rim."""
        edges = np.stack([polygon, np.roll(polygon, -1, axis=0)], axis=1)
        blocked = _inside((edges - self._origin) / self.step, self.free.shape)
        blocked[self._crossed(edges)] = True
        self.free &= ~blocked
        if self._clearance is not None:
            self._clearance = self._nearer(self._clearance, blocked)

    def _nearer(self, clearance: Array, blocked: NDArray[np.bool_]) -> Array:
        """The clearance with further cells blocked: nothing changes farther from them than the clearance is anywhere."""
        reach = int(np.ceil(clearance.max() / self.step)) + 1
        rows, columns = np.flatnonzero(blocked.any(axis=1)), np.flatnonzero(blocked.any(axis=0))
        near = (slice(max(rows[0] - reach, 0), rows[-1] + reach + 1), slice(max(columns[0] - reach, 0), columns[-1] + reach + 1))
        changed = clearance.copy()
        changed[near] = np.minimum(clearance[near], ndimage.distance_transform_edt(~blocked[near]) * self.step)
        return changed

    def _crossed(self, lines: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Rows and columns of the cells that lines run through."""
        count = np.ceil(np.hypot(*(lines[:, 1] - lines[:, 0]).T) / (self.step / 2)).astype(int) + 1
        which = np.repeat(np.arange(len(lines)), count)
        along = (np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count, count)
        points = lines[which, 0] * (1 - along[:, None]) + lines[which, 1] * along[:, None]
        return self._cells(np.vstack([points, lines[:, 1]]))

    @property
    def clearance(self) -> Array:
        """(rows, columns) mm: from each cell to the nearest that is not free, right to about one step."""
        if self._clearance is None:
            self._clearance = ndimage.distance_transform_edt(self.free) * self.step
        return self._clearance

    def clearance_at(self, points: Array) -> Array:
        """Clearance at points (..., 2) mm, 0 off the grid."""
        row, column = self._cells(points)
        return self.clearance[row, column]

    def clearance_round(self, cells: tuple[NDArray[np.int64], NDArray[np.int64]], shapes: Array, *, least: float) -> Array:
        """Least clearance over the points of shapes that are put on many cells.

        Parameters
        ----------
        cells : rows (n,) int and columns (n,) int
            On whose centres the shapes' origin comes to lie.
        shapes : (a, k, 2) float, mm
        least : float, mm
            What has less is given up early: the answer is then no more than `least`, and no less than right.

        Returns
        -------
        (a, n) mm
        """
        # From the centre of a cell, a point falls into the same cell relative to it wherever it starts.
        offset = np.floor(shapes / self.step + 0.5).astype(np.int64)
        rim = int(np.abs(offset).max())
        padded = np.pad(self.clearance, rim)
        width, flat = padded.shape[1], padded.ravel()
        start = (cells[0] + rim) * width + cells[1] + rim
        jumps = offset[..., 1] * width + offset[..., 0]
        # A few points all round settle most cells; the rest is asked for only where these leave it open.
        few = np.arange(jumps.shape[1]) % max(jumps.shape[1] // _FEW, 1) == 0
        found = np.empty((len(jumps), len(start)))
        for jump, least_round in zip(jumps, found, strict=True):
            least_round[:] = flat[start[:, None] + jump[few]].min(axis=1)
            open_ = np.flatnonzero(least_round > least)
            if not few.all():
                least_round[open_] = np.minimum(least_round[open_], flat[start[open_, None] + jump[~few]].min(axis=1))
        return found

    def regions(self) -> tuple[int, NDArray[np.int32]]:
        """Number of connected parts of free space and each cell's part, 1, 2, ...; 0 where not free."""
        label, count = ndimage.label(self.free)
        return int(count), label

    def centres(self, cells: NDArray[np.bool_]) -> Array:
        """Centres of the cells that are set, (n, 2) mm."""
        row, column = np.nonzero(cells)
        return self.centres_of((row, column))

    def centres_of(self, cells: tuple[NDArray[np.int64], NDArray[np.int64]]) -> Array:
        """Centres of cells given by rows (n,) and columns (n,), (n, 2) mm."""
        return self._origin + self.step * (np.column_stack([cells[1], cells[0]]) + 0.5)

    def _cells(self, points: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        at = np.floor((points - self._origin) / self.step).astype(np.int64)
        # Everything beyond the grid is sent to its rim, which is never free.
        rows, columns = self.free.shape
        return np.clip(at[..., 1], 0, rows - 1), np.clip(at[..., 0], 0, columns - 1)


def _inside(edges: Array, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Cells whose centre is inside by the even-odd rule; `edges` in cells. Both sides of a closed dart cancel out."""
    low, high = edges[..., 1].min(axis=1), edges[..., 1].max(axis=1)
    # Rows whose centre line y = row + 1/2 the edge crosses, the lower end counted and the upper not.
    first = np.clip(np.ceil(low - 0.5), 0, shape[0]).astype(int)
    count = np.maximum(np.clip(np.ceil(high - 0.5), 0, shape[0]).astype(int) - first, 0)
    which = np.repeat(np.arange(len(edges)), count)
    row = first[which] + np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    (x0, y0), (x1, y1) = edges[which, 0].T, edges[which, 1].T
    x = x0 + (row + 0.5 - y0) / (y1 - y0) * (x1 - x0)
    crossings = np.zeros((shape[0], shape[1] + 1), dtype=np.int32)
    np.add.at(crossings, (row, np.clip(np.ceil(x - 0.5), 0, shape[1]).astype(int)), 1)
    return (np.cumsum(crossings, axis=1)[:, :-1] % 2).astype(bool)
