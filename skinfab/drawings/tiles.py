"""How a drawing at true size is spread over sheets of A4 that overlap."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: A4 upright, mm.
A4_MM = (210.0, 297.0)

#: White border that no printer needs to reach, and the strip at the foot of a sheet for its title and scale bar, mm.
BORDER_MM = 10.0
FOOT_MM = 16.0

#: By how much neighbouring sheets show the same, mm: enough to glue them.
OVERLAP_MM = 10.0


@dataclass(frozen=True, eq=False)
class Tiling:
    """Sheets of one size, row by row from the lower left.

    Parameters
    ----------
    sheet : (width, height), mm
    window : (width, height), mm
        What a sheet shows; its lower left corner is at (BORDER_MM, BORDER_MM + FOOT_MM) of the sheet.
    corners : (rows, columns, 2) float, mm
        The drawing's point at the lower left corner of each window.
    """

    sheet: tuple[float, float]
    window: tuple[float, float]
    corners: NDArray[np.float64]

    @property
    def joins(self) -> NDArray[np.float64]:
        """(k, 2) mm: middles of the corners of all overlaps. Each is on two sheets or more, which are glued so that it agrees."""
        rows, columns = self.corners.shape[:2]
        half = OVERLAP_MM / 2
        xs, ys = self.corners[0, :, 0] + half, self.corners[:, 0, 1] + half
        right, top = self.corners[-1, -1] + self.window - half
        if rows == columns == 1:
            return np.zeros((0, 2))
        grid = [(x, y) for x in (*xs, right) for y in (*ys, top)]
        inner_x, inner_y = set(xs[1:].tolist()), set(ys[1:].tolist())
        return np.array([(x, y) for x, y in grid if x in inner_x or y in inner_y])


def tile(low: NDArray[np.float64], high: NDArray[np.float64]) -> Tiling:
    """Cover a box with as few sheets as do, upright unless lying needs fewer; the box is in the middle of what they cover.

    Parameters
    ----------
    low, high : (2,) float, mm

    Examples
    --------
    >>> tile(np.zeros(2), np.array([100.0, 100.0])).corners.tolist()
    [[[-45.0, -80.5]]]
    >>> tile(np.zeros(2), np.array([250.0, 100.0])).sheet, tile(np.zeros(2), np.array([300.0, 300.0])).corners.shape
    ((297.0, 210.0), (2, 2, 2))
    """
    upright, lying = (_cover(low, high, sheet) for sheet in (A4_MM, A4_MM[::-1]))
    return lying if lying.corners.size < upright.corners.size else upright


def _cover(low: NDArray[np.float64], high: NDArray[np.float64], sheet: tuple[float, ...]) -> Tiling:
    window = (sheet[0] - 2 * BORDER_MM, sheet[1] - 2 * BORDER_MM - FOOT_MM)
    axes = []
    for a, b, wide in zip(low.tolist(), high.tolist(), window, strict=True):
        count = max(1, math.ceil((b - a - OVERLAP_MM) / (wide - OVERLAP_MM)))
        covered = count * (wide - OVERLAP_MM) + OVERLAP_MM
        axes.append((a + b - covered) / 2 + np.arange(count) * (wide - OVERLAP_MM))
    x, y = np.meshgrid(*axes)
    return Tiling((sheet[0], sheet[1]), window, np.stack([x, y], axis=-1))
