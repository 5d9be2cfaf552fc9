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
#: Columns that a letter may reach to the left of where it begins.
_SPARE = 4


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
        self._glyphs: dict[tuple[str, int, bool], tuple[Mask, float]] = {}
        self._fonts: dict[tuple[int, bool], ImageFont.FreeTypeFont] = {}

    def mask(self, words: str, size: int, *, bold: bool = False) -> Mask:
        """How much each pixel is covered, (rows, columns) from 0 to 255; all words of a size have as many rows."""
        key = (words, size, bold)
        if key not in self._masks:
            while len(self._masks) >= _KEPT:
                del self._masks[next(iter(self._masks))]
            self._masks[key] = self._joined(words, size, bold)
        return self._masks[key]

    def _joined(self, words: str, size: int, bold: bool) -> Mask:
        """Letter by letter: numbers change with every move of the pointer, and a letter is drawn only once."""
        letters = [self._letter(letter, size, bold) for letter in words] or [self._letter(" ", size, bold)]
        starts = np.cumsum([0.0, *(advance for _, advance in letters)])
        rows = letters[0][0].shape[0]
        mask = np.zeros((rows, int(np.ceil(starts[-1])) + 2 * _SPARE), dtype=np.uint8)
        for (glyph, _), start in zip(letters, starts, strict=False):
            part = mask[:, (at := round(start)) : at + glyph.shape[1]]
            np.maximum(part, glyph[:, : part.shape[1]], out=part)
        return mask[:, _SPARE : mask.shape[1] - _SPARE + 1]

    def _letter(self, letter: str, size: int, bold: bool) -> tuple[Mask, float]:
        """A letter `_SPARE` columns to the right, and how far the next one is from it."""
        key = (letter, size, bold)
        if key not in self._glyphs:
            font = self._font(size, bold)
            ascent, descent = font.getmetrics()
            image, (left, top) = font.getmask2(letter, mode="L", anchor="ls")
            columns, rows = image.size
            mask = np.zeros((ascent + descent, columns + left + _SPARE if columns else _SPARE), dtype=np.uint8)
            if columns and rows:
                i, j = max(ascent + top, 0), left + _SPARE
                glyph = np.array(image, dtype=np.uint8).reshape(rows, columns)[: mask.shape[0] - i]
                mask[i : i + len(glyph), j : j + columns] = glyph
            self._glyphs[key] = mask, font.getlength(letter)
        return self._glyphs[key]

    def _font(self, size: int, bold: bool) -> ImageFont.FreeTypeFont:
        if (size, bold) not in self._fonts:
            self._fonts[size, bold] = ImageFont.truetype(self._files[bold], size)
        return self._fonts[size, bold]

    @cached_property
    def _files(self) -> tuple[str, str]:
        """Plain and bold; they come with matplotlib, so they are there and the same everywhere."""
        plain, bold = (findfont(FontProperties(family="DejaVu Sans", weight=weight)) for weight in ("normal", "bold"))
        return plain, bold
