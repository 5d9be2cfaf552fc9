"""A cursor that keys move over a view: what the mouse can do with a click, they can do too."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from functools import partial
from typing import Protocol

#: How far one key press goes, pixels at 96 dots per inch: held down it crosses a view in three seconds, and passes no line unseen, which
#: a view finds from 5 pixels to either side. With Shift it goes one pixel of the screen.
STEP = 10

#: One key press enlarges by so much.
ZOOM = 1.25

#: Half the size of the cross and of its open middle, where one sees what it is on, pixels at 96 dots per inch.
_ARM, _OPEN = 15, 4

_ARROWS = {"Left": (-1, 0), "Right": (1, 0), "Up": (0, -1), "Down": (0, 1)}
_LARGER, _SMALLER = ("plus", "equal", "KP_Add"), ("minus", "KP_Subtract")

HINT = "Arrows move the cursor (Shift: by one pixel), Enter clicks, Ctrl+arrows {}, + and - enlarge, Esc ends."


class Pointed(Protocol):
    """A view that can be pointed at; places are pixels of its canvas."""

    #: What Ctrl and an arrow do: "turn the object".
    looking: str

    def point_at(self, x: int, y: int) -> None:
        """As if the mouse had come there."""

    def click_at(self, x: int, y: int, *, shift: bool) -> None:
        """As if the mouse had clicked there."""

    def leave(self) -> None:
        """As if the mouse had left the view."""

    def look_by(self, right: int, down: int) -> None:
        """One step of the view itself."""

    def zoom_at(self, factor: float, x: int, y: int) -> None:
        """Larger; what is at that place stays there."""

    def is_empty(self) -> bool:
        """Whether there is nothing to point at."""


class KeyCursor:
    """Bound to the canvas of a view, before the view's own keys: it takes arrows only while it is shown.

    Parameters
    ----------
    view : Pointed
    canvas : tk.Canvas
        Its keys come here while it has the focus.
    colours : callable
        Of the cross, and of the ground round it.

    Attributes
    ----------
    say : callable
        Told what the keys do when it appears.
    at : (2,) int, pixels; or None before it was first used
    """

    def __init__(self, view: Pointed, canvas: tk.Canvas, *, colours: Callable[[], tuple[str, str]]) -> None:
        self._view, self._canvas, self._colours = view, canvas, colours
        self._dpi = canvas.winfo_fpixels("1i") / 96
        self.say: Callable[[str], object] = lambda text: None
        self.at: tuple[int, int] | None = None
        self._on = False
        self._idle = ""
        tag = f"cursor{canvas}"
        canvas.bindtags((tag, *canvas.bindtags()))

        def bind(key: str, does: Callable[[], str | None]) -> None:
            canvas.bind_class(tag, f"<{key}>", lambda event: does())

        for key, (right, down) in _ARROWS.items():
            bind(key, partial(self._move, right, down, round(STEP * self._dpi)))
            bind(f"Shift-{key}", partial(self._move, right, down, 1))
            bind(f"Control-{key}", partial(self._look, right, down))
        for keys, factor in ((_LARGER, ZOOM), (_SMALLER, 1 / ZOOM)):
            for key in keys:
                bind(f"Key-{key}", partial(self._zoom, factor))
        for key in ("Return", "KP_Enter"):
            bind(key, self._enter)
            bind(f"Shift-{key}", lambda: self._enter(shift=True))
        bind("ButtonPress", self.end)  # the mouse has its own pointer
        bind("FocusOut", self._hide)
        bind("FocusIn", self._show)
        bind("Configure", self._show)
        bind("Destroy", self._forget)

    @property
    def shown(self) -> bool:
        """Whether keys move it now."""
        return self._on and self._canvas.focus_get() is self._canvas

    def begin(self) -> None:
        """Take the focus and appear, where it was last."""
        if self._view.is_empty():
            return
        self._canvas.focus_set()
        self._on = True
        width, height = self._canvas.winfo_width(), self._canvas.winfo_height()
        self._go(*(self.at or (width // 2, height // 2)))
        self._again()  # now: what it is on must not take the place of what the keys do
        self.say(HINT.format(self._view.looking))

    def end(self) -> None:
        """Disappear; arrows do again what they did."""
        if self._on:
            self._on = False
            self._hide()
            self._view.leave()

    def _enter(self, *, shift: bool = False) -> str:
        if not self._on:
            self.begin()
        elif self.at is not None and not self._view.is_empty():
            self._view.click_at(*self.at, shift=shift)
            self._later()  # what is under it may be something else now
        return "break"

    def _move(self, right: int, down: int, step: int) -> str | None:
        if not self._on or self.at is None:
            return None
        self._go(self.at[0] + right * step, self.at[1] + down * step)
        return "break"

    def _look(self, right: int, down: int) -> str | None:
        if not self._on:
            return None
        self._view.look_by(right, down)
        self._later()
        return "break"

    def _zoom(self, factor: float) -> str | None:
        if not self._on or self.at is None:
            return None
        self._view.zoom_at(factor, *self.at)
        self._later()
        return "break"

    def _go(self, x: int, y: int) -> None:
        """Within the view."""
        width, height = self._canvas.winfo_width(), self._canvas.winfo_height()
        self.at = min(max(x, 0), max(width - 1, 0)), min(max(y, 0), max(height - 1, 0))
        self._show()
        self._later()

    def _later(self) -> None:
        """Point there once nothing else waits: of a key that is held down, a slow picture follows as it can, and lags behind no more."""
        if not self._idle:
            self._idle = self._canvas.after_idle(self._again)

    def _again(self) -> None:
        self._forget()
        if self.shown and self.at is not None:
            self._view.point_at(*self.at)

    def _show(self) -> None:
        self._canvas.delete("keycursor")
        if not self._on or self.at is None:
            return
        width, height = self._canvas.winfo_width(), self._canvas.winfo_height()
        x, y = self.at = min(self.at[0], max(width - 1, 0)), min(self.at[1], max(height - 1, 0))
        near, far = _OPEN * self._dpi, _ARM * self._dpi
        colour, ground = self._colours()
        for fill, wide, more in ((ground, 5, 1.5), (colour, 2, 0.0)):  # seen on any ground
            for dx, dy in _ARROWS.values():
                ends = [x + dx * (near - more), y + dy * (near - more), x + dx * (far + more), y + dy * (far + more)]
                self._canvas.create_line(ends, fill=fill, width=wide * self._dpi, tags=("keycursor",))

    def _hide(self) -> None:
        # What is lit stays so: it may be the other view's cursor that has the keys now, and has said what it is on.
        self._canvas.delete("keycursor")

    def _forget(self) -> None:
        if self._idle:
            self._canvas.after_cancel(self._idle)
            self._idle = ""
