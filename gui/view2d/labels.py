"""Where the labels of seams are written: beside their seams, and clear of sensors, names and one another as far as there is room."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from gui.view2d.background import LABEL_PX, LEAST_SEAM_PX, NOTCH_PX, RULER_PX, Ground, faces_under
from gui.view2d.pen import Box, Pen

Float = NDArray[np.float64]

#: Side of the squares in which it is kept what is written or drawn already, pixels of an ordinary screen.
_CELL_PX = 3.0
#: Beside its notch a label may stand so far along its seam, pixels, the nearest first.
_ALONG_PX = (0.0, 14.0, -14.0, 28.0, -28.0, 42.0, -42.0, 60.0, -60.0)
#: So much of a label may reach over its seam, or lie on a corner of something.
_FREE = 0.12
#: One that would hide more of what lies there is left out: the seam's other side, the object and the status bar tell it too.
_HIDES = 0.3
#: Names beside small sensors, pixels: their letters, and how far from the sensor they stand.
_SMALL_PX, _BESIDE_PX = 10.0, 3.0


class Taken:
    """The part of the picture that labels keep off.

    Parameters
    ----------
    width, height : int
        Pixels.
    ratio : float
        Pixels of this screen for one of an ordinary one.

    Examples
    --------
    >>> taken = Taken(100, 60)
    >>> taken.lines([np.array([[0.0, 30.0], [99.0, 30.0]])])
    >>> taken.share((10, 20, 20, 40)) > 0, taken.share((10, 40, 20, 50))
    (True, 0.0)
    """

    def __init__(self, width: int, height: int, ratio: float = 1.0) -> None:
        self._cell = _CELL_PX * ratio
        self._grid = np.zeros((int(height / self._cell) + 1, int(width / self._cell) + 1), dtype=bool)

    def lines(self, parts: Iterable[Float]) -> None:
        """Take what lines (k, 2) run through."""
        for px in parts:
            steps = np.diff(px, axis=0)
            count = np.maximum(np.ceil(np.hypot(*steps.T) / self._cell), 1).astype(int)
            which = np.repeat(np.arange(len(steps)), count)
            along = (np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count, count)
            points = np.concatenate([px[which] + along[:, None] * steps[which], px[-1:]])
            column, row = np.floor(points / self._cell).astype(int).T
            inside = (column >= 0) & (row >= 0) & (column < self._grid.shape[1]) & (row < self._grid.shape[0])
            self._grid[row[inside], column[inside]] = True

    def box(self, box: Box) -> None:
        """Take a rectangle."""
        rows, columns = self._cells(box)
        self._grid[rows, columns] = True

    def share(self, box: Box) -> float:
        """How much of a rectangle is taken, from 0 to 1."""
        part = self._grid[self._cells(box)]
        return float(part.mean()) if part.size else 1.0

    def _cells(self, box: Box) -> tuple[slice, slice]:
        left, low, right, high = (max(int(np.floor(v / self._cell)), 0) for v in box)
        return slice(low, high + 1), slice(left, right + 1)


def paint_labels(ground: Ground, pen: Pen, face: NDArray[np.int32], taken: Taken) -> list[Box]:
    """A label at every seam side that is long enough on the screen and has room, inside its piece or, where that is taken, beside it.

    Parameters
    ----------
    ground : Ground
    pen : Pen
    face : (rows, columns) int32
        The triangle each pixel shows, rows counted down; -1 for none.
    taken : Taken
        Grows by the labels.

    Returns
    -------
    list of (left, low, right, high)
        Where they are.
    """
    boxes = []
    for side in ground.sheet.sides:
        px = ground.plane.to_px(side.points + ground.sheet.offset[side.piece])
        if not side.label or np.ptp(px, axis=0).max() < LEAST_SEAM_PX * pen.ratio:
            continue
        notch = ground.plane.to_px(side.notch + ground.sheet.offset[side.piece])
        at = _best(pen, face, taken, _places(px, notch, side.inward, pen.ratio), side.label)
        if at is not None:
            boxes.append(pen.text(at, side.label, ground.theme.seam, size=LABEL_PX, ground=ground.theme.view))
            taken.box(boxes[-1])
    return boxes


def paint_small_names(named: Iterable[tuple[str, str, Float]], ground: Ground, pen: Pen, taken: Taken) -> list[Box]:
    """Names of sensors that are too small to be written over, beside them where there is room; where they are.

    Parameters
    ----------
    named : iterable of (str, str, (k, 2) float)
        Name, colour, and the sensor's line in pixels.
    ground : Ground
    pen : Pen
    taken : Taken
        Grows by the names.
    """
    boxes = []
    for name, colour, px in named:
        (left, low), (right, high) = px.min(axis=0), px.max(axis=0)
        far, (wide, tall) = _BESIDE_PX * pen.ratio, pen.room(name, _SMALL_PX, bold=True)
        middle, level = (left + right) / 2, (low + high) / 2
        for x, y in (
            (right + far + wide / 2, level),
            (left - far - wide / 2, level),
            (middle, high + far + tall / 2),
            (middle, low - far - tall / 2),
        ):
            box = (x - wide / 2, y - tall / 2, x + wide / 2, y + tall / 2)
            if taken.share(box) <= _FREE:
                boxes.append(pen.text((x, y), name, colour, size=_SMALL_PX, ground=ground.theme.view, bold=True))
                taken.box(boxes[-1])
                break
    return boxes


def _places(px: Float, notch: Float, inward: Float, ratio: float) -> list[tuple[Float, bool]]:
    """Middles of the label, the most usual first, and whether each lies in the piece: at the notch, opposite, then along the seam."""
    steps = np.hypot(*np.diff(px, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    nearest = int(np.argmin(np.hypot(*(px - notch).T)))
    far = (NOTCH_PX + LABEL_PX) * ratio
    found: list[tuple[Float, bool]] = []
    for shift in _ALONG_PX:
        way = along[nearest] + shift * ratio
        if shift and not 0.0 <= way <= along[-1]:
            continue
        k = int(np.clip(np.searchsorted(along, way, side="right") - 1, 0, len(steps) - 1))
        across = np.array([-(px[k + 1] - px[k])[1], (px[k + 1] - px[k])[0]]) / max(steps[k], np.finfo(float).tiny)
        point = np.array([np.interp(way, along, px[:, 0]), np.interp(way, along, px[:, 1])])
        middle, direction = (point, across) if shift else (notch, inward)
        found += [(middle + direction * far, True), (middle - direction * far, False)]
    return found


def _best(pen: Pen, face: NDArray[np.int32], taken: Taken, places: list[tuple[Float, bool]], label: str) -> Float | None:
    """The first place that is free, or the least taken one; None where a label would hide what is there."""
    width, height = pen.room(label, LABEL_PX)
    least, best = np.inf, None
    for middle, inside in places:
        box = (middle[0] - width / 2, middle[1] - height / 2, middle[0] + width / 2, middle[1] + height / 2)
        if box[0] < RULER_PX * pen.ratio or box[1] < RULER_PX * pen.ratio or box[2] > pen.width or box[3] > pen.height:
            continue
        # A label beside its piece must not look like one of another piece, nor one of this piece stand beside it.
        on_faces, hides = faces_under(box, face), taken.share(box)
        if hides > _HIDES:
            continue
        cost = hides + (1.0 - on_faces if inside else 2.0 * on_faces)
        if cost <= _FREE:
            return middle
        if cost < least:
            least, best = cost, middle
    return best
