"""Whether sensors fit: on their piece, off its edges, off one another. Exact; findings are in words."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.locate import Locator
from skinfab.material import Ink, Material
from skinfab.patterns.base import Pattern, PatternError
from skinfab.pieces import Piece
from skinfab.placement.distance import Curves, distance, distance_within, self_distance
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import CLEARANCE_MM, PARAMETER_ROUNDING_MM, PREVIEW_CHORD_MM

if TYPE_CHECKING:
    from shapely import STRtree

#: How many findings a refusal names.
_NAMED = 5
#: Patterns whose lines are kept at hand.
_KEPT_SHAPES = 256
#: Of so many points in a row the first is asked how far outside it lies.
_FELLOWS = 8


class PlacedSensors(Protocol):
    """What `validate` looks at: a skin document, or anything with its pieces and sensors."""

    @property
    def pieces(self) -> tuple[Piece, ...]: ...
    @property
    def sensors(self) -> tuple[Sensor, ...]: ...


@dataclass(frozen=True)
class Finding:
    """Something wrong with a sensor.

    Parameters
    ----------
    text : str
        "C1 is 0.6 mm outside piece P2".
    amount : float, mm
        By how much; infinite for what is wrong altogether.
    sensor : str
        Id of the sensor to be moved; "" where moving does not help.
    other : str
        Id of the sensor that is too close; "" where it is none.
    brief : str
        "0.6 mm outside P2": the same for the eye that looks at the sensor.
    """

    text: str
    amount: float
    sensor: str = ""
    other: str = ""
    brief: str = ""


def edge_curves(piece: Piece) -> Curves:
    """The piece's boundary: outline, holes and both sides of every dart, closed or open."""
    ends = piece.topology.E[piece.topology.is_boundary]
    return Curves.of_edges(piece.UV[ends])


def check_sensor(piece: Piece, sensor: Sensor, others: Iterable[Sensor], *, material: Material) -> list[str]:
    """What is wrong with a sensor, in words; empty where all is well.

    Parameters
    ----------
    piece : Piece
        The one that the sensor names.
    sensor : Sensor
    others : iterable of Sensor
        Of the whole skin; those on other pieces and the sensor itself are passed over.
    material : Material
        For its `margin` (bead edge to piece edge) and `gap` (bead edge to bead edge).
    """
    return [f.text for f in find_faults(piece, sensor, others, material=material)]


def find_faults(piece: Piece, sensor: Sensor, others: Iterable[Sensor], *, material: Material) -> list[Finding]:
    """As `check_sensor`, with amounts."""
    return Checker(material).faults(piece, sensor, others)


