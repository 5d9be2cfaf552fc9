"""The nozzle keeps off the mould's wall: wherever it is below the wall's top, by its own radius and some clearance."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gcode.geometry import Point
from gcode.moves import Finding, Home, Move, Trace
from gcode.printer import Nozzle, Printer
from gcode.program import XY_DECIMALS
from skinfab.material import Material
from skinfab.mould import FREEBOARD_MM
from skinfab.paths import Line, Segment
from skinfab.pieces import Piece
from skinfab.placement.check import edge_curves
from skinfab.placement.distance import Curves, distance

#: Moves that are compared with the wall at once: the table of pairs stays small.
_AT_ONCE = 512

#: Places are rounded to this, mm.
_STEP = 10**-XY_DECIMALS


@dataclass(frozen=True, eq=False)
class Wall:
    """The wall of a piece's mould as the nozzle meets it, in machine coordinates.

    Parameters
    ----------
    edges : Curves
        The piece's outline, its holes and both sides of its darts: where the wall stands at half the silicone's depth.
    top : float, mm
        Its height over the floor of the cavity.
    middle, slope : float
        With a draft it leans: at a height z it stands ``(middle - z) * slope`` further inward.
    """

    edges: Curves
    top: float
    middle: float = 0.0
    slope: float = 0.0

    def inward(self, z: float) -> float:
        """How far it stands inside the edges at the height `z`, mm."""
        return max((self.middle - z) * self.slope, 0.0)

    def room(self, segments: list[Segment]) -> float:
        """Least distance of lines and arcs from the edges, mm."""
        return distance(Curves.of_segments(segments), self.edges)


def wall_of(piece: Piece, material: Material, offset: Point) -> Wall:
    """The wall that `skinfab.mould` puts round a piece, with the piece moved by `offset` (mm) onto the bed."""
    return _wall(edge_curves(piece).moved(angle=0.0, shift=offset), material)


def _wall(edges: Curves, material: Material) -> Wall:
    return Wall(edges, material.depth + FREEBOARD_MM, material.depth / 2, math.tan(math.radians(material.mould.draft_deg)))


def needed_room(wall: Wall, nozzle: Nozzle, z: float) -> float:
    """From the nozzle's axis to the piece's edge at the height `z`, mm; 0 above the wall."""
    return nozzle.outer_radius + nozzle.clearance + wall.inward(z) if z < wall.top - _STEP else 0.0


def nozzle_margin(printer: Printer, material: Material) -> float:
    """From a bead's edge to the piece's edge, mm, so that the nozzle that lays the material's bead clears the wall.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from skinfab.material import load_material
    >>> round(nozzle_margin(load_printer(), load_material()), 4)
    0.4475
    """
    wall = _wall(Curves.of_segments([]), material)
    return needed_room(wall, printer.nozzle, printer.heights.print) - material.ink.bead_width / 2


def wall_findings(judged: Trace, wall: Wall, nozzle: Nozzle) -> Iterator[Finding]:
    """Findings about moves that come too near to the wall, in the order of the moves."""
    yield from _unseen(judged, wall)
    low = [(move, z) for move in judged.moves if (z := _lowest(move)) is not None and z < wall.top - _STEP and _known(move)]
    if not low:
        return
    need = needed_room(wall, nozzle, min(z for _, z in low))
    near = _near([move for move, _ in low], wall, need)
    for k in range(0, len(near), _AT_ONCE):
        batch = [low[i] for i in near[k : k + _AT_ONCE]]
        lowest = min(z for _, z in batch)
        if wall.room([_segment(move) for move, _ in batch]) >= needed_room(wall, nozzle, lowest) - _STEP:
            continue
        for move, z in batch:
            room, need = wall.room([_segment(move)]), needed_room(wall, nozzle, z)
            if room < need - _STEP:
                yield _finding(move, z, room, need, wall, nozzle)


def _unseen(judged: Trace, wall: Wall) -> Iterator[Finding]:
    """Ways below the wall's top that nobody knows: they may run across it."""
    remedy = f"lift to Z{wall.top:g} or more before it"
    blind = [m for m in judged.moves if m.is_planar and m.shape is None and m.e <= 0]
    for line, z, pattern in [*((m.line, _lowest(m), m.pattern) for m in blind), *((h.line, h.z, h.pattern) for h in _homes_flat(judged))]:
        if z is not None and z < wall.top - _STEP:
            what = f"at Z{z:.2f} it runs from or to an unknown place, maybe across the mould's wall, which stands {wall.top:g} mm high"
            yield Finding(line, what, remedy, pattern)


def _homes_flat(judged: Trace) -> list[Home]:
    return [home for home in judged.homes if home.axes != "Z"]


def _near(moves: list[Move], wall: Wall, room: float) -> list[int]:
    """Which of the moves have a box within `room` (mm) of an edge's box: few of many, and only these are measured."""
    import shapely

    boxes = np.array([move.shape.bbox if move.shape else (move.end[:2],) * 2 for move in moves], dtype=float)
    # The tree asks for no more of a box than its corners.
    tree = shapely.STRtree(np.asarray(shapely.linestrings(np.stack([wall.edges.low, wall.edges.high], axis=1))))
    found, _ = tree.query(np.asarray(shapely.linestrings(boxes + np.array([[-room], [room]]))))
    return sorted(set(found.tolist()))


def _lowest(move: Move) -> float | None:
    heights = [z for z in (move.start[2], move.end[2]) if z is not None]
    return min(heights) if heights else None


def _known(move: Move) -> bool:
    return None not in move.end[:2] and (move.centre is None or move.shape is not None)


def _segment(move: Move) -> Segment:
    if move.shape is not None:
        return move.shape.segment
    # Up or down, or from an unknown place: the nozzle stands where the move ends.
    here = np.array(move.end[:2], dtype=float)
    return Line(here, here)


def _finding(move: Move, z: float, room: float, need: float, wall: Wall, nozzle: Nozzle) -> Finding:
    x, y = _nearest(move, wall)
    if room < _STEP:
        what = f"at X{x:.2f} Y{y:.2f} Z{z:.2f} it runs across the mould's wall, which stands {wall.top:g} mm high"
    else:
        what = (
            f"at X{x:.2f} Y{y:.2f} Z{z:.2f} the nozzle's axis is {room:.2f} mm from the mould's wall, which stands {wall.top:g} mm high; "
            f"its radius of {nozzle.outer_radius:g} mm and {need - nozzle.outer_radius:.2f} mm of clearance need {need:.2f}"
        )
    inward = f"move the sensor {need - room:.2f} mm inward, or take a thinner nozzle (nozzle, outer_radius in the printer profile)"
    lift = f"lift to Z{wall.top:g} or more before it"
    if move.e <= 0:  # where it leads to ink or from it the sensor may be too near all the same, unless it is on the wall
        remedy = f"{lift}; where that is the travel height raise travel under [heights]" if room < _STEP else f"{lift}, or {inward}"
    else:
        remedy = inward
    return Finding(move.line, what, remedy, move.pattern)


def _nearest(move: Move, wall: Wall) -> Point:
    """Where on its way the nozzle is nearest to the wall: of 33 places, enough to find it by."""
    segment = _segment(move)
    places = [segment.point_at(t) for t in np.linspace(0.0, 1.0, 33)]
    x, y = min(places, key=lambda p: wall.room([Line(p, p)]))
    return float(x), float(y)
