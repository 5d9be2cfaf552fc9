"""Cut by itself, and keep the flat pieces in step with the seams."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.adopt import adopt
from gui.state.problem import Problem
from gui.state.selection import Target
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
        self._settled: list[NDArray[np.int64]] = []
        self.method = "auto"
        desk.session.listen("skin", self._follow)

    def actions(self) -> list[Action]:
        """For the table."""
        has = self._desk.has_skin
        return [
            Action("auto_cut", "Cut automatically", "Seams", self.auto_cut, "F5", has, "Few good pieces; locked seams stay.", True),
            Action("flatten", "Flatten all pieces anew", "Seams", self.flatten_anew, "F6", self._desk.has_pieces),
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
            anew=ids,
        )

    def choose_method(self, method: str) -> None:
        """Flatten by another method from now on, and all pieces at once."""
        self.method = method
        if self._desk.has_pieces():
            self.flatten_anew()

    def _follow(self) -> None:
        """Open the object along its seams as they are now, unless the pieces are those already."""
        skin = self._desk.session.skin
        if skin is None or any(skin.seams is seams for seams in self._settled):
            return
        self._desk.work("flattening", tasks.reopen, self._take(skin, ""), source="flatten", skin=skin, method=self.method, anew=[])

    def _take(self, asked: Skin, label: str) -> Callable[[Reopened], None]:
        """What to do with the result for `asked`: a step of that name, or what completes the last step."""

        def take(result: Reopened) -> None:
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
            self._settled.append(skin.seams)
            del self._settled[:-_MOST_SETTLED]
            if label:
                session.do(label, skin)
            elif skin.pieces != asked.pieces or skin.seams is not asked.seams:
                session.amend(skin)
            session.report("flatten", [Problem(f.text, "flatten", kind="warning", target=Target(piece=f.piece)) for f in result.faults])

        return take
