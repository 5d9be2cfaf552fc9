"""Whether sensors fit: on their piece, off its edges, off one another. Exact; findings are in words."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.locate import Locator
from skinfab.material import Ink, Material
from skinfab.paths import Path
from skinfab.patterns.base import Pattern, PatternError
from skinfab.pieces import Piece
from skinfab.placement.distance import Curves, distance, self_distance
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import CLEARANCE_MM, PARAMETER_ROUNDING_MM, PREVIEW_CHORD_MM

#: How many findings a refusal names.
_NAMED = 5


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
    """

    text: str
    amount: float
    sensor: str = ""


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
    return _Checker(material).faults(piece, sensor, others)


class _Checker:
    """Keeps what many sensors have in common: a piece's edges and triangles, a pattern's clearance to itself."""

    def __init__(self, material: Material) -> None:
        self._material = material
        self._pieces: dict[str, tuple[Curves, Locator]] = {}
        self._own: dict[Pattern, float] = {}

    def faults(self, piece: Piece, sensor: Sensor, others: Iterable[Sensor]) -> list[Finding]:
        if piece.id not in self._pieces:
            self._pieces[piece.id] = edge_curves(piece), Locator(piece.UV, piece.F)
        edges, locator = self._pieces[piece.id]
        found = self._misfits(piece, sensor, others, edges=edges, locator=locator)
        need = self._material.gap + sensor.pattern.bead
        if sensor.pattern not in self._own:
            self._own[sensor.pattern] = own_clearance(sensor, need=need)
        lack = need - self._own[sensor.pattern]
        if lack > CLEARANCE_MM:
            found.append(Finding(f"{sensor.id} is {_mm(lack)} mm too close to itself", lack, sensor.id))
        return found

    def _misfits(self, piece: Piece, sensor: Sensor, others: Iterable[Sensor], *, edges: Curves, locator: Locator) -> list[Finding]:
        """What is wrong with where a sensor lies."""
        curves = Curves.of_segments(sensor.printed_path.segments)
        bead = sensor.pattern.bead
        found = list(_containment(piece, sensor, curves, edges, self._material.margin, locator))
        for other in others:
            if other.piece != piece.id or other.id == sensor.id:
                continue
            need = self._material.gap + (bead + other.pattern.bead) / 2
            lack = need - distance(curves, Curves.of_segments(other.printed_path.segments))
            if lack > CLEARANCE_MM:
                found.append(Finding(f"{sensor.id} is {_mm(lack)} mm too close to {other.id}", lack, sensor.id))
        return found


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
    checker = _Checker(material)
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


def _containment(piece: Piece, sensor: Sensor, curves: Curves, edges: Curves, margin: float, locator: Locator) -> Iterable[Finding]:
    bead = sensor.pattern.bead
    apart = distance(curves, edges)
    # A path that meets no edge is inside or outside as a whole: one point decides.
    inside = locator.faces([sensor.printed_path.start])[0] >= 0
    lack = bead / 2 + margin - apart
    if inside and lack <= CLEARANCE_MM:
        return
    if inside and apart >= bead / 2:
        where = f"{_mm(lack)} mm too close to the edge of piece {piece.id}"
        yield Finding(f"{sensor.id} is {where} ({apart - bead / 2:.2f} mm from bead to edge, {margin:g} mm is the margin)", lack, sensor.id)
        return
    beyond = _overhang(sensor.printed_path, edges, locator)
    outside = (beyond if beyond > 0 else -apart) + bead / 2
    if beyond > 0 or apart > CLEARANCE_MM:
        spans = " x ".join(f"{_short(low)} to {_short(high)}" for low, high in zip(piece.UV.min(axis=0), piece.UV.max(axis=0), strict=True))
        yield Finding(f"{sensor.id} is {_mm(outside)} mm outside piece {piece.id}, which spans {spans} mm", outside, sensor.id)
    else:
        # Both sides of the edge are piece: a closed dart, or a fold of no width.
        yield Finding(f"{sensor.id} crosses an edge of piece {piece.id} (a dart or a slit)", bead / 2 + margin, sensor.id)


def _overhang(path: Path, edges: Curves, locator: Locator) -> float:
    """How far the centre line's farthest part lies outside, mm; 0 where none does. For words only: it samples the path."""
    import shapely

    points = path.to_polyline(tolerance=PREVIEW_CHORD_MM)
    count = max(int(path.length / 0.5), 1)
    points = np.vstack([points, path.point_at(np.linspace(0, 1, count + 1))])
    out = points[locator.faces(points) < 0]
    walls = shapely.MultiLineString(list(np.stack([edges.p0, edges.p1], axis=1)))
    return float(shapely.distance(shapely.points(out), walls).max(initial=0.0))


def _mm(amount: float) -> str:
    """One decimal; two where it would read 0.0 or hide what is wrong."""
    return f"{amount:.1f}" if amount >= 0.1 else f"{max(amount, 0.001):.3f}"


def _short(length: float) -> str:
    """At most one decimal: 12.5, 60, 0."""
    return f"{round(length, 1) + 0.0:g}"