class Checker:
    """Checks many sensors, or one at many places: what they have in common is computed once.

    It keeps the edges and triangles of the pieces it has met, the lines of their sensors and each pattern's
    clearance to itself, so that a sensor that is dragged is checked between two pictures.

    Parameters
    ----------
    material : Material
        For its `margin` and `gap`.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> from skinfab.patterns.registry import make_pattern
    >>> UV = np.array([[0.0, 0], [60, 0], [60, 60], [0, 60]])
    >>> piece = Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), UV)
    >>> checker, spiral = Checker(load_material()), make_pattern("contact-spiral", {"s": 20})
    >>> [checker.faults(piece, Sensor("C1", "P1", spiral, x, 30.0, 0.0, 0), ()) for x in (20.0, 25.0)]
    [[], []]
    >>> checker.faults(piece, Sensor("C1", "P1", spiral, 55.0, 30.0, 0.0, 0), ())[0].brief
    '19.2 mm outside P1'
    """

    def __init__(self, material: Material) -> None:
        self.material = material
        self._grounds: dict[str, _Ground] = {}
        self._own: dict[Pattern, float] = {}
        self._shapes: dict[Pattern, _Shape] = {}
        self._lines: dict[str, tuple[Sensor, Curves]] = {}

    def faults(self, piece: Piece, sensor: Sensor, others: Iterable[Sensor]) -> list[Finding]:
        """What is wrong with `sensor` on `piece`; of the `others` those on other pieces and itself are passed over."""
        found = self._misfits(piece, sensor, others)
        need = self.material.gap + sensor.pattern.bead
        if sensor.pattern not in self._own:
            self._own[sensor.pattern] = own_clearance(sensor, need=need)
        lack = need - self._own[sensor.pattern]
        if lack > CLEARANCE_MM:
            found.append(_too_close(sensor, lack, "itself"))
        return found

    def prepare(self, piece: Piece) -> None:
        """Compute now what the first question about a piece would otherwise wait for."""
        known = self._grounds.get(piece.id)
        if known is None or known.piece is not piece:
            self._grounds[piece.id] = _Ground(piece)

    def _misfits(self, piece: Piece, sensor: Sensor, others: Iterable[Sensor]) -> list[Finding]:
        """What is wrong with where a sensor lies."""
        self.prepare(piece)
        curves = self._curves(sensor)
        found = list(self._containment(self._grounds[piece.id], sensor, curves))
        for other in others:
            if other.piece != piece.id or other.id == sensor.id:
                continue
            need = self.material.gap + (sensor.pattern.bead + other.pattern.bead) / 2
            apart = distance_within(curves, self._curves(other), need)
            lack = need - apart
            if lack > CLEARANCE_MM:
                on_top = apart < (sensor.pattern.bead + other.pattern.bead) / 2 - CLEARANCE_MM
                found.append(_overlap(sensor, lack, other.id) if on_top else _too_close(sensor, lack, other.id))
        return found

    def _containment(self, ground: _Ground, sensor: Sensor, curves: Curves) -> Iterable[Finding]:
        piece, bead, margin = ground.piece, sensor.pattern.bead, self.material.margin
        apart = distance_within(curves, ground.edges, bead / 2 + margin)
        # A path that meets no edge is inside or outside as a whole: one point decides.
        inside = ground.locator.faces(curves.p0[:1])[0] >= 0
        lack = bead / 2 + margin - apart
        if inside and lack <= CLEARANCE_MM:
            return
        if inside and apart >= bead / 2:
            brief = f"{_mm(lack)} mm too close to the edge of "
            where = f"{brief}piece {piece.id}"
            digits = 2 if lack >= 0.01 else 4  # 0.996 is not to read 1.00
            text = f"{sensor.id} is {where} ({apart - bead / 2:.{digits}f} mm from bead to edge, {margin:g} mm is the margin)"
            yield Finding(text, lack, sensor.id, brief=brief + piece.id)
            return
        beyond = ground.overhang(self._shape(sensor.pattern).points_at(sensor))
        outside = (beyond if beyond > 0 else -apart) + bead / 2
        if beyond > 0 or apart > CLEARANCE_MM:
            spans = " x ".join(f"{_short(low)} to {_short(high)}" for low, high in zip(*ground.box, strict=True))
            text = f"{sensor.id} is {_mm(outside)} mm outside piece {piece.id}, which spans {spans} mm"
            yield Finding(text, outside, sensor.id, brief=f"{_mm(outside)} mm outside {piece.id}")
        else:
            # Both sides of the edge are piece: a closed dart, or a fold of no width.
            brief = f"crosses an edge of {piece.id}"
            text = f"{sensor.id} crosses an edge of piece {piece.id} (a dart or a slit)"
            yield Finding(text, bead / 2 + margin, sensor.id, brief=brief)

    def _shape(self, pattern: Pattern) -> _Shape:
        if pattern not in self._shapes:
            # The parameters of a pattern may be changed a thousand times in one sitting.
            while len(self._shapes) >= _KEPT_SHAPES:
                del self._shapes[next(iter(self._shapes))]
            self._shapes[pattern] = _Shape(pattern)
        return self._shapes[pattern]

    def _curves(self, sensor: Sensor) -> Curves:
        known = self._lines.get(sensor.id)
        if known is None or known[0] is not sensor:
            known = sensor, self._shape(sensor.pattern).curves.moved(angle=sensor.angle, shift=(sensor.x, sensor.y))
            self._lines[sensor.id] = known
        return known[1]


class _Shape:
    """A pattern in its own frame, ready to be put anywhere."""

    def __init__(self, pattern: Pattern) -> None:
        self._path = pattern.printed_path()
        self.curves = Curves.of_segments(self._path.segments)

    @cached_property
    def _points(self) -> NDArray[np.float64]:
        """Points along it, for words only: an overhang is sampled."""
        count = max(int(self._path.length / 0.5), 1)
        return np.vstack([self._path.to_polyline(tolerance=PREVIEW_CHORD_MM), self._path.point_at(np.linspace(0, 1, count + 1))])

    def points_at(self, sensor: Sensor) -> NDArray[np.float64]:
        """(k, 2) mm in the piece frame."""
        c, s = np.cos(sensor.angle), np.sin(sensor.angle)
        points: NDArray[np.float64] = self._points @ np.array([[c, s], [-s, c]]) + (sensor.x, sensor.y)
        return points


