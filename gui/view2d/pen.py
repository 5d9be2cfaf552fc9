"""Draws lines and words into matplotlib's picture buffer, without its figure, and knows what it has touched."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.backend_bases import GraphicsContextBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgba
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import ArrayLike, NDArray

from gui.theme import rgb
from gui.view2d.letters import Letters

Float = NDArray[np.float64]
Box = tuple[float, float, float, float]

_AS_IT_IS = IdentityTransform()
_CIRCLE = Path.unit_circle()
_ROUND = np.asarray(_CIRCLE.vertices, dtype=float)


class Pen:
    """Places are pixels, right and up from the lower left corner.

    Parameters
    ----------
    renderer : RendererAgg
    letters : Letters
    ratio : float
        Pixels of this screen for one of an ordinary one; widths and sizes are given for an ordinary one.

    Attributes
    ----------
    touched : list of (left, low, right, high)
        Boxes round everything drawn so far, none of which overlap.
    """

    def __init__(self, renderer: RendererAgg, letters: Letters, ratio: float = 1.0) -> None:
        self._renderer, self._letters, self.ratio = renderer, letters, ratio
        self._picture = np.asarray(renderer.buffer_rgba())
        self.width, self.height = int(renderer.width), int(renderer.height)
        self.touched: list[Box] = []

    def line(self, points: ArrayLike, colour: str, width: float, *, closed: bool = False, dashed: bool = False) -> None:
        """One line through points (k, 2)."""
        self._stroke([np.asarray(points, dtype=float)], colour, width, closed=closed, dashed=dashed)

    def lines(self, parts: Sequence[Float], colour: str, width: float, *, alpha: float = 1.0) -> None:
        """Many lines of the same looks in one go."""
        self._stroke([p for p in parts if len(p) > 1], colour, width, alpha=alpha)

    def disk(self, at: ArrayLike, radius: float, fill: str, edge: str, width: float = 1.5) -> None:
        """A filled circle."""
        r = radius * self.ratio
        gc = self._gc(edge, width)
        x, y = np.asarray(at, dtype=float)
        circle = Path(_ROUND * r + (x, y), _CIRCLE.codes)
        self._renderer.draw_path(gc, circle, _AS_IT_IS, to_rgba(fill))
        gc.restore()
        self._touch((x - r, y - r, x + r, y + r), width)

    def box(self, box: Box, fill: str, edge: str | None = None, *, alpha: float = 1.0) -> None:
        """A filled rectangle."""
        left, low, right, high = box
        gc = self._gc(edge or fill, 1.0 if edge else 0.0)
        corners = Path(np.array([[left, low], [right, low], [right, high], [left, high], [left, low]]), closed=True)
        self._renderer.draw_path(gc, corners, _AS_IT_IS, (*to_rgba(fill)[:3], alpha))
        gc.restore()
        self._touch(box, 1.0)

    def text(
        self,
        at: ArrayLike,
        words: str,
        colour: str,
        *,
        size: float = 9.0,
        anchor: tuple[float, float] = (0.5, 0.5),
        ground: str | None = None,
        edge: str | None = None,
        bold: bool = False,
        inside: bool = False,
    ) -> Box:
        """Words of `size` pixels, on a box of the colour `ground` if there is one.

        `anchor` says which point of them lies `at` (0, 0: lower left); `inside` moves them back into the picture. Gives their box.
        """
        mask = self._letters.mask(words, max(round(size * self.ratio), 1), bold=bold)
        height, width = mask.shape
        pad = 2.0 * self.ratio if ground else 0.0
        x, y = np.asarray(at, dtype=float)
        # Whole pixels: letters are sharp only where they were drawn.
        left = round(x - anchor[0] * (width + 2 * pad) + pad)
        low = round(y - anchor[1] * (height + 2 * pad) + pad)
        if inside:
            left = min(max(left, int(pad)), self.width - width - int(pad))
            low = min(max(low, int(pad)), self.height - height - int(pad))
        box = (left - 1.5 * pad, low - pad, left + width + 1.5 * pad, low + height + pad)
        if ground:
            self.box(box, ground, edge, alpha=0.9)
        self._print(mask, left, self.height - low - height, colour)
        self._touch(box, 1.0)
        return box

    def room(self, words: str, size: float, *, bold: bool = False) -> tuple[float, float]:
        """Width and height of the box that `text` draws with a ground, pixels."""
        height, width = self._letters.mask(words, max(round(size * self.ratio), 1), bold=bold).shape
        return width + 6.0 * self.ratio, height + 4.0 * self.ratio

    def _print(self, mask: NDArray[np.uint8], left: int, top: int, colour: str) -> None:
        """Lay a mask over the picture, its corner at a column and a row; what is beyond the picture's ends is cut off."""
        rows, columns = mask.shape
        i0, i1 = max(top, 0), min(top + rows, self.height)
        j0, j1 = max(left, 0), min(left + columns, self.width)
        if i0 >= i1 or j0 >= j1:
            return
        part = self._picture[i0:i1, j0:j1, :3]
        cover = mask[i0 - top : i1 - top, j0 - left : j1 - left, None] * np.float32(1 / 255)
        part[:] = part + (np.array(rgb(colour), dtype=np.float32) - part) * cover

    def _stroke(
        self, parts: list[Float], colour: str, width: float, *, closed: bool = False, alpha: float = 1.0, dashed: bool = False
    ) -> None:
        if not parts:
            return
        if closed:
            parts = [np.vstack([p, p[:1]]) for p in parts]
        vertices = np.vstack(parts)
        codes = np.full(len(vertices), Path.LINETO, dtype=Path.code_type)
        codes[np.cumsum([0, *(len(p) for p in parts[:-1])])] = Path.MOVETO
        path = Path(vertices, codes)
        path.should_simplify = len(vertices) > 128
        gc = self._gc(colour, width, alpha)
        gc.set_capstyle("round")
        gc.set_joinstyle("round")
        if dashed:
            gc.set_dashes(0, [4.0, 3.0])
        self._renderer.draw_path(gc, path, _AS_IT_IS, None)
        gc.restore()
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        self._touch((low[0], low[1], high[0], high[1]), width)

    def _gc(self, colour: str, width: float, alpha: float = 1.0) -> GraphicsContextBase:
        gc = self._renderer.new_gc()
        gc.set_foreground((*to_rgba(colour)[:3], alpha), isRGBA=True)
        gc.set_linewidth(width * self.ratio * 72 / self._renderer.dpi)
        return gc

    def _touch(self, box: Box, width: float) -> None:
        spare = width * self.ratio / 2 + 2
        self.touched = apart([*self.touched, (box[0] - spare, box[1] - spare, box[2] + spare, box[3] + spare)])


def apart(boxes: Iterable[Box]) -> list[Box]:
    """Boxes round the same places, those that overlap joined.

    Examples
    --------
    >>> apart([(0, 0, 2, 2), (5, 5, 6, 6), (1, 1, 3, 3)])
    [(5, 5, 6, 6), (0, 0, 3, 3)]
    """
    result: list[Box] = []
    for box in boxes:
        while True:
            over = next((b for b in result if b[0] <= box[2] and box[0] <= b[2] and b[1] <= box[3] and box[1] <= b[3]), None)
            if over is None:
                break
            result.remove(over)
            box = (min(over[0], box[0]), min(over[1], box[1]), max(over[2], box[2]), max(over[3], box[3]))
        result.append(box)
    return result
