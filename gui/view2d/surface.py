"""The Tk canvas of the flat view: matplotlib's picture buffer with a still part kept aside and put back where something moved."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable

import numpy as np
from matplotlib.backends.backend_tkagg import FigureCanvasTkAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gui.pixels import put
from gui.view2d.letters import Letters
from gui.view2d.pen import Box, Pen, apart

#: Events that matplotlib listens to for figures, which there are none of here: they only take time.
_FOR_FIGURES = (
    *("<Motion>", "<Key>", "<KeyRelease>", "<Enter>", "<Leave>", "<Button-4>", "<Button-5>"),
    *(f"<{kind}-{k}>" for kind in ("Button", "Double-Button", "ButtonRelease") for k in (1, 2, 3)),
)


class Surface(FigureCanvasTkAgg):
    """Draws a still part now and then and a moving part often.

    Parameters
    ----------
    master : tkinter widget
    still, moving : callable
        Draw with the pen they are given.
    """

    def __init__(self, master: tk.Misc, *, still: Callable[[Pen], None], moving: Callable[[Pen], None]) -> None:
        focused = master.focus_get()
        super().__init__(Figure(dpi=96), master)
        if focused is not None:
            focused.focus_set()  # matplotlib takes it
        self.widget: tk.Canvas = self.get_tk_widget()
        self.widget.configure(takefocus=True)
        for event in _FOR_FIGURES:
            self.widget.unbind(event)
        self._still, self._moving = still, moving
        self._letters = Letters()
        self._kept: NDArray[np.uint8] | None = None
        self._touched: list[Box] = []
        self._unshown: list[Box] = []
        self._waiting: str | None = None
        self._drawing: str | None = None
        self._showing: str | None = None
        self.widget.bind("<Destroy>", self._stop, add=True)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        width, height = self.get_width_height(physical=True)
        return int(width), int(height)

    @property
    def ratio(self) -> float:
        """Pixels of this screen for one of an ordinary one."""
        return float(self.device_pixel_ratio)

    @property
    def picture(self) -> NDArray[np.uint8]:
        """(rows, columns, 4) uint8, the buffer itself."""
        return np.asarray(self.get_renderer().buffer_rgba())

    def draw(self) -> None:
        """Draw everything."""
        if min(self.size) < 2:
            return
        renderer = self.get_renderer()
        renderer.clear()
        self._still(Pen(renderer, self._letters, self.ratio))
        self._kept = self.picture.copy()
        self._touched, self._unshown = [], []
        self._over()
        put(self._tkphoto, self.picture)

    def draw_idle(self) -> None:
        """Draw everything, soon; many calls are one."""
        # Also called by matplotlib while it makes the canvas.
        if getattr(self, "_drawing", None) is None and hasattr(self, "_letters"):
            # Not idle work: what both views have to draw of a large document would be one wait of twice the length.
            self._drawing = self.widget.after(0, self._draw_now)

    def catch_up(self) -> None:
        """Draw now what waits to be drawn."""
        if self._drawing is not None:
            self.widget.after_cancel(self._drawing)
            self._draw_now()

    def refresh(self) -> None:
        """Draw the moving part anew, soon; many calls are one."""
        if self._waiting is None:
            self._waiting = self.widget.after_idle(self.refresh_now)

    def refresh_now(self) -> None:
        """Draw the moving part anew: only what it covered and covers is touched."""
        if self._waiting is not None:
            self.widget.after_cancel(self._waiting)
            self._waiting = None
        if self._kept is None or self._kept.shape != self.picture.shape:
            return  # everything is about to be drawn
        for left, top, right, bottom in map(self._pixels, self._touched):
            self.picture[top:bottom, left:right] = self._kept[top:bottom, left:right]
        before = self._touched
        self._over()
        self._unshown = apart([*self._unshown, *before, *self._touched])
        if self._showing is None:
            self._show()

    def _show(self) -> None:
        """One of the boxes that changed, then the next: Tk draws all that lies between those that it is given at once."""
        self._showing = None
        if self._unshown:
            left, top, right, bottom = self._pixels(self._unshown.pop())
            put(self._tkphoto, self.picture, rows=(top, bottom), columns=(left, right))
        if self._unshown:
            self._showing = self.widget.after_idle(self._show)

    def _draw_now(self) -> None:
        self._drawing = None
        self.draw()

    def _stop(self, _: tk.Event) -> None:
        """The window is closed: nothing is drawn any more."""
        for waiting in (self._drawing, self._waiting, self._showing):
            if waiting is not None:
                self.widget.after_cancel(waiting)
        self._drawing = self._waiting = self._showing = None

    def _over(self) -> None:
        pen = Pen(self.get_renderer(), self._letters, self.ratio)
        self._moving(pen)
        self._touched = pen.touched

    def _pixels(self, box: Box) -> tuple[int, int, int, int]:
        """Columns and rows (counted down) that a box covers: left, top, right, bottom."""
        width, height = self.size
        left, right = max(int(box[0]), 0), min(int(box[2]) + 1, width)
        top, bottom = max(int(height - box[3]), 0), min(int(height - box[1]) + 1, height)
        return left, top, max(right, left), max(bottom, top)
