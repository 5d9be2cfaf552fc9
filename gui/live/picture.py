"""Strips of curves as a picture, all channels at once: numpy alone, so that 32 of them cost no more than their pixels."""

from __future__ import annotations

from dataclasses import dataclass

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
    shade = _cover(spans, low, high, height, width_px)
    c, _, w = shade.shape
    palette = np.stack([_palette(ink) for ink in inks])
    picture = np.take(palette.ravel(), shade + (np.arange(c) * _SHADES)[:, None, None], mode="clip")
    line = _packed(np.array([rgb(grid_colour)]))[0]
    for column in grid:
        free = shade[:, :, column] == 0
        picture[:, :, column][free] = line
    picture[:, -1] = np.where(shade[:, -1] == 0, line, picture[:, -1])
    return picture.reshape(c * height, w)


def _cover(spans: Spans, low: FloatArray, high: FloatArray, height: int, width_px: float) -> NDArray[np.intp]:
    """How much of each pixel the curves cover, (c, height, w) from 0 to `_SHADES` - 1."""
    room, half = height - 1 - 2 * width_px, width_px / 2
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.where(high > low, room / (high - low), np.nan)
        # From the upper edge down; what lies beyond its strip stays at the strip's edge.
        top = np.clip(width_px + (high - spans.high) * scale, 0, height - 1) - half
        bottom = np.clip(width_px + (high - spans.low) * scale, 0, height - 1) + half
    nothing = ~np.isfinite(top) | ~np.isfinite(bottom)
    top[nothing], bottom[nothing] = np.inf, -np.inf
    rows = np.arange(height, dtype=np.float32)[None, :, None]
    upper, lower = top.T.astype(np.float32)[:, None, :], bottom.T.astype(np.float32)[:, None, :]
    part = np.minimum(rows + 1, lower)
    part -= np.maximum(rows, upper)
    np.clip(part, 0, 1, out=part)
    part *= _SHADES - 1
    part += 0.5
    return part.astype(np.intp)


def _palette(ink: Ink) -> NDArray[np.uint32]:
    ground, curve = np.array(rgb(ink.ground), dtype=float), np.array(rgb(ink.curve), dtype=float)
    parts = np.linspace(0, 1, _SHADES)[:, None]
    return _packed(np.rint(ground + (curve - ground) * parts))


def _packed(colours: NDArray[np.generic]) -> NDArray[np.uint32]:
    """(k, 3) from 0 to 255 as (k,) with their bytes in order."""
    out = np.full((len(colours), 4), 255, dtype=np.uint8)
    out[:, :3] = colours
    return out.view(np.uint32)[:, 0]