class _Ground:
    """A piece's edges and triangles, ready for many questions."""

    def __init__(self, piece: Piece) -> None:
        self.piece = piece
        self.edges = edge_curves(piece)
        self.locator = Locator(piece.UV, piece.F)
        self.box = piece.UV.min(axis=0), piece.UV.max(axis=0)

    @cached_property
    def _walls(self) -> STRtree:
        import shapely

        return shapely.STRtree([shapely.LineString(ends) for ends in zip(self.edges.p0, self.edges.p1, strict=True)])

    def overhang(self, points: NDArray[np.float64]) -> float:
        """How far the farthest of the points, in the order of the line, lies outside, mm; 0 where none does."""
        # Most of a long overhang is beyond the box, which is cheaper to see.
        out = ((points < self.box[0]) | (points > self.box[1])).any(axis=1)
        rest = np.flatnonzero(~out)
        out[rest[self.locator.faces(points[rest]) < 0]] = True
        if not out.any():
            return 0.0
        far = points[out]
        # No point is farther than its fellow by more than they are apart: most need not be asked for.
        fellow = np.arange(len(far)) // _FELLOWS * _FELLOWS
        apart = self._apart(far[::_FELLOWS])
        best = float(apart.max())
        most = apart[fellow // _FELLOWS] + np.hypot(*(far - far[fellow]).T)
        rest = np.flatnonzero(most > best)
        return max(best, float(self._apart(far[rest]).max(initial=0.0)))

    def _apart(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """From the nearest edge, mm."""
        import shapely

        return np.asarray(self._walls.query_nearest(shapely.points(points), return_distance=True, all_matches=False)[1])


def _too_close(sensor: Sensor, lack: float, other: str) -> Finding:
    brief = f"{_mm(lack)} mm too close to {other}"
    return Finding(f"{sensor.id} is {brief}", lack, sensor.id, "" if other == "itself" else other, brief)


def _overlap(sensor: Sensor, lack: float, other: str) -> Finding:
    """Their beads run into each other: how much too close they are would say nothing of how far to move them."""
    return Finding(f"{sensor.id} overlaps {other}", lack, sensor.id, other, f"overlaps {other}")


def own_clearance(sensor: Sensor, *, need: float) -> float:
    """Least distance of a sensor's centre line to itself, mm: turns to turns, pads to turns, pad to pad.

    A pad's own rows are meant to touch, and a pad meets its own lead.
    """
    path, printed = sensor.path.segments, sensor.printed_path.segments
    # The tightest half-circle that keeps `need` across is pi/2 need long; a square corner into a turn that curls
    # back, as at a spiral's links, needs a little more before its two sides are that far apart.
    least = self_distance(sensor.path, apart=2 * need)
    pad = (len(printed) - len(path)) // 2
    if pad:
        first, last = Curves.of_segments(printed[:pad]), Curves.of_segments(printed[-pad:])
        least = min(least, distance(first, last))
        if len(path) > 1:
            least = min(least, distance(first, Curves.of_segments(path[1:])), distance(last, Curves.of_segments(path[:-1])))
    return least


def validate(skin: PlacedSensors, material: Material) -> None:
    """Check every sensor of a skin.

    Raises
    ------
    RefusedError
        Something is wrong; the worst of it is named.
    InputError
        A sensor's bead is narrower than the one that is printed.
    """
    for sensor in skin.sensors:
        try:
            refuse_narrow_bead(sensor.pattern, material.ink)
        except PatternError as fault:
            raise InputError(f"{sensor.id}: {fault}") from fault
    found: list[Finding] = []
    checker = Checker(material)
    pieces = {p.id: p for p in skin.pieces}
    for what, used in (("id", Counter(s.id for s in skin.sensors)), ("channel", Counter(str(s.channel) for s in skin.sensors))):
        found += [Finding(f"{what} {value} is used by more than one sensor", math.inf) for value, n in used.items() if n > 1]
    for k, sensor in enumerate(skin.sensors):
        if sensor.piece not in pieces:
            there = ", ".join(pieces)
            found.append(Finding(f"{sensor.id} is on piece {sensor.piece}, which does not exist; there are {there}", math.inf))
            continue
        # Each pair of sensors once.
        found += checker.faults(pieces[sensor.piece], sensor, skin.sensors[:k])
    if found:
        raise RefusedError(describe(found))


def refuse_narrow_bead(pattern: Pattern, ink: Ink) -> None:
    """A pattern keeps its `bead` clear; what is printed is as wide as the ink's cross-section makes it.

    Raises
    ------
    PatternError
        That is wider.
    """
    if pattern.bead < ink.least_width - PARAMETER_ROUNDING_MM:
        why = f"it must be at least {ink.least_width:g}, as wide as the material's {ink.bead_area_mm2:g} mm^2 of ink is printed"
        raise PatternError(pattern.kind, "bead", pattern.bead, why, ink.least_width)


def describe(found: Sequence[Finding]) -> str:
    """One sentence that names the worst findings first and what to do."""
    worst = sorted(found, key=lambda f: -f.amount)
    rest = len(worst) - _NAMED
    more = f"; and {rest} more" if rest > 0 else ""
    movable = {f.sensor for f in found if f.sensor}
    advice = f"; move, turn or shrink {'it' if len(movable) == 1 else 'them'}" if movable else ""
    return "; ".join(f.text for f in worst[:_NAMED]) + more + advice


def _mm(amount: float) -> str:
    """One decimal; two where it would read 0.0 or hide what is wrong."""
    return f"{amount:.1f}" if amount >= 0.1 else f"{max(amount, 0.001):.3f}"


def _short(length: float) -> str:
    """At most one decimal: 12.5, 60, 0."""
    return f"{round(length, 1) + 0.0:g}"
