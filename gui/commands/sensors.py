"""Sensors by themselves, and a new one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.adopt import adopt
from gui.state.outdated import holds
from gui.state.selection import NOTHING
from skinfab.skin import Skin

_FILE_TIP = "Which sensors, and where, from a TOML file as skinfab place takes it (docs/sensors.md)."


class SensorCommands:
    """The Sensors menu."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        #: The document that there is something to say of, the step that made it, and that.
        self._said: tuple[Skin | None, int, tuple[str, ...]] = None, 0, ()
        desk.session.listen("skin", self._follow)

    def actions(self) -> list[Action]:
        """For the table."""
        tip = "Sensors where there is room: strain over the joints of a finger, contact elsewhere; those there are go."
        return [
            Action("auto_place", "Place automatically", "Sensors", self.place, "F7", self._desk.has_pieces, tip, True),
            Action("place_file", "Place as a file says …", "Sensors", self.place_from_file, "", self._desk.has_pieces, _FILE_TIP),
            Action("clear", "Remove all sensors", "Sensors", self.clear, "", self._desk.has_sensors),
        ]

    def place(self) -> None:
        """Automatic sensors in place of those there are."""
        self._place("place automatically", None)

    def place_from_file(self) -> None:
        """Those that a sensors file asks for, in place of those there are."""
        path = self._desk.dialogs.sensors_path()
        if path is not None:
            self._place(f"place as in {path.name}", path)

    def _place(self, label: str, file: Path | None) -> None:
        asked = self._desk.skin

        def take(result: tuple[Skin, tuple[str, ...]]) -> None:
            skin, warnings = result
            session = self._desk.session
            placed = replace(self._desk.skin, sensors=adopt(asked, skin).sensors, lifted=())
            session.do(label, placed)
            self._said = placed, session.step, warnings
            self._follow()

        def wanted() -> bool:
            """On the same pieces, whatever else was done to the skin; but what was undone can be redone."""
            session, now = self._desk.session, self._desk.session.skin
            return now is asked or (
                now is not None
                and now.mesh is asked.mesh
                and now.pieces == asked.pieces
                and now.seams is asked.seams
                and session.redo_label is None
            )

        self._desk.work("placing sensors", tasks.place_anew, take, source="place", wanted=wanted, skin=asked, file=file)

    def _follow(self) -> None:
        """What was said when sensors were placed goes where that is undone, and each line where what it names has changed."""
        now = self._desk.session.skin
        then, step, warnings = self._said
        if now is None or then is None or now.mesh is not then.mesh or self._desk.session.step < step:
            warnings = ()
        self._desk.note("place", [text for text in warnings if then and now and holds(text, then, now)], kind="warning")

    def clear(self) -> None:
        """Take all off."""
        self._desk.session.select(NOTHING)
        self._desk.session.do("remove all sensors", replace(self._desk.skin, sensors=(), lifted=()))
