"""Cut by itself, and keep the flat pieces in step with the seams."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.adopt import adopt
from gui.state.problem import Problem
from gui.state.selection import Target
from gui.state.wording import in_window
from skinfab.flatten.methods import METHODS
from skinfab.placement.sensor import Sensor
from skinfab.seams.partial import Fault, Reopened
from skinfab.skin import Skin

#: Seams that are known to fit their pieces; as many as there are steps to undo, and some.
_MOST_SETTLED = 400


@dataclass(frozen=True, eq=False)
class _Settled:
    """Seams whose pieces are known, and what there is to say of them.

    Parameters
    ----------
    seams : (k, 2) int64
    pieces : tuple of Problem
    sensors : tuple of Sensor
        Those that were left.
    taken_off : tuple of Problem
        About those that were not; said as long as nobody changes the sensors.
    """

    seams: NDArray[np.int64]
    pieces: tuple[Problem, ...]
    sensors: tuple[Sensor, ...]
    taken_off: tuple[Problem, ...]

    def said(self, skin: Skin) -> tuple[Problem, ...]:
        """What holds of that document."""
        return self.pieces + (self.taken_off if skin.sensors == self.sensors else ())


class SeamCommands:
    """The Seams menu; flattens anew whenever the seams were changed.

    Parameters
    ----------
    desk : Desk
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._settled: list[_Settled] = []
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
        self._desk.work(
            "cutting and flattening",
            tasks.auto_cut,
            self._take(asked, "cut automatically", over_sensors=True),
            source="flatten",
            skin=asked,
        )

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
            self._behind = False
            session = self._desk.session
            if session.skin is not asked:
                if session.skin is not None and session.skin.mesh is asked.mesh:
                    self._desk.dropped("the skin was changed while it was flattened for another thickness, which is let go; set it again")
                    self._follow()
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
        if not self._desk.settle():
            return
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
        for source in ("seams", "add"):  # answers to one click, which the next step leaves behind
            self._desk.session.report(source, [])
        if skin is None:
            return
        for settled in self._settled:
            if skin.seams is settled.seams:
                self._desk.session.report("flatten", settled.said(skin))  # after undo, what was said then
                self._behind = False
                return
        asked = {"skin": skin, "method": self.method, "cones": self._cones(), "anew": []}
        self._behind = True
        self._desk.work("flattening", tasks.reopen, self._take(skin, ""), source="flatten", failed=self.give_up, own=True, **asked)

    def _take(self, asked: Skin, label: str, *, over_sensors: bool = False) -> Callable[[Reopened], None]:
        """What to do with the result for `asked`: a step of that name, or what completes the last step.

        Where the document was changed meanwhile, only the seams can be taken, and only over a change of sensors.
        """

        def take(result: Reopened) -> None:
            self._behind = False
            session = self._desk.session
            if session.skin is None or session.skin.mesh is not asked.mesh:
                return  # something else was opened meanwhile
            skin = adopt(asked, result.skin)
            if session.skin is not asked:
                if over_sensors and session.redo_label is None and _asks_the_same(session.skin, asked):
                    session.do(label, replace(session.skin, seams=skin.seams))
                    return
                if label:
                    self._desk.dropped(f"the skin was changed while the work went on, so its result ({label}) is let go; ask for it again")
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
        # Whether the sensors that are there fit is said by the check of all sensors, at every move.
        lost = tuple(f"{sensor.id} was " for sensor in result.lost)
        pieces = tuple(_warning(f) for f in result.faults if f.piece or len(f.faces))
        taken_off = tuple(_warning(f) for f in result.faults if not f.piece and not len(f.faces) and f.text.startswith(lost))
        settled = _Settled(skin.seams, pieces, skin.sensors, taken_off)
        self._settled.append(settled)
        del self._settled[:-_MOST_SETTLED]
        self._desk.session.report("flatten", settled.said(skin))


def _warning(fault: Fault) -> Problem:
    return Problem(in_window(fault.text), "flatten", kind="warning", target=Target(piece=fault.piece))


def _asks_the_same(now: Skin, asked: Skin) -> bool:
    """Whether an automatic cut of one is one of the other."""
    return now.seams is asked.seams and now.marks is asked.marks and now.max_distortion == asked.max_distortion
