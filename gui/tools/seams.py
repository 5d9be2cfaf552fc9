"""Seams by clicks: cut, glue, lock, forbid."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from gui.desk import Desk
from gui.tools.tool import AnyHit, Tool
from skinfab.seams import edit
from skinfab.seams.rules import edge_mask
from skinfab.seams.ways import Ways
from skinfab.skin import Skin

#: Shows a way over the object, (k, 3) mm; None takes it away.
ShowWay = Callable[[NDArray[np.float64] | None], None]


class _Way(Tool, ABC):
    """Two clicks or more: what is done along the cheapest way from each to the next."""

    def __init__(self, desk: Desk, show: ShowWay) -> None:
        self._desk, self._show = desk, show
        self._last = self._marked = -1
        self._ends: dict[int, int] = {}  # where the line ended after each step of the document since it was begun
        self._ways: Ways | None = None
        desk.session.listen("skin", self._follow)

    @property
    @abstractmethod
    def step(self) -> str:
        """What undo calls it."""

    @abstractmethod
    def along(self, skin: Skin, vertices: Sequence[int], ways: Ways) -> Skin:
        """The skin with this done from the first vertex to the second."""

    @property
    def begun(self) -> bool:
        return self._last >= 0

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        skin = self._desk.skin
        if hit.vertex < 0:  # beside a piece of the flat skin, on its rim
            self._desk.say("There is no point of the object there; click on it, or on a piece.")
            return
        if self._last < 0:
            self._end_at(hit.vertex)
            self._show(skin.object.V[[hit.vertex]])
            self._desk.say("Now the next point; Esc ends the line.")
            return
        if hit.vertex != self._last:
            ways, start = self._ways_of(skin), self._last
            if self._desk.guarded("seams", lambda: self._do(skin, [start, hit.vertex], ways)):
                self._end_at(hit.vertex)
                self._show(None)

    def point(self, hit: AnyHit | None) -> None:
        if self._last < 0:
            self._mark(-1 if hit is None else hit.vertex)
            return
        if hit is None or hit.vertex < 0:
            return
        skin = self._desk.skin
        self._show(skin.object.V[edit.preview_path(skin, self._last, hit.vertex, ways=self._ways_of(skin))])

    def stop(self) -> None:
        self._last = self._marked = -1
        self._ends.clear()
        self._show(None)

    def _mark(self, vertex: int) -> None:
        """Show where a line would begin."""
        if vertex != self._marked:
            self._marked = vertex
            self._show(self._desk.skin.object.V[[vertex]] if vertex >= 0 else None)

    def _end_at(self, vertex: int) -> None:
        self._last = vertex
        self._ends[self._desk.session.step] = vertex

    def _follow(self) -> None:
        """After undo and redo the line goes on from where it ended then; undone to before its first point, it begins anew."""
        skin, step = self._desk.session.skin, self._desk.session.step
        if not self.begun or skin is None:
            return
        if step > max(self._ends):  # something new was done, which the line outlives
            self._end_at(self._last)
        elif step not in self._ends:
            self.stop()
        elif self._ends[step] != self._last:
            self._last = self._ends[step]
            self._show(skin.object.V[[self._last]])

    def _ways_of(self, skin: Skin) -> Ways:
        if self._ways is None or not self._ways.suit(skin):
            self._ways = Ways(skin.mesh, skin.marks)
        return self._ways

    def _do(self, skin: Skin, vertices: list[int], ways: Ways) -> None:
        changed = self.along(skin, vertices, ways)
        self._desk.session.report("seams", [])
        if changed is not skin:
            self._desk.session.do(self.step, changed)
        else:
            self._desk.say("That is so already.")


class Cut(_Way):
    """Cuts along shortest ways between clicked points, sharp edges preferred."""

    id, label, key, step = "cut", "Cut", "c", "cut"
    tip = "Click points on the object: the seam runs between them along the cheapest way; Esc ends it."

    def along(self, skin: Skin, vertices: Sequence[int], ways: Ways) -> Skin:
        return edit.cut_path(skin, vertices, ways=ways)


class Forbid(_Way):
    """Says where seams must not run: along a seam that is clicked, or between clicked points; Shift allows again."""

    id, label, key, step = "forbid", "Forbid", "x", "forbid seams"
    tip = "Click a seam, or points one after the other: no seam will run there. Shift+click on a forbidden line allows it."

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        skin, edge = self._desk.skin, _seam_of(hit)
        if shift:
            self._desk.guarded("seams", lambda: self._allow(skin, hit.edge))
        elif self._last < 0 and edge >= 0 and edge_mask(skin.mesh, skin.seams)[edge]:
            self._desk.guarded("seams", lambda: self._forbid_seam(skin, edge))
        else:
            super().click(hit, shift=shift)

    def along(self, skin: Skin, vertices: Sequence[int], ways: Ways) -> Skin:
        return edit.forbid(skin, edit.path_edges(skin.mesh, ways.path(*vertices)))

    def _forbid_seam(self, skin: Skin, edge: int) -> None:
        self._desk.session.do(self.step, edit.forbid(skin, edit.chain(skin.mesh, skin.seams, edge)))
        self._desk.session.report("seams", [])

    def _allow(self, skin: Skin, edge: int) -> None:
        if edge < 0 or skin.marks is None or not edge_mask(skin.mesh, skin.marks.forbidden)[edge]:
            self._desk.say("Nothing is forbidden there.")
            return
        self._desk.session.do("allow seams", edit.allow(skin, edit.chain(skin.mesh, skin.marks.forbidden, edge)))


class _OnSeam(Tool, ABC):
    """One click on a seam."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        skin, edge = self._desk.skin, _seam_of(hit)
        if edge < 0 or not edge_mask(skin.mesh, skin.seams)[edge]:
            self._desk.say("There is no seam there; click on one.")
            return
        self._desk.guarded("seams", lambda: self._do(skin, edge))

    @abstractmethod
    def on(self, skin: Skin, edge: int) -> tuple[str, Skin]:
        """What undo calls it, and the skin with it done."""

    def _do(self, skin: Skin, edge: int) -> None:
        label, changed = self.on(skin, edge)
        self._desk.session.report("seams", [])
        self._desk.session.do(label, changed)


class Glue(_OnSeam):
    """Joins the object again along a seam."""

    id, label, key = "glue", "Glue", "g"
    tip = "Click a seam to close it, as far as it is unbroken."

    def on(self, skin: Skin, edge: int) -> tuple[str, Skin]:
        return "glue", edit.glue(skin, edge)


class Lock(_OnSeam):
    """Keeps a seam whatever an automatic cut does; a second click lets go."""

    id, label, key = "lock", "Lock", "l"
    tip = "Click a seam to keep it when the object is cut automatically; click again to let go."

    def on(self, skin: Skin, edge: int) -> tuple[str, Skin]:
        edges = edit.chain(skin.mesh, skin.seams, edge)
        if skin.marks is not None and edge_mask(skin.mesh, skin.marks.locked)[edge]:
            return "unlock", edit.unlock(skin, edges)
        return "lock", edit.lock(skin, edges)


def _seam_of(hit: AnyHit) -> int:
    """The seam that was meant: the one within reach, else the nearest edge."""
    return hit.target.seam if hit.target.seam >= 0 else hit.edge
