"""What is done to several selected sensors: copy, mirror, align, spread."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from gui.actions import Action
from gui.desk import Desk
from gui.jobs import tasks
from gui.state.selection import Target
from skinfab.placement import arrange
from skinfab.placement.edit import Sensors

_ALIGN: tuple[tuple[arrange.Side, str], ...] = (
    ("left", "Align left"),
    ("right", "Align right"),
    ("top", "Align top"),
    ("bottom", "Align bottom"),
    ("middle-x", "Align middles above each other"),
    ("middle-y", "Align middles beside each other"),
)
_MIRROR: tuple[tuple[arrange.Axis, str], ...] = (("x", "left and right"), ("y", "up and down"))
_SPREAD: tuple[tuple[arrange.Axis, str], ...] = (("x", "across"), ("y", "up"))


class ArrangeCommands:
    """Part of the Sensors menu."""

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def actions(self) -> list[Action]:
        """For the table."""
        tip = "The first selected sensor stays; select more with Ctrl+click or a rectangle on the flat skin."
        return [
            Action("copy", "Copy the sensors beside themselves", "Sensors", self.copy, "Control-Shift-C", self._some),
            *(Action(f"mirror_{axis}", f"Mirror {words}", "Sensors", self._mirror(axis), "", self._some) for axis, words in _MIRROR),
            *(Action(f"align_{side}".replace("-", "_"), words, "Sensors", self._align(side), "", self._two, tip) for side, words in _ALIGN),
            *(
                Action(f"spread_{axis}", f"Spread evenly {words}", "Sensors", self._spread(axis), "", self._three)
                for axis, words in _SPREAD
            ),
        ]

    def copy(self) -> None:
        """Copies lie where there is room for them, and are selected."""
        chosen, asked = self._chosen(), self._desk.skin

        def take(copied: tuple[Sensors, tuple[str, ...]]) -> None:
            sensors, new = copied
            self._desk.session.do(f"copy {', '.join(chosen)}", replace(asked, sensors=sensors))
            piece = next(s.piece for s in sensors if s.id == new[0])
            self._desk.session.select(Target(piece=piece, sensor=new[0], also=new[1:]))

        def wanted() -> bool:
            return self._desk.session.skin is asked

        self._desk.work("looking for room", tasks.copy_beside, take, source="arrange", wanted=wanted, skin=asked, ids=chosen)

    def _mirror(self, axis: arrange.Axis) -> Callable[[], None]:
        return lambda: self._change("mirror", lambda sensors, ids: arrange.mirror(sensors, ids, axis=axis))

    def _align(self, side: arrange.Side) -> Callable[[], None]:
        return lambda: self._change("align", lambda sensors, ids: arrange.align(sensors, ids, side=side))

    def _spread(self, axis: arrange.Axis) -> Callable[[], None]:
        return lambda: self._change("spread", lambda sensors, ids: arrange.distribute(sensors, ids, axis=axis))

    def _change(self, verb: str, change: Callable[[Sensors, list[str]], Sensors]) -> None:
        chosen = self._chosen()

        def work() -> None:
            skin = self._desk.skin
            sensors = change(skin.sensors, chosen)
            self._desk.session.report("arrange", [])
            if sensors != skin.sensors:
                self._desk.session.do(f"{verb} {', '.join(chosen)}", replace(skin, sensors=sensors))

        self._desk.guarded("arrange", work)

    def _chosen(self) -> list[str]:
        skin, target = self._desk.session.skin, self._desk.session.selected
        there = set() if skin is None else {s.id for s in skin.sensors}
        return [id for id in (target.sensor, *target.also) if id in there]

    def _some(self) -> bool:
        return len(self._chosen()) >= 1

    def _two(self) -> bool:
        return len(self._chosen()) >= 2

    def _three(self) -> bool:
        return len(self._chosen()) >= 3
