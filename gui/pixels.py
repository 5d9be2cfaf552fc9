"""Pixels into a picture of Tk's, quickly: a part of it, and without looking for what is transparent."""

from __future__ import annotations

import tkinter as tk

import numpy as np
from matplotlib.backends import _backend_tk
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

#: Where Tk finds red, green, blue and how opaque a pixel is: beyond its four bytes, which means that it is. Tk looks at every pixel of
#: the whole picture for some that are not, each time that a part of it changes (0.25 ms at 900 x 700, and twice for each pixel changed).
_OPAQUE = (0, 1, 2, 4)


def put(
    photo: tk.PhotoImage, pixels: NDArray[np.uint8], *, rows: tuple[int, int] | None = None, columns: tuple[int, int] | None = None
) -> None:
    """Show pixels (height, width, 4) uint8, or some of their rows and columns, in a picture of their size.

    With Pillow's `ImageTk` a picture of 900 x 700 takes twice as long and cannot be put in parts.

    Parameters
    ----------
    photo : PhotoImage
    pixels : (height, width, 4) uint8
        The fourth is passed over.
    rows, columns : (int, int), optional
        The first, and the one behind the last; none of them may lie outside.
    """
    height, width = pixels.shape[:2]
    (top, bottom), (left, right) = rows or (0, height), columns or (0, width)
    if bottom > top and right > left:
        _backend_tk.blit(photo, pixels, _OPAQUE, bbox=Bbox([[left, height - bottom], [right, height - top]]))
