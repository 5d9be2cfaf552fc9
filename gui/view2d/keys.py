"""The keys of the flat view: nudge and turn what is selected, zoom, pan, fit."""

from __future__ import annotations

import time
import tkinter as tk
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from gui.view2d.replaced import with_sensors
from skinfab.placement.edit import Sensors, rotate, shift

if TYPE_CHECKING:
    from gui.view2d.view import View2D

#: mm and degrees of one key, alone and with Shift.
NUDGE_MM, NUDGE_SHIFT_MM = 0.1, 1.0
TURN_DEG, TURN_SHIFT_DEG = 15.0, 1.0
#: Keys in a row within so many seconds are undone as one.
_ONE_STEP_S = 1.0
PAN_PX = 40
_ZOOM = 1.25


class Keys:
    """Bound to the canvas of a `View2D`, so that they work where it has the focus."""

    def __init__(self, view: View2D) -> None:
        self._view = view
        self._last, self._key = 0.0, object()
        widget = view.surface.widget
        arrows = {"Left": (-1, 0), "Right": (1, 0), "Up": (0, 1), "Down": (0, -1)}
        for key, (dx, dy) in arrows.items():
            widget.bind(f"<{key}>", self._bound(self._arrow, dx, dy, NUDGE_MM))
            widget.bind(f"<Shift-{key}>", self._bound(self._arrow, dx, dy, NUDGE_SHIFT_MM))
        for key, degrees in (
            ("bracketleft", TURN_DEG),
            ("bracketright", -TURN_DEG),
            ("braceleft", TURN_SHIFT_DEG),
            ("braceright", -TURN_SHIFT_DEG),
        ):
            widget.bind(f"<{key}>", self._bound(self._turn, degrees))
        for key, factor in (("plus", _ZOOM), ("equal", _ZOOM), ("KP_Add", _ZOOM), ("minus", 1 / _ZOOM), ("KP_Subtract", 1 / _ZOOM)):
            widget.bind(f"<{key}>", self._bound(view.zoom, factor))
        widget.bind("<Key-f>", self._bound(view.fit))
        widget.bind("<Control-a>", self._bound(self._select_all))

    def _bound(self, call: Callable[..., object], *arguments: object) -> Callable[[tk.Event], str]:
        def run(_: tk.Event) -> str:
            call(*arguments)
            return "break"

        return run

    def _select_all(self) -> None:
        skin = self._view.session.skin
        if skin is not None:
            self._view.hands.select_sensors([s.id for s in skin.sensors])

    def _chosen(self) -> list[str]:
        skin, target = self._view.session.skin, self._view.session.selected
        there = set() if skin is None else {s.id for s in skin.sensors}
        return [id for id in (target.sensor, *target.also) if id in there]

    def _arrow(self, dx: int, dy: int, step: float) -> None:
        if self._chosen():
            self._change("nudge", lambda sensors, id: shift(sensors, id, dx=dx * step, dy=dy * step))
        else:
            self._view.look(self._view.plane.moved(-dx * PAN_PX, -dy * PAN_PX))

    def _turn(self, degrees: float) -> None:
        self._change("turn", lambda sensors, id: rotate(sensors, id, angle=np.radians(degrees)))

    def _change(self, verb: str, change: Callable[[Sensors, str], Sensors]) -> None:
        skin, chosen = self._view.session.skin, self._chosen()
        if skin is None or not chosen or self._view.hands.sensors:
            return
        sensors = skin.sensors
        for id in chosen:
            sensors = change(sensors, id)
        changed = with_sensors(skin, sensors)
        if changed is None:
            return
        now = time.monotonic()
        if now - self._last > _ONE_STEP_S:
            self._key = object()
        self._last = now
        what = chosen[0] if len(chosen) == 1 else f"{len(chosen)} sensors"
        self._view.session.do(f"{verb} {what}", changed, merge=(self._key, verb, tuple(chosen)))


def bind_keys(view: View2D) -> Keys:
    """Give a view its keys."""
    return Keys(view)
