"""Where the names and sizes of pieces are written: each at its own piece, all of it seen, and clear of the others and of sensors."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from gui.view2d.background import BAR_PX, NAME_PX, RULER_PX, Ground, faces_under
from gui.view2d.labels import Taken
from gui.view2d.pen import Box, Pen
from skinfab.pieces import Piece

Float = NDArray[np.float64]

#: Between a piece and its heading, and at least between two headings on one line, pixels: nearer they are read as one.
_OFF_PX, _APART_PX = 4.0, 8.0
#: A place that is worse than another by its kind alone: its words cut short, or below the piece, where they seem to be of the next.
_SHORT, _BELOW = 0.03, 0.06
#: What it costs to stand where the name of another piece belongs.
_ANOTHERS = 0.5


def paint_names(ground: Ground, pen: Pen, face: NDArray[np.int32], taken: Taken) -> list[Box]:
    """The pieces' names and sizes, over their upper left corners or, where those would hide something, elsewhere; where they are.

    Parameters
    ----------
    ground : Ground
    pen : Pen
    face : (rows, columns) int32
        The triangle each pixel shows, rows counted down; -1 for none.
    taken : Taken
        Where sensors lie.

    Returns
    -------
    list of (left, low, right, high)
    """
    boxes: list[Box] = []
    pieces = ground.sheet.pieces
    lows, highs = (
        [ground.plane.to_px(end(piece.UV, axis=0) + offset) for piece, offset in zip(pieces, ground.sheet.offset, strict=True)]
        for end in (np.min, np.max)
    )
    above = np.array([0.0, _OFF_PX * pen.ratio])
    homes = [
        _box(np.array([low[0], high[1]]) + above, (0.0, 0.0), _room(pen, piece.id))
        for piece, low, high in zip(pieces, lows, highs, strict=True)
    ]
    for k, piece in enumerate(pieces):
        least, best = np.inf, (piece.id, lows[k], (0.0, 0.0))
        for words, at, anchor, worse in _places(piece, lows[k], highs[k], pen.ratio):
            box = _box(at, anchor, _room(pen, words))
            cost = worse + faces_under(box, face) + taken.share(box) + 2.0 * _hidden(box, ground, pen)
            cost += sum(_meet(box, other, _APART_PX * pen.ratio) for other in boxes)
            cost += _ANOTHERS * sum(_meet(box, home, _APART_PX * pen.ratio) for home in homes[k + 1 :])
            if cost < least:
                least, best = cost, (words, at, anchor)
        words, at, anchor = best
        boxes.append(pen.text(at, words, ground.theme.text, size=NAME_PX, anchor=anchor, ground=ground.theme.view, bold=True))
    return boxes


def _places(piece: Piece, low: Float, high: Float, ratio: float) -> Iterator[tuple[str, Float, tuple[float, float], float]]:
    """Words, the place of their anchor and the anchor, and how much worse than the first that is."""
    width, height = piece.size
    for words, short in ((f"{piece.id}  {width:.0f} x {height:.0f} mm", 0.0), (piece.id, _SHORT)):
        for y, below in ((0.0, 0.0), (1.0, _BELOW)):
            level = high[1] + _OFF_PX * ratio if y == 0 else low[1] - _OFF_PX * ratio
            for k, x in enumerate((0.0, 1.0, 0.5)):
                yield words, np.array([(1 - x) * low[0] + x * high[0], level]), (x, y), short + below + 0.001 * k


def _room(pen: Pen, words: str) -> Float:
    return np.array(pen.room(words, NAME_PX, bold=True))


def _box(at: Float, anchor: tuple[float, float], room: Float) -> Box:
    left, low = at - room * anchor
    return float(left), float(low), float(left + room[0]), float(low + room[1])


def _hidden(box: Box, ground: Ground, pen: Pen) -> float:
    """How much of a box is under the rulers, the colour bar or beyond the picture, from 0 to 1."""
    ruler, bar = RULER_PX * pen.ratio, BAR_PX * pen.ratio if ground.shading == "distortion" else 0.0
    across = min(box[2], pen.width - bar) - max(box[0], ruler)
    along = min(box[3], float(pen.height)) - max(box[1], ruler)
    return 1.0 - max(across, 0.0) * max(along, 0.0) / ((box[2] - box[0]) * (box[3] - box[1]))


def _meet(one: Box, other: Box, apart: float) -> bool:
    """Do two overlap, or stand beside each other with less than `apart` between them?"""
    return one[0] < other[2] + apart and other[0] < one[2] + apart and one[1] < other[3] and other[1] < one[3]
