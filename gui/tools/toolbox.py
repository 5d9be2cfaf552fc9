"""The tools, which of them is in hand, and the two views it works in."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from gui.actions import Action
from gui.desk import Desk
from gui.state.selection import NOTHING
from gui.theme import Theme
from gui.tools.add_sensor import AddSensor
from gui.tools.paint import Paint
from gui.tools.seams import Cut, Forbid, Glue, Lock
from gui.tools.tool import AnyHit, Tool
from gui.view2d.view import View2D
from gui.view3d.view import View3D
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern


class Select(Tool):
    """Clicks select; in the flat view sensors are dragged."""

    id, label, key = "select", "Select", "Key-space"
    tip = "Click selects; on the flat skin drag a sensor, or its handle to turn it."

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        self._desk.session.select(hit.target)


class Toolbox:
    """Hands what happens in the views to the tool that ``session.tool`` names.

    Parameters
    ----------
    desk : Desk
    view3d, view2d : the views
    theme : callable
        The colours now.
    pattern : callable
        Of the next sensor.
    more : sequence of Tool
        Further tools, such as measuring.
    """

    def __init__(
        self,
        desk: Desk,
        view3d: View3D,
        view2d: View2D,
        *,
        theme: Callable[[], Theme],
        pattern: Callable[[], Pattern],
        more: Sequence[Tool] = (),
    ) -> None:
        self._desk, self._view3d, self._view2d, self._theme = desk, view3d, view2d, theme
        all_tools: list[Tool] = [
            Select(desk),
            Cut(desk, self._show_way),
            Glue(desk),
            Lock(desk),
            Forbid(desk, self._show_way),
            Paint(desk, 1),
            Paint(desk, -1),
            Paint(desk, 0),
            AddSensor(desk, pattern),
            *more,
        ]
        self.tools = {tool.id: tool for tool in all_tools}
        self._mesh: Mesh | None = None
        self._held: Tool = self.tools["select"]
        for view in (view3d, view2d):
            view.on_click, view.on_drag, view.on_release = self._click, self._drag, self._release
            view.on_point = self._point
            view.cursor.say = desk.say
        desk.session.listen("tool", self._changed)
        desk.session.listen("skin", self._other_object)

    def actions(self) -> list[Action]:
        """For the table."""
        session = self._desk.session

        def action(tool: Tool) -> Action:
            return Action(
                tool.id,
                tool.label,
                "Tools",
                lambda: session.take_up(tool.id),
                tool.key,
                self._desk.has_skin,
                tool.tip,
                True,
                checked=lambda: session.tool == tool.id,
            )

        return [*map(action, self.tools.values()), Action("stop", "Drop what was begun", "Tools", self.stop, "Escape")]

    @property
    def held(self) -> Tool:
        """The tool in hand."""
        return self._held

    def stop(self) -> None:
        """Drop what was begun; where nothing was, the cursor that keys move; then the tool; where none was held, the selection."""
        begun = self._held.begun
        self._held.stop()
        if begun:
            return
        for cursor in (self._view3d.cursor, self._view2d.cursor):
            if cursor.shown:
                cursor.end()
                self._desk.say(self._held.tip)
                return
        if self._held.id != "select":
            self._desk.session.take_up("select")
        else:
            self._desk.session.select(NOTHING)

    def _changed(self) -> None:
        self._held.stop()
        self._held = self.tools[self._desk.session.tool]
        self._desk.say(self._held.tip)

    def _other_object(self) -> None:
        """What was begun on one object cannot be gone on with on another."""
        mesh = None if self._desk.session.skin is None else self._desk.session.skin.mesh
        if mesh is not self._mesh:
            self._mesh = mesh
            self._held.stop()

    def _click(self, hit: AnyHit | None, shift: bool) -> None:
        if hit is None or (hit.face < 0 and self._held.id != "select" and not hit.target):
            if self._held.id == "select":
                self._desk.session.select(NOTHING)
            return
        self._held.click(hit, shift=shift)

    def _drag(self, hit: AnyHit) -> bool:
        return self._held.drag(hit)

    def _release(self, hit: AnyHit | None) -> None:
        self._held.release()

    def _point(self, hit: AnyHit | None) -> None:
        self._held.point(hit)

    def _show_way(self, way: NDArray[np.float64] | None) -> None:
        if way is None:
            self._view3d.hide("way")
        else:
            self._view3d.show("way", [way], self._theme().hover, 3.0)
