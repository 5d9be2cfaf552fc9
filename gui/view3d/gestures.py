"""What the mouse and the keys do in the 3D view."""

from __future__ import annotations

import tkinter as tk
from typing import TYPE_CHECKING

import numpy as np

from gui.state.selection import NOTHING
from gui.view3d.camera import SIDES, Camera

if TYPE_CHECKING:
    from gui.view3d.view import View3D

#: A press that moves by less is a click, pixels at 96 dots per inch.
_CLICK = 4

#: One step of the wheel, and one key press: enlarging, rad, pixels.
_WHEEL, _KEY_ZOOM, _KEY_TURN, _KEY_PAN = 1.15, 1.2, np.radians(10), 30

#: Bits of an event's state.
_SHIFT, _CONTROL = 0x1, 0x4

_ARROWS = {"Left": (-1, 0), "Right": (1, 0), "Up": (0, -1), "Down": (0, 1)}


class Gestures:
    """Binds the events of a view's canvas; motion is acted upon when nothing else waits, so that a slow picture loses no event.

    Parameters
    ----------
    view : View3D
    """

    def __init__(self, view: View3D) -> None:
        self._view = view
        self._start: tuple[int, int] | None = None
        self._last = self._now = (0, 0)
        self._does = ""  # "click" until it has moved, then "turn", "pan" or "tool"
        self._shift = False
        self._idle = ""
        canvas = view.canvas
        for button in (1, 2, 3):
            canvas.bind(f"<ButtonPress-{button}>", self._press)
            canvas.bind(f"<B{button}-Motion>", self._motion)
            canvas.bind(f"<ButtonRelease-{button}>", self._release)
        canvas.bind("<Motion>", self._hover)
        canvas.bind("<Leave>", self._leave)
        canvas.bind("<MouseWheel>", lambda event: self._wheel(event, event.delta))
        canvas.bind("<Button-4>", lambda event: self._wheel(event, 120))
        canvas.bind("<Button-5>", lambda event: self._wheel(event, -120))
        for key, (right, down) in _ARROWS.items():
            canvas.bind(f"<{key}>", lambda event, r=right, d=down: self._turn(r, d))  # type: ignore[misc]
            canvas.bind(f"<Shift-{key}>", lambda event, r=right, d=down: self._pan(r, d))  # type: ignore[misc]
        for keys, factor in ((("plus", "equal", "KP_Add"), _KEY_ZOOM), (("minus", "KP_Subtract"), 1 / _KEY_ZOOM)):
            for key in keys:
                canvas.bind(f"<Key-{key}>", lambda event, f=factor: self._zoom(f))  # type: ignore[misc]
        canvas.bind("<Key-f>", lambda event: self._move_to(view.camera.whole()))
        for number, side in enumerate(SIDES, start=1):
            canvas.bind(f"<Key-{number}>", lambda event, s=side: self._move_to(view.camera.seen_from(s).whole()))  # type: ignore[misc]
            canvas.bind(f"<Control-Key-{number}>", lambda event: None)  # the window's: Tk would take it for the key alone
        canvas.bind("<Destroy>", lambda event: self._forget(), add=True)

    # What keys do in place of the mouse

    looking = "turn the object"

    def is_empty(self) -> bool:
        """Whether nothing is open."""
        return self._view.session.skin is None

    def point_at(self, x: int, y: int) -> None:
        """As if the mouse had come there."""
        self._view.canvas.update_idletasks()  # what is there is asked of the picture, which must be that of now
        self._view.hover_at(x, y)

    def click_at(self, x: int, y: int, *, shift: bool) -> None:
        """As if the mouse had clicked there."""
        self._view.canvas.update_idletasks()
        if self._view.on_click is not None:
            self._view.on_click(self._view.hit_at(x, y), shift)

    def leave(self) -> None:
        """As if the mouse had left."""
        self._view.session.hover(NOTHING)
        if self._view.on_point is not None:
            self._view.on_point(None)

    def look_by(self, right: int, down: int) -> None:
        """Turn by one step."""
        self._turn(right, down)

    def zoom_at(self, factor: float, x: int, y: int) -> None:
        """Enlarge what is there."""
        self._move_to(self._view.camera.zoomed(factor, (x, y)))

    # Mouse and keys

    def _press(self, event: tk.Event[tk.Misc]) -> None:
        self._view.canvas.focus_set()
        self._start = self._last = self._now = (event.x, event.y)
        self._shift = bool(int(event.state) & _SHIFT)
        pans = event.num == 2 or (event.num == 1 and int(event.state) & _CONTROL)
        self._does = "pan" if pans else "turn" if event.num == 3 else "click"

    def _motion(self, event: tk.Event[tk.Misc]) -> None:
        self._now = (event.x, event.y)
        if self._start is not None and not self._idle:
            self._idle = self._view.after_idle(self._move)

    def _move(self) -> None:
        self._idle = ""
        if self._start is None:
            return
        if self._does == "click":
            if max(abs(self._now[0] - self._start[0]), abs(self._now[1] - self._start[1])) <= _CLICK * self._view.dpi:
                return
            self._does = self._who_drags()
        (x0, y0), (x, y) = self._last, self._now
        self._last = self._now
        view = self._view
        if self._does == "turn":
            view.move(view.camera.dragged((x0, y0), (x, y)))
        elif self._does == "pan":
            view.move(view.camera.panned(x - x0, y - y0))
        elif view.on_drag is not None:
            here = view.hit_at(x, y)
            if here is not None:
                view.on_drag(here)

    def _who_drags(self) -> str:
        """The tool, where it takes what begins here; else the object turns."""
        assert self._start is not None
        found = self._view.hit_at(*self._start) if self._view.on_drag is not None else None
        return "tool" if found is not None and self._view.on_drag is not None and self._view.on_drag(found) is True else "turn"

    def _release(self, event: tk.Event[tk.Misc]) -> None:
        if self._start is None:
            return
        self._now = (event.x, event.y)
        if self._does in ("turn", "pan", "tool", "click"):
            self._forget()
            self._move()
        does, self._start, self._does = self._does, None, ""
        view = self._view
        if does == "tool" and view.on_release is not None:
            view.on_release(view.hit_at(event.x, event.y))
        elif does == "click" and view.on_click is not None:
            view.on_click(view.hit_at(event.x, event.y), self._shift)

    def _hover(self, event: tk.Event[tk.Misc]) -> None:
        self._now = (event.x, event.y)
        if self._start is None and not self._idle:
            self._idle = self._view.after_idle(self._hovered)

    def _hovered(self) -> None:
        self._idle = ""
        if self._start is None:
            self._view.hover_at(*self._now)

    def _leave(self, event: tk.Event[tk.Misc]) -> None:
        if self._start is None and not self._view.cursor.shown:
            self._forget()
            self.leave()

    def _wheel(self, event: tk.Event[tk.Misc], delta: int) -> str:
        factor = _WHEEL if delta > 0 else 1 / _WHEEL
        return self._move_to(self._view.camera.zoomed(factor, (event.x, event.y)))

    def _zoom(self, factor: float) -> str:
        camera = self._view.camera
        return self._move_to(camera.zoomed(factor, (camera.width / 2, camera.height / 2)))

    def _turn(self, right: int, down: int) -> str:
        return self._move_to(self._view.camera.turned(right * _KEY_TURN, down * _KEY_TURN))

    def _pan(self, right: int, down: int) -> str:
        step = _KEY_PAN * self._view.dpi
        return self._move_to(self._view.camera.panned(right * step, down * step))

    def _move_to(self, camera: Camera) -> str:
        self._view.move(camera)
        return "break"  # so that no key does something else as well

    def _forget(self) -> None:
        if self._idle:
            self._view.after_cancel(self._idle)
            self._idle = ""
