"""Whether sensors fit, at every move: which do not, and how that is said."""

from __future__ import annotations

from collections.abc import Iterable

from gcode.used import used_by, with_room_for_nozzle
from gui.state.derived import Part
from gui.state.problem import Problem
from gui.state.selection import Target
from skinfab.errors import SkinfabError
from skinfab.placement.check import Checker, Finding
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin

Findings = dict[str, tuple[Finding, ...]]


class Live:
    """Keeps what checks have in common from one move to the next.

    Attributes
    ----------
    findings : dict of str to tuple of Finding
        Of every sensor of the document, as `look` found them; sensors without are left out.
    """

    def __init__(self) -> None:
        self.findings: Findings = {}
        self._names: tuple[str, str] | None = None
        self._checker: Checker | None = None
        self._fault = ""
        self._seen: tuple[object, ...] = ()

    def look(self, skin: Skin) -> bool:
        """Check all sensors of a document; whether there was anything new to check."""
        now = (skin.pieces, skin.sensors, skin.material, skin.printer)
        if len(now) == len(self._seen) and all(a is b for a, b in zip(now, self._seen, strict=True)):
            return False
        self._seen = now
        self.findings = self.check(skin, skin.sensors, skin.sensors)
        return True

    def check(self, skin: Skin, sensors: Iterable[Sensor], others: Iterable[Sensor]) -> Findings:
        """What is wrong with some sensors beside others."""
        checker = self._for(skin)
        if checker is None:
            return {}
        pieces, others, found = {p.id: p for p in skin.pieces}, tuple(others), {}
        for sensor in sensors:
            if sensor.piece in pieces:
                each = tuple(checker.faults(pieces[sensor.piece], sensor, others))
            else:
                each = (Finding(f"{sensor.id} is on piece {sensor.piece}, which does not exist", float("inf"), sensor.id),)
            if each:
                found[sensor.id] = each
        return found

    def prepare(self, skin: Skin, piece: str) -> None:
        """Before a drag: what its first move would otherwise wait for."""
        checker = self._for(skin)
        if checker is not None and any(p.id == piece for p in skin.pieces):
            checker.prepare(skin.piece(piece))

    def parts(self, skin: Skin) -> Iterable[Part]:
        """What a first check of each piece would wait for."""
        for piece in {s.piece: p for s in skin.sensors for p in skin.pieces if p.id == s.piece}.values():
            yield Part("checked", (piece, skin.printer, skin.material), len(piece.F), lambda id=piece.id: self.prepare(skin, id))  # type: ignore[misc]

    def problems(self, skin: Skin) -> list[Problem]:
        """The findings as lines of the problems list; of two sensors too close to each other once."""
        if self._fault:
            return [Problem(self._fault, "sensors")]
        lines, said = [], set()
        piece = {s.id: s.piece for s in skin.sensors}
        for id, found in self.findings.items():
            for each in found:
                pair = frozenset((id, each.other))
                if each.other and pair in said:
                    continue
                said.add(pair)
                lines.append(Problem(f"{each.text}; move, turn or shrink it", "sensors", target=Target(piece=piece.get(id, ""), sensor=id)))
        return lines

    def _for(self, skin: Skin) -> Checker | None:
        names = skin.printer, skin.material
        if names != self._names:
            self._names, self._checker, self._fault = names, None, ""
            try:
                used = used_by(skin)
                # The same room as `skinfab place` keeps: what fits here can be printed.
                self._checker = Checker(with_room_for_nozzle(used.material, used.printer)[0])
            except SkinfabError as fault:
                self._fault = str(fault)
        return self._checker


def words(found: Iterable[Finding]) -> list[str]:
    """The worst first, without the sensor's name: they stand beside it."""
    return [each.brief or each.text for each in sorted(found, key=lambda f: -f.amount)]
