"""Undo, redo, and what is done to the selected sensors."""

from __future__ import annotations

import math
from dataclasses import replace

from gui.actions import Action
from gui.desk import Desk
from gui.jobs.runner import Job
from gui.state.selection import NOTHING
from skinfab.placement import edit


class EditCommands:
    """The Edit menu."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        desk.session.listen("skin", self._stop_what_is_vain)

    def actions(self) -> list[Action]:
        """For the table."""
        session = self._desk.session
        return [
            Action(
                "undo", "Undo", "Edit", self.undo, "Control-z", lambda: session.undo_label is not None, "Take the last step back.", True
            ),
            Action("redo", "Redo", "Edit", self.redo, "Control-y", lambda: session.redo_label is not None, "Do it again after all.", True),
            Action("delete", "Delete the selected sensors", "Edit", self.delete, "Delete", self._any_selected),
            Action("turn_left", "Turn by 15°", "Edit", lambda: self.turn(15), "Control-r", self._any_selected),
            Action("turn_right", "Turn back by 15°", "Edit", lambda: self.turn(-15), "Control-Shift-R", self._any_selected),
            Action("select_none", "Select nothing", "Edit", lambda: session.select(NOTHING), "Control-Shift-A"),
        ]

    def undo(self) -> None:
        """Take the last step back, and say which it was."""
        stopped = self._desk.runner.job
        label = self._desk.session.undo()
        if label is not None:
            self._desk.say(f"Undone: {label}.{self._and_stopped(stopped)}")

    def redo(self) -> None:
        """Do the last undone step again, and say which it was."""
        stopped = self._desk.runner.job
        label = self._desk.session.redo()
        if label is not None:
            self._desk.say(f"Done again: {label}.{self._and_stopped(stopped)}")

    def _and_stopped(self, job: Job | None) -> str:
        """What went on before the step and does no more; what the window does by itself needs no word."""
        gone = job is not None and not job.own and job is not self._desk.runner.job
        return f" {job.label[:1].upper()}{job.label[1:]} was stopped." if job is not None and gone else ""

    def _stop_what_is_vain(self) -> None:
        """Work whose result could not be used any more must not keep other work waiting."""
        job = self._desk.runner.job
        if job is not None and job.wanted is not None and not job.wanted():
            self._desk.runner.cancel()
            self._desk.in_vain(job.label)

    def delete(self) -> None:
        """Take the selected sensors off."""
        skin, chosen = self._desk.skin, self._chosen()
        sensors = skin.sensors
        for id in chosen:
            sensors = edit.remove(sensors, id)
        self._desk.session.do(f"delete {_named(chosen)}", replace(skin, sensors=sensors))

    def turn(self, degrees: float) -> None:
        """Turn each selected sensor about its middle."""
        skin, chosen = self._desk.skin, self._chosen()
        sensors = skin.sensors
        for id in chosen:
            sensors = edit.rotate(sensors, id, angle=math.radians(degrees))
        self._desk.session.do(f"turn {_named(chosen)}", replace(skin, sensors=sensors))

    def _chosen(self) -> list[str]:
        """The selected sensors that are still there."""
        selected, there = self._desk.session.selected, {s.id for s in self._desk.skin.sensors}
        return [id for id in (selected.sensor, *selected.also) if id in there]

    def _any_selected(self) -> bool:
        return self._desk.session.skin is not None and bool(self._chosen())


def _named(ids: list[str]) -> str:
    return ids[0] if len(ids) == 1 else f"{len(ids)} sensors"
