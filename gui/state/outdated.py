"""Lines of the problems list about a sensor or a piece that is no longer what it was: nobody else takes them away before the next run."""

from __future__ import annotations

import re

from gui.state.problem import Problem
from gui.state.session import Session
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin

#: Who says things of one moment; the others look again by themselves at every change.
OF_A_MOMENT = ("export", "arrange")

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*")
#: Of a piece that is named beside one of these, it counts which sensors lie on it, and how.
_OF_ITS_SENSORS = re.compile(r"\bsensors?\b|\broom\b|\.gcode\b")


class Outdated:
    """Takes lines away once what they name has changed or gone.

    Parameters
    ----------
    session : Session
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        #: Each line, and the document that it was said of.
        self._said: dict[Problem, Skin] = {}
        session.listen("problems", self._learn)
        session.listen("file", self._learn)  # of another document nothing was said yet
        session.listen("skin", self._look)

    def _learn(self) -> None:
        skin = self._session.skin
        lines = [p for p in self._session.problems if p.source in OF_A_MOMENT]
        self._said = {} if skin is None else {p: self._said.get(p, skin) for p in lines}

    def _look(self) -> None:
        now = self._session.skin
        if now is None or not self._said:
            return
        kept = [p for p, then in self._said.items() if holds(p.text, then, now)]
        if len(kept) < len(self._said):
            for source in OF_A_MOMENT:
                self._session.report(source, [p for p in kept if p.source == source])


def holds(text: str, then: Skin, now: Skin) -> bool:
    """Whether all sensors and pieces that a sentence about `then` names are the same in `now`."""
    if then is now:
        return True
    named = set(_NAME.findall(text))
    sensors = {s.id: s for s in now.sensors}
    if any(s.id in named and s != sensors.get(s.id) for s in then.sensors):
        return False
    pieces, crowded = {p.id: p for p in now.pieces}, _OF_ITS_SENSORS.search(text) is not None
    return all(
        piece is pieces.get(piece.id) and not (crowded and _on(then, piece.id) != _on(now, piece.id))
        for piece in then.pieces
        if piece.id in named
    )


def _on(skin: Skin, piece: str) -> tuple[Sensor, ...]:
    return tuple(s for s in skin.sensors if s.piece == piece)
