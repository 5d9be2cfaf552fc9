"""Painting where seams are wanted and where not."""

from __future__ import annotations

from gui.desk import Desk
from gui.tools.tool import AnyHit, Tool
from skinfab.mesh.brush import faces_within
from skinfab.seams import edit

#: The brush's radius as a part of the object's longest side: a twentieth covers a finger's front in a few strokes.
_BRUSH = 0.05


_WORDS = {
    1: ("attract", "Attract", "a", "Drag over the object where seams should run."),
    -1: ("avoid", "Avoid", "v", "Drag over the object where seams should not run."),
    0: ("neutral", "Rub out", "e", "Drag over the object to take the paint off."),
}


class Paint(Tool):
    """A brush for one preference; Shift+click rubs out.

    Parameters
    ----------
    desk : Desk
    value : 1, -1 or 0
        Attract, avoid, or neither.
    """

    def __init__(self, desk: Desk, value: int) -> None:
        self._desk, self._value = desk, value
        self.id, self.label, self.key, self.tip = _WORDS[value]
        self._stroke: object = None

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        self._dab(hit, 0 if shift else self._value)
        self.release()

    def drag(self, hit: AnyHit) -> bool:
        self._dab(hit, self._value)
        return True

    def release(self) -> None:
        self._stroke = None

    def _dab(self, hit: AnyHit, value: int) -> None:
        if hit.face < 0:
            return
        skin = self._desk.skin
        if self._desk.session.shading != "preferences":
            self._desk.session.shade("preferences")
        if self._stroke is None:
            self._stroke = object()
        low, high = skin.object.bbox
        covered = faces_within(skin.object, hit.face, hit.point, _BRUSH * float((high - low).max()))
        painted = edit.paint(skin, covered, value)
        if painted is not skin:
            self._desk.session.do("paint", painted, merge=self._stroke)
