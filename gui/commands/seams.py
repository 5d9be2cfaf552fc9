"""Cut by itself, and keep the flat pieces in step with the seams."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.adopt import adopt
from gui.state.lifted import counted, taken_off
from gui.state.problem import Problem
from gui.state.selection import Target
from gui.state.wording import in_window
from skinfab.flatten.methods import METHODS
from skinfab.pieces import Piece
from skinfab.seams.auto import Aim
from skinfab.seams.partial import Fault, Reopened
from skinfab.skin import Skin

#: What an automatic cut can be for, and how the menu says it.
AIMS: dict[Aim, str] = {
    "fewest": "fewest pieces, little seam",
    "usual": "usual pieces, well within the bound",
    "simplest": "simplest pieces, no darts",
}

#: Seams that are known to fit their pieces; as many as there are steps to undo, and some.
_MOST_SETTLED = 400


@dataclass(frozen=True, eq=False)
class _Settled:
    """Seams whose pieces are known, (k, 2) int64, these pieces, and what there is to say of them."""

    seams: NDArray[np.int64]
    pieces: tuple[ref[Piece], ...]  # those of a document that is no more need not be kept for this
    said: tuple[Problem, ...]


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
        self._took_off = -1  # the step that took sensors off last
        self.method = "auto"
        self.cones: int | None = None
        self.aim: Aim = "usual"
        self._ticked: dict[str, tk.StringVar] = {}  # a variable that nothing holds is unset, and its tick is gone
        desk.session.listen("skin", self._follow)

    def actions(self) -> list[Action]:
        """For the table."""
        has = self._desk.has_skin
        return [
            Action("auto_cut", "Cut automatically", "Seams", self.auto_cut, "F5", has, "Few good pieces; locked seams stay.", True),
            Action("flatten", "Flatten all pieces anew", "Seams", self.flatten_anew, "F6", self.can_flatten),
            Action("clear_seams", "Glue all seams that are not locked", "Seams", self.clear, "", has),
            Action("clear_marks", "Forget locks, bans and paint", "Seams", self.clear_marks, "", self._has_marks),
        ]

    def auto_cut(self) -> None:
        """Automatic seams in place of those that are not locked."""
        asked = self._desk.skin
        self._desk.work(
            "cutting and flattening",
            tasks.auto_cut,
            self._take(asked, "cut automatically" if self.aim == "usual" else f"cut into {self.aim} pieces"),
            source="flatten",
            wanted=lambda: self._fits(asked, over_sensors=True),
            skin=asked,
            aim=self.aim,
        )

    def fill_aims(self, menu: tk.Menu) -> None:
        """One entry a kind of automatic cut; the one in use is ticked."""
        chosen = self._ticked["aim"] = tk.StringVar(menu, value=self.aim)
        for name, says in AIMS.items():
            menu.add_radiobutton(label=says, value=name, variable=chosen, command=partial(self.choose_aim, name))

    def choose_aim(self, aim: Aim) -> None:
        """Cut for something else from now on, and at once."""
        if not self._desk.settle():
            return
        self.aim = aim
        if self._desk.has_skin():
            self.auto_cut()

    def flatten_anew(self) -> None:
        """All pieces, by the method that is chosen."""
        asked = self._desk.skin
        ids = [p.id for p in asked.pieces]
        self._desk.work(
            "flattening",
            tasks.reopen,
            self._take(asked, f"flatten ({self.method})"),
            source="flatten",
            wanted=lambda: self._fits(asked),
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
            self._settle(result.skin, result)
            self._desk.session.do(f"skin {thickness:g} mm thick", result.skin)
            self._tell_of_pieces()
            self._tell_of_sensors(asked, result)

        self._desk.work(
            f"flattening for {thickness:g} mm",
            tasks.make_thick,
            take,
            source="flatten",
            wanted=lambda: self._fits(asked),
            skin=asked,
            thickness=thickness,
            method=self.method,
        )

    def _cones(self) -> int | None:
        return self.cones if self.method == "bff-cones" else None

    def _has_marks(self) -> bool:
        return self._desk.session.skin is not None and self._desk.skin.marks is not None

    def fill_methods(self, menu: tk.Menu) -> None:
        """One entry a method of flattening; the one in use is ticked."""
        chosen = self._ticked["method"] = tk.StringVar(menu, value=self.method)
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

    def can_flatten(self) -> bool:
        """There are seams, or pieces already."""
        skin = self._desk.session.skin
        return skin is not None and (bool(skin.pieces) or len(skin.seams) > 0)

    def _follow(self) -> None:
        """Open the object along its seams as they are now, unless the pieces are those already."""
        skin = self._desk.session.skin
        for source in ("seams", "add"):  # answers to one click, which the next step leaves behind
            self._desk.session.report(source, [])
        self._list_lifted()
        if skin is None:
            return
        if self._known(skin) is not None:
            self._tell_of_pieces()  # after undo, what was said then
            self._behind = False
            job = self._desk.runner.job
            if job is not None and job.own:  # for seams that are no more
                self._desk.runner.cancel()
            return
        asked: dict[str, Any] = {
            "skin": skin,
            "method": self.method,
            "cones": self._cones(),
            "anew": [],
        }
        self._behind = True
        self._desk.work("flattening", tasks.reopen, self._take(skin, ""), source="flatten", failed=self.give_up, own=True, **asked)

    def _fits(self, asked: Skin, *, over_sensors: bool = False) -> bool:
        """Whether what is made of `asked` could be taken; over a change of sensors alone, only the seams are."""
        session, now = self._desk.session, self._desk.session.skin
        if now is asked:
            return True
        return now is not None and over_sensors and now.mesh is asked.mesh and session.redo_label is None and _asks_the_same(now, asked)

    def _take(self, asked: Skin, label: str) -> Callable[[Reopened], None]:
        """What to do with the result for `asked`: a step of that name, or what completes the last step."""

        def take(result: Reopened) -> None:
            self._behind = False
            session, now = self._desk.session, self._desk.skin
            skin = adopt(asked, result.skin)
            if now is not asked:
                if label:
                    session.do(label, replace(now, seams=skin.seams))
                else:
                    self._follow()
                return
            self._settle(skin, result)
            # What is said of the pieces is said once they are there, so that it counts as of this step.
            if label:
                session.do(label, skin)
            elif skin.pieces != asked.pieces or skin.seams is not asked.seams or skin.lifted is not asked.lifted:
                session.amend(skin)
            self._tell_of_pieces()
            self._tell_of_sensors(asked, result)

        return take

    def _settle(self, skin: Skin, result: Reopened) -> None:
        """The pieces of `skin` are those of its seams, and this is what there is to say of them."""
        # Whether the sensors that are there fit is said by the check of all sensors, at every move; which are not, by `_list_lifted`.
        settled = _Settled(skin.seams, tuple(map(ref, skin.pieces)), tuple(_warning(f) for f in result.faults if f.piece or len(f.faces)))
        self._settled.append(settled)
        del self._settled[:-_MOST_SETTLED]

    def _tell_of_pieces(self) -> None:
        """What was said of the pieces of the seams as they are now, if these are known."""
        settled = self._known(self._desk.skin)
        if settled is not None:
            self._desk.session.report("flatten", settled.said)

    def _known(self, skin: Skin) -> _Settled | None:
        """What is known of its seams: of just these pieces, else, where they were flattened anew since, of the last."""
        same = [settled for settled in self._settled if settled.seams is skin.seams]
        return next((settled for settled in same if [piece() for piece in settled.pieces] == list(skin.pieces)), same[-1] if same else None)

    def _tell_of_sensors(self, asked: Skin, result: Reopened) -> None:
        """At once, which sensors came back and which were taken off by this step."""
        said = [f"{note}." for note in result.notes]
        if result.lost and asked.sensors:
            self._took_off = self._desk.session.step
            self._list_lifted()
            lost = {sensor.id for sensor in result.lost}
            said += [p.text + "." for p in taken_off([e for e in result.skin.lifted if e.sensor.id in lost], by_last_step=True)]
        back: dict[str, list[str]] = {}
        for sensor in result.back:
            back.setdefault(sensor.piece, []).append(sensor.id)
        said += [f"{counted(ids)} {'is' if len(ids) == 1 else 'are'} back on {piece}." for piece, ids in back.items()]
        if said:
            self._desk.say(" ".join(said))

    def _list_lifted(self) -> None:
        session = self._desk.session
        if session.step == 0:  # another document counts its steps anew
            self._took_off = -1
        session.report("lifted", taken_off(session.lifted, by_last_step=session.step == self._took_off))


def _warning(fault: Fault) -> Problem:
    return Problem(in_window(fault.text), "flatten", kind="warning", target=Target(piece=fault.piece))


def _asks_the_same(now: Skin, asked: Skin) -> bool:
    """Whether an automatic cut of one is one of the other."""
    return now.seams is asked.seams and now.marks is asked.marks and now.max_distortion == asked.max_distortion
