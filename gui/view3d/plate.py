"""A picture on a canvas that is replaced again and again: only what differs goes the long way to the screen."""

from __future__ import annotations

import tkinter as tk

import numpy as np
from numpy.typing import NDArray

from gui.pixels import put
from gui.view3d.patch import differing


class Plate:
    """Shows pictures of any size, one after the other.

    Parameters
    ----------
    master : tkinter widget
    times : int
        Each pixel is shown as so many either way.
    """

    def __init__(self, master: tk.Misc, *, times: int = 1) -> None:
        self._master, self._times = master, times
        self._shown = np.zeros((0, 0, 4), dtype=np.uint8)
        self._small: tk.PhotoImage | None = None
        self._large: tk.PhotoImage | None = None

    def show(self, pixels: NDArray[np.uint8]) -> tk.PhotoImage:
        """The picture for the canvas, with pixels (height, width, 4) uint8."""
        height, width = pixels.shape[:2]
        if self._small is None or self._large is None or self._shown.shape != pixels.shape:
            self._small = self._large = tk.PhotoImage(width=width, height=height, master=self._master)
            if self._times > 1:
                self._large = tk.PhotoImage(width=self._times * width, height=self._times * height, master=self._master)
        (top, left), (bottom, right) = differing(self._shown, pixels)
        put(self._small, pixels, rows=(top, bottom), columns=(left, right))
        if self._times > 1 and bottom > top:
            places = "-from", left, top, right, bottom, "-to", self._times * left, self._times * top
            self._master.tk.call(self._large, "copy", str(self._small), *places, "-zoom", self._times, "-compositingrule", "set")
        self._shown = pixels.copy()
        return self._large
