"""Strips of curves as a picture, all channels at once, so that 32 of them cost no more than the pixels they cover."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from gui.live.spans import Spans
from gui.theme import rgb

FloatArray = NDArray[np.float64]

#: Shades from the ground to a curve's own colour: edges look smooth.
_SHADES = 16


@dataclass(frozen=True)
class Ink:
    """Colours of one strip, "#rrggbb"."""

    ground: str
    curve: str


def strips(
    spans: Spans,
    low: FloatArray,
    high: FloatArray,
    inks: list[Ink],
    *,
    height: int,
    grid: list[int],
    grid_colour: str,
    width_px: float,
) -> NDArray[np.uint32]:
    """One strip a channel, one below the other.

    Parameters
    ----------
    spans : Spans
        Of c channels in w columns.
    low, high : (c,) float
        The values at the bottom and the top of each strip.
    inks : list of Ink
        Of each channel.
    height : int, pixels
        Of one strip; its last row is a line of the grid's colour.
    grid : list of int
        Columns with a line of the grid behind the curves.
    grid_colour : str
    width_px : float
        Of a curve.

    Returns
    -------
    (c * height, w) uint32
        Red, green, blue and 255 in the order of the bytes.
    """
    top, bottom = _edges(spans, low, high, height, width_px)
    line = _packed(np.array([rgb(grid_colour)]))[0]
    palette = np.stack([_palette(ink) for ink in inks])
    picture = np.empty((len(inks), height, len(top)), dtype=np.uint32)
    picture[:] = palette[:, 0, None, None]
    picture[:, :, grid] = line
    picture[:, -1] = line
    _fill(top, bottom, palette, picture)
    return picture.reshape(len(inks) * height, len(top))


def warm() -> None:
    """Load what is compiled, beside the window rather than with its first picture."""
    none = np.zeros((1, 1))
    strips(Spans(none, none), none[0], none[0] + 1, [Ink("#000000", "#000000")], height=9, grid=[], grid_colour="#000000", width_px=1.0)


def _edges(spans: Spans, low: FloatArray, high: FloatArray, height: int, width_px: float) -> tuple[FloatArray, FloatArray]:
    """From where to where each column of each strip is covered, (w, c) pixels down; to above from where where it is not."""
    room, half = height - 1 - 2 * width_px, width_px / 2
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.where(high > low, room / (high - low), np.nan)
        # From the upper edge down; what lies beyond its strip stays at the strip's edge.
        top = np.clip(width_px + (high - spans.high) * scale, half, height - half) - half
        bottom = np.clip(width_px + (high - spans.low) * scale, half, height - half) + half
    nothing = ~np.isfinite(top) | ~np.isfinite(bottom)
    top[nothing], bottom[nothing] = 1.0, 0.0
    return top, bottom


@numba.njit(cache=True, nogil=True)
def _fill(top: FloatArray, bottom: FloatArray, palette: NDArray[np.uint32], picture: NDArray[np.uint32]) -> None:
    """Only the pixels that a curve covers are touched: of a 4K screen they are few."""
    strips, height, width = picture.shape
    for k in range(strips):
        for column in range(width):
            upper, lower = top[column, k], bottom[column, k]
            for row in range(int(upper), min(int(np.ceil(lower)), height)):
                shade = int((min(row + 1.0, lower) - max(float(row), upper)) * (_SHADES - 1) + 0.5)
                if shade > 0:
                    picture[k, row, column] = palette[k, shade]


def _palette(ink: Ink) -> NDArray[np.uint32]:
    ground, curve = np.array(rgb(ink.ground), dtype=float), np.array(rgb(ink.curve), dtype=float)
    parts = np.linspace(0, 1, _SHADES)[:, None]
    return _packed(np.rint(ground + (curve - ground) * parts))


def _packed(colours: NDArray[np.generic]) -> NDArray[np.uint32]:
    """(k, 3) from 0 to 255 as (k,) with their bytes in order."""
    out = np.full((len(colours), 4), 255, dtype=np.uint8)
    out[:, :3] = colours
    return out.view(np.uint32)[:, 0]
