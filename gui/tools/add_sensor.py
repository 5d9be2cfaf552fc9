"""A click puts a new sensor there, of the pattern that is chosen."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from gui.desk import Desk
from gui.state.selection import Target
from gui.tools.tool import AnyHit, Tool
from skinfab.patterns.base import Pattern
from skinfab.placement.add import add_at


class AddSensor(Tool):
    """Puts the pattern's middle where the object or a flat piece is clicked.

    Parameters
    ----------
    desk : Desk
    pattern : callable
        The pattern that is chosen now; raises InputError where its parameters do not go together.
    """

    id, label, key = "add", "Sensor", "s"
    tip = "Click on a piece, flat or on the object: a sensor of the chosen pattern comes there."

    def __init__(self, desk: Desk, pattern: Callable[[], Pattern]) -> None:
        self._desk, self._pattern = desk, pattern

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        if hit.face < 0 or not hit.target.piece:
            self._desk.say("There is no flat piece there; cut the object until that part lies flat.")
            return
        self._desk.guarded("add", lambda: self._add(hit))

    def _add(self, hit: AnyHit) -> None:
        skin = self._desk.skin
        piece = skin.piece(hit.target.piece)
        (uv,) = self._desk.derived.flat_map(skin.mesh, piece).to_flat([hit.face], [hit.barycentric])
        sensors, new = add_at(skin.sensors, self._pattern(), piece.id, uv, reserved=[each.sensor for each in skin.lifted])
        self._desk.session.report("add", [])
        self._desk.session.do(f"add {new.id}", dataclasses.replace(skin, sensors=sensors))
        self._desk.session.select(Target(piece=piece.id, sensor=new.id))
