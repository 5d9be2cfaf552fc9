"""Cut by itself, and keep the flat pieces in step with the seams."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.adopt import adopt
from gui.state.problem import Problem
from gui.state.selection import Target
from skinfab.flatten.methods import METHODS
from skinfab.seams.partial import Reopened
from skinfab.skin import Skin

#: Seams that are known to fit their pieces; as many as there are steps to undo, and some.
_MOST_SETTLED = 400


class SeamCommands:
    """The Seams menu; flattens anew whenever the seams were changed.

    Parameters
    ----------
    desk : Desk
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._settled: list[tuple[NDArray[np.int64], list[Problem]]] = []
        self._behind = False
        self.method = "auto"
        self.cones: int | None = None
        desk.session.listen("skin", self._follow)

    def actions(self) -> list[Action]:
        """For the table."""
        has = self._desk.has_skin
        return [
            Action("auto_cut", "Cut automatically", "Seams", self.auto_cut, "F5", has, "Few good pieces; locked seams stay.", True),
            Action("flatten", "Flatten all pieces anew", "Seams", self.flatten_anew, "F6", self._can_flatten),
            Action("clear_seams", "Glue all seams that are not locked", "Seams", self.clear, "", has),
            Action("clear_marks", "Forget locks, bans and paint", "Seams", self.clear_marks, "", self._has_marks),
        ]

    def auto_cut(self) -> None:
        """Automatic seams in place of those that are not locked."""
        asked = self._desk.skin
        self._desk.work("cutting and flattening", tasks.auto_cut, self._take(asked, "cut automatically"), source="flatten", skin=asked)

    def flatten_anew(self) -> None:
        """All pieces, by the method that is chosen."""
        asked = self._desk.skin
        ids = [p.id for p in asked.pieces]
        self._desk.work(
            "flattening",
            tasks.reopen,
            self._take(asked, f"flatten ({self.method})"),
            source="flatten",
            skin=asked,
            method=self.method,
            cones=self._cones(),
            anew=ids,
        )

    def clear(self) -> None:
        """One surface again, but for what is locked."""
        skin = self._desk.skin
        locked = skin.marks.locked if skin.marks is not None else np.zeros((0, 2), dtype=np.int64)
        self._desk.session.do("glue all", replace(skin, seams=locked))

    def clear_marks(self) -> None:
        """Seams stay; what was said about where they may run goes."""
        self._desk.session.do("forget marks", replace(self._desk.skin, marks=None))

    def make_thick(self, thickness: float) -> None:
        """Flatten for a skin of that thickness, mm; 0 for the object's own surface."""
        asked = self._desk.skin
        if thickness == asked.thickness:
            return

        def take(result: Reopened) -> None:
            session = self._desk.session
            if session.skin is not asked:
                self._desk.complain("flatten", "the skin changed while it was flattened for another thickness; set it again")
                return
            self._settle(result.skin, result)
            session.do(f"skin {thickness:g} mm thick", result.skin)

        label = f"flattening for {thickness:g} mm"
        self._desk.work(label, tasks.make_thick, take, source="flatten", skin=asked, thickness=thickness, method=self.method)

    def _cones(self) -> int | None:
        return self.cones if self.method == "bff-cones" else None

    def _has_marks(self) -> bool:
        return self._desk.session.skin is not None and self._desk.skin.marks is not None

    def fill_methods(self, menu: tk.Menu) -> None:
        """One entry a method of flattening; the one in use is ticked."""
        chosen = tk.StringVar(menu, value=self.method)
        for name in ("auto", "bff-cones", *METHODS):
            menu.add_radiobutton(label=name, value=name, variable=chosen, command=partial(self.choose_method, name))
        menu.add_separator()
        menu.add_command(label="Cones for bff-cones …", command=self.choose_cones)

    def choose_cones(self) -> None:
        """How many cones bff-cones has, 0 for as many as pay; flattens by it."""
        text = "How many cone points?\n0: as many as pay (the cube needs 8, the dodecahedron 20)"
        number = self._desk.dialogs.number("Cones", text, least=0, most=200, value=self.cones or 0)
        if number is not None:
            self.cones = number or None
            self.choose_method("bff-cones")

    def choose_method(self, method: str) -> None:
        """Flatten by another method from now on, and all pieces at once."""
        self.method = method
        if self._desk.has_pieces():
            self.flatten_anew()

    def catch_up(self) -> None:
        """Flatten after all, where other work took the place of that and is done now."""
        if self._behind:
            self._follow()

    def give_up(self) -> None:
        """The pieces stay behind the seams until the next change, or until they are asked for: the user stopped it, or it failed."""
        self._behind = False

    def _can_flatten(self) -> bool:
        skin = self._desk.session.skin
        return skin is not None and (bool(skin.pieces) or len(skin.seams) > 0)

    def _follow(self) -> None:
        """Open the object along its seams as they are now, unless the pieces are those already."""
        skin = self._desk.session.skin
        if skin is None:
            return
        for seams, said in self._settled:
            if skin.seams is seams:
                self._desk.session.report("flatten", said)  # after undo, what was said then
                return
        asked = {"skin": skin, "method": self.method, "cones": self._cones(), "anew": []}
        self._behind = True
        self._desk.work("flattening", tasks.reopen, self._take(skin, ""), source="flatten", failed=self.give_up, **asked)

    def _take(self, asked: Skin, label: str) -> Callable[[Reopened], None]:
        """What to do with the result for `asked`: a step of that name, or what completes the last step."""

        def take(result: Reopened) -> None:
            self._behind = False
            session = self._desk.session
            if session.skin is None or session.skin.mesh is not asked.mesh:
                return  # something else was opened meanwhile
            skin = adopt(asked, result.skin)
            if session.skin is not asked:
                # Changed meanwhile: what was found still says where to cut, the rest follows from that.
                if label:
                    session.do(label, replace(session.skin, seams=skin.seams))
                else:
                    self._follow()
                return
            self._settle(skin, result)
            if label:
                session.do(label, skin)
            elif skin.pieces != asked.pieces or skin.seams is not asked.seams:
                session.amend(skin)

        return take

    def _settle(self, skin: Skin, result: Reopened) -> None:
        """The pieces of `skin` are those of its seams, and this is what there is to say of them."""
        said = [Problem(f.text, "flatten", kind="warning", target=Target(piece=f.piece)) for f in result.faults]
        self._settled.append((skin.seams, said))
        del self._settled[:-_MOST_SETTLED]
        self._desk.session.report("flatten", said)
