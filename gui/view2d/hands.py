"""What the pointer and the keys do in the flat view: move, turn, nudge and select; what else, the current tool knows."""

from __future__ import annotations

import tkinter as tk
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gui.state.selection import NOTHING, Target
from gui.view2d.drag import REACH_PX, Grabbed
from gui.view2d.keys import PAN_PX, bind_keys
from gui.view2d.live import Findings
from gui.view2d.marking import HANDLE_RADIUS_PX
from gui.view2d.replaced import with_sensors
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin

if TYPE_CHECKING:
    from gui.view2d.view import View2D

Float = NDArray[np.float64]

#: Pixels a pressed pointer moves before that is a drag.
_SLACK_PX = 3
#: A dragged sensor goes into the document when the pointer has rested for so long, ms: others may take their time to follow.
_REST_MS = 90
#: Tk's bits of a pressed key.
_SHIFT, _CONTROL, _ALT = 0x1, 0x4, 0x8
_ZOOM = 1.2
_NOWHERE: Float = np.zeros((0, 2, 2))


class Hands:
    """Takes hold of things in a `View2D`.

    Attributes
    ----------
    sensors : tuple of Sensor
        As they are being dragged; empty when none is.
    findings : dict
        What is wrong with them.
    guides : (k, 2, 2) float, mm of the sheet
    rectangle : (2,) and (2,) float, pixels; or None
        Corners of what is being selected.
    pointer : (2,) float, pixels
    """

    def __init__(self, view: View2D) -> None:
        self._view, self._session = view, view.session
        self.sensors: tuple[Sensor, ...] = ()
        self.findings: Findings = {}
        self.guides = _NOWHERE
        self.rectangle: tuple[Float, Float] | None = None
        self.pointer: Float = np.zeros(2)
        self._pressed: tuple[int, int] | None = None
        self._grabbed: Grabbed | None = None
        self._panned: tuple[int, int] | None = None
        self._tool_has_it = False
        self._committing = False
        self._committed: Skin | None = None
        self._event: tuple[int, int, int] | None = None
        self._waiting: str | None = None
        self._resting: str | None = None
        self._hit_words = ""
        widget = view.surface.widget
        for event, callback in (
            ("<Motion>", self._moved),
            ("<ButtonPress-1>", self._press),
            ("<ButtonRelease-1>", self._release),
            ("<ButtonPress-2>", self._press_pan),
            ("<ButtonPress-3>", self._press_pan),
            ("<ButtonRelease-2>", self._release_pan),
            ("<ButtonRelease-3>", self._release_pan),
            ("<Leave>", self._left),
            ("<Button-4>", lambda e: self._wheel(e, _ZOOM)),
            ("<Button-5>", lambda e: self._wheel(e, 1 / _ZOOM)),
            ("<MouseWheel>", lambda e: self._wheel(e, _ZOOM ** (1 if e.delta > 0 else -1))),
            ("<Escape>", self._escape),
            ("<Destroy>", self._stop),
        ):
            widget.bind(event, callback, add=True)
        bind_keys(view)

    def changes_skin(self) -> bool:
        """Whether the change of the document that is being told is the drag's own."""
        return self._committing

    def document_changed(self) -> None:
        """Let go of sensors that were changed by someone else: where they were taken hold of is no longer where they are."""
        if self._grabbed is not None and not self._committing:
            self.let_go()

    def place(self) -> str:
        """Where the pointer is, in words."""
        return self._hit_words

    def let_go(self, *, back: bool = False) -> bool:
        """End a drag; `back` puts everything where it was before it. Whether there was one."""
        dragged, committed = bool(self.sensors), self._committed
        held = dragged or self.rectangle is not None
        self._drop_hold()
        if dragged and back and committed is not None and self._session.skin is committed:
            self._session.undo()
        elif dragged:
            self._view.redraw()
        self._view.surface.refresh()
        return held

    def _escape(self, _: tk.Event) -> str | None:
        # Where nothing is held, Escape is for whoever is asked next.
        return "break" if self.let_go(back=True) else None

    # What keys do in place of the mouse

    looking = "move the sheet"

    def is_empty(self) -> bool:
        """Whether nothing is open."""
        return self._session.skin is None

    def point_at(self, x: int, y: int) -> None:
        """As if the mouse had come there."""
        self._view.surface.catch_up()  # what is there is asked of the picture, which must be that of now
        self.pointer = self._view.pixel(x, y)
        self._hover(x, y)

    def click_at(self, x: int, y: int, *, shift: bool) -> None:
        """As if the mouse had clicked there."""
        view = self._view
        view.surface.catch_up()
        hit = view.hit(x, y)
        if hit is None:
            return
        if self._session.tool != "select":
            if view.on_click is not None:
                view.on_click(hit, shift)
            if view.on_release is not None:
                view.on_release(hit)
        elif hit.target.sensor and shift:
            self._toggle(hit.target)
        else:
            self._session.select(hit.target)

    def leave(self) -> None:
        """As if the mouse had left."""
        self._left(None)

    def look_by(self, right: int, down: int) -> None:
        """Move the sheet by one step."""
        self._view.look(self._view.plane.moved(-right * PAN_PX, down * PAN_PX))

    def zoom_at(self, factor: float, x: int, y: int) -> None:
        """Enlarge what is there."""
        self._view.zoom(factor, self._view.pixel(x, y))

    # The pointer

    def _press(self, event: tk.Event) -> None:
        view = self._view
        view.surface.widget.focus_set()
        hit = view.hit(event.x, event.y)
        if hit is None:
            return
        state = int(event.state)
        self._pressed = (event.x, event.y)
        if self._session.tool != "select":
            self._tool_has_it = True
            if view.on_click is not None:
                view.on_click(hit, bool(state & _SHIFT))
            return
        held = view.handle()
        if held is not None and np.hypot(*(held[1] - hit.sheet)) <= view.mm(HANDLE_RADIUS_PX + 3):
            self._take((held[0],), hit.sheet, turning=True)
        elif hit.target.sensor and state & (_CONTROL | _SHIFT):
            self._toggle(hit.target)
            self._pressed = None
        elif hit.target.sensor:
            chosen = (self._session.selected.sensor, *self._session.selected.also)
            if hit.target.sensor not in chosen:
                self._session.select(Target(piece=hit.target.piece, sensor=hit.target.sensor))
                chosen = (hit.target.sensor,)
            skin = self._session.skin
            assert skin is not None
            mine = [s for s in skin.sensors if s.id in chosen]
            self._take(tuple(sorted(mine, key=lambda s: s.id != hit.target.sensor)), hit.sheet, turning=False)

    def _take(self, sensors: tuple[Sensor, ...], at: Float, *, turning: bool) -> None:
        skin, sheet = self._session.skin, self._view.sheet
        assert skin is not None and sheet is not None
        ids = {s.id for s in sensors}
        others = tuple(s for s in skin.sensors if s.id not in ids)
        self._grabbed = Grabbed(sensors, at, turning, sheet.offset_of, others)
        self._committed = None
        self._view.live.prepare(skin, sensors[0].piece)

    def _moved(self, event: tk.Event) -> None:
        """Many motions between two pictures are one."""
        self._event = (event.x, event.y, int(event.state))
        if self._waiting is None:
            self._waiting = self._view.after_idle(self._follow)

    def _follow(self) -> None:
        if self._waiting is not None:
            self._view.after_cancel(self._waiting)
            self._waiting = None
        if self._event is None:
            return
        (x, y, state), self._event = self._event, None
        self.pointer = self._view.pixel(x, y)
        if self._panned is not None:
            dx, dy = x - self._panned[0], self._panned[1] - y
            self._panned = (x, y)
            self._view.look(self._view.plane.moved(dx, dy))
        elif self._grabbed is not None and self._is_drag(x, y):
            self._drag(x, y, snap=not state & (_CONTROL | _ALT))
        elif self._tool_has_it:
            hit = self._view.hit(x, y)
            if hit is not None and self._view.on_drag is not None:
                self._view.on_drag(hit)
        elif self._pressed is not None and self._grabbed is None and self._is_drag(x, y):
            self.rectangle = (self._view.pixel(*self._pressed), self.pointer)
            self._view.surface.refresh_now()
        elif self._pressed is None:
            self._hover(x, y)

    def _is_drag(self, x: int, y: int) -> bool:
        if self.sensors or self.rectangle is not None:
            return True
        return (
            self._pressed is not None and max(abs(x - self._pressed[0]), abs(y - self._pressed[1])) >= _SLACK_PX * self._view.surface.ratio
        )

    def _hover(self, x: int, y: int) -> None:
        hit = self._view.hit(x, y)
        if hit is None:
            return
        self._hit_words = f"{hit.piece}   x {hit.uv[0]:.1f}   y {hit.uv[1]:.1f} mm" if hit.piece else ""
        self._session.hover(hit.target)
        if self._view.on_point is not None:
            self._view.on_point(hit)
        self._view.surface.refresh()

    def _left(self, event: tk.Event | None) -> None:
        if event is not None and self._view.cursor.shown:
            return
        self._hit_words = ""
        if self._pressed is None:
            self._session.hover(NOTHING)
            if self._view.on_point is not None:
                self._view.on_point(None)
        self._view.surface.refresh()

    def _drag(self, x: int, y: int, *, snap: bool) -> None:
        view, skin, grabbed = self._view, self._session.skin, self._grabbed
        assert skin is not None and grabbed is not None and view.sheet is not None
        first = not self.sensors
        triangle = view.triangle(x, y)
        piece = "" if triangle < 0 else skin.pieces[int(view.sheet.owner[triangle])].id
        to = view.plane.to_mm(self.pointer)
        self.sensors, self.guides = grabbed.moved(to, piece=piece, snap=snap, reach=view.mm(REACH_PX))
        self.findings = view.live.check(skin, self.sensors, (*grabbed.others, *self.sensors))
        self._hit_words = self._words_of(self.sensors[0])
        if first:
            view.surface.draw()  # once without what is now being moved
        else:
            view.surface.refresh_now()
        if self._resting is not None:
            view.after_cancel(self._resting)
        self._resting = view.after(_REST_MS, self._commit)

    def _words_of(self, sensor: Sensor) -> str:
        return f"{sensor.id} on {sensor.piece}   x {sensor.x:.2f}   y {sensor.y:.2f} mm   {np.degrees(sensor.angle) % 360:.1f} deg"

    def _release(self, event: tk.Event) -> None:
        self._moved(event)
        self._follow()
        if self._tool_has_it:
            if self._view.on_release is not None:
                self._view.on_release(self._view.hit(event.x, event.y))
        elif self.sensors:
            self._commit()
            self._drop_hold()
            self._view.redraw()
            return
        elif self.rectangle is not None:
            self._select_inside(*self.rectangle)
        elif self._pressed is not None and self._grabbed is None:
            hit = self._view.hit(event.x, event.y)
            self._session.select(NOTHING if hit is None else hit.target)
        self._drop_hold()
        self._view.surface.refresh()

    def _commit(self) -> None:
        """Put the dragged sensors into the document; all steps of one drag are undone as one."""
        if self._resting is not None:
            self._view.after_cancel(self._resting)
            self._resting = None
        skin, grabbed = self._session.skin, self._grabbed
        if skin is None or grabbed is None or not self.sensors:
            return
        changed = with_sensors(skin, self.sensors)
        if changed is None:
            return
        verb = "turn" if grabbed.turning else "move"
        what = self.sensors[0].id if len(self.sensors) == 1 else f"{len(self.sensors)} sensors"
        self._committing, self._committed = True, changed
        try:
            self._session.do(f"{verb} {what}", changed, merge=grabbed.key)
        finally:
            self._committing = False

    def _drop_hold(self) -> None:
        if self._resting is not None:
            self._view.after_cancel(self._resting)
            self._resting = None
        self.sensors, self.findings, self.guides, self.rectangle, self._hit_words = (), {}, _NOWHERE, None, ""
        self._pressed, self._grabbed, self._panned, self._tool_has_it = None, None, None, False

    def _stop(self, _: tk.Event) -> None:
        """The window is closed: nothing follows any more."""
        self._drop_hold()
        if self._waiting is not None:
            self._view.after_cancel(self._waiting)
            self._waiting = None

    # Selecting

    def _toggle(self, target: Target) -> None:
        selected = self._session.selected
        chosen = [id for id in (selected.sensor, *selected.also) if id]
        chosen = [id for id in chosen if id != target.sensor] if target.sensor in chosen else [*chosen, target.sensor]
        self.select_sensors(chosen)

    def _select_inside(self, one: Float, two: Float) -> None:
        view, skin = self._view, self._session.skin
        if skin is None or view.sheet is None:
            return
        low, high = view.plane.to_mm(np.minimum(one, two)), view.plane.to_mm(np.maximum(one, two))
        middles = {s.id: view.lines.middle(s, view.sheet) for s in skin.sensors}
        self.select_sensors([id for id, at in middles.items() if (at >= low).all() and (at <= high).all()])

    def select_sensors(self, ids: list[str]) -> None:
        """These and no others."""
        skin = self._session.skin
        if skin is None or not ids:
            self._session.select(NOTHING)
            return
        piece = next((s.piece for s in skin.sensors if s.id == ids[0]), "")
        self._session.select(Target(piece=piece, sensor=ids[0], also=tuple(ids[1:])))

    # Looking

    def _press_pan(self, event: tk.Event) -> None:
        self._panned = (event.x, event.y)
        self._view.surface.widget.configure(cursor="fleur")

    def _release_pan(self, _: tk.Event) -> None:
        self._follow()
        self._panned = None
        self._view.surface.widget.configure(cursor="" if self._session.tool == "select" else "crosshair")

    def _wheel(self, event: tk.Event, factor: float) -> str:
        self._view.zoom(factor, self._view.pixel(event.x, event.y))
        return "break"
