"""Words as little pictures, drawn once: labels are the same from one picture to the next."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from matplotlib.font_manager import FontProperties, findfont
from numpy.typing import NDArray
from PIL import ImageFont

Mask = NDArray[np.uint8]

#: Words that are kept; beyond, the oldest go.
_KEPT = 2000


class Letters:
    """Masks of words, by size and weight.

    Examples
    --------
    >>> mask = Letters().mask("P1", 12, bold=True)
    >>> str(mask.dtype), mask.shape[0] >= 12, int(mask.max()) > 200
    ('uint8', True, True)
    """

    def __init__(self) -> None:
        self._masks: dict[tuple[str, int, bool], Mask] = {}
        self._fonts: dict[tuple[int, bool], ImageFont.FreeTypeFont] = {}

    def mask(self, words: str, size: int, *, bold: bool = False) -> Mask:
        """How much each pixel is covered, (rows, columns) from 0 to 255; all words of a size have as many rows."""
        key = (words, size, bold)
        if key not in self._masks:
            while len(self._masks) >= _KEPT:
                del self._masks[next(iter(self._masks))]
            self._masks[key] = self._drawn(words, size, bold)
        return self._masks[key]

    def _drawn(self, words: str, size: int, bold: bool) -> Mask:
        font = self._font(size, bold)
        ascent, descent = font.getmetrics()
        image, (left, top) = font.getmask2(words, mode="L", anchor="ls")
        columns, rows = image.size
        mask = np.zeros((ascent + descent, max(columns + max(left, 0), 1)), dtype=np.uint8)
        at = ascent + top
        if columns and rows:
            glyphs = np.array(image, dtype=np.uint8).reshape(rows, columns)
            mask[max(at, 0) : at + rows, max(left, 0) :] = glyphs[max(-at, 0) :]
        return mask

    def _font(self, size: int, bold: bool) -> ImageFont.FreeTypeFont:
        if (size, bold) not in self._fonts:
            self._fonts[size, bold] = ImageFont.truetype(self._files[bold], size)
        return self._fonts[size, bold]

    @cached_property
    def _files(self) -> tuple[str, str]:
        """Plain and bold; they come with matplotlib, so they are there and the same everywhere."""
        plain, bold = (findfont(FontProperties(family="DejaVu Sans", weight=weight)) for weight in ("normal", "bold"))
        return plain, bold
