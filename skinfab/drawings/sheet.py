"""Where each flat piece lies on the one sheet that the drawings show."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.pieces import Piece


def sheet_offsets(pieces: Sequence[Piece], *, spacing: float = 10.0) -> NDArray[np.float64]:
    """Place the pieces side by side: shelves of bounding boxes, tallest first, as nearly square as shelves go.

    Pieces are not turned: the piece frame stays the frame of its mould and its G-code.

    Parameters
    ----------
    pieces : sequence of Piece
    spacing : float, mm
        Least distance of two bounding boxes.

    Returns
    -------
    (k, 2) float64, mm
        What to add to each piece's coordinates, in the order given; the sheet's lower left corner is (0, 0).

    Examples
    --------
    >>> F, UV = np.array([[0, 1, 2]]), np.array([[0.0, 0], [30, 0], [0, 20]])
    >>> one = Piece("P1", np.arange(1), np.arange(3), F, UV)
    >>> sheet_offsets([one, one, one]).tolist()
    [[0.0, 0.0], [40.0, 0.0], [0.0, 30.0]]
    """
    low = np.array([piece.UV.min(axis=0) for piece in pieces]).reshape(-1, 2)
    size = np.array([piece.size for piece in pieces]).reshape(-1, 2)
    order = np.lexsort((np.arange(len(size)), -size[:, 0], -size[:, 1]))
    # Between the widest piece and one shelf for all, some width gives the smallest square round the sheet.
    cumulated = np.cumsum(size[order, 0] + spacing) - spacing
    best = min(((_shelves(size, order, width, spacing)) for width in cumulated), key=lambda c: c[0], default=(0.0, low))
    return best[1] - low


def _shelves(size: NDArray[np.float64], order: NDArray[np.int64], width: float, spacing: float) -> tuple[float, NDArray[np.float64]]:
    """Longer side of the sheet and lower left corners, with shelves at most `width` wide (one piece at least)."""
    corners = np.zeros_like(size)
    x = y = right = shelf = 0.0
    for k in order.tolist():
        w, h = size[k]
        if x > 0 and x + w > width:
            x, y = 0.0, y + shelf + spacing
            shelf = 0.0
        corners[k] = x, y
        shelf, right = max(shelf, h), max(right, x + w)
        x += w + spacing
    return max(right, y + shelf), corners
