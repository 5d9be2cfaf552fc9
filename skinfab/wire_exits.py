"""How each wire leaves its mould: straight from its pad to a wall, clear of the other sensors' ink.

A wire is pierced into the pad after curing, lies on the silicone and leaves through a slot in the wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon
from shapely.geometry.base import BaseGeometry

from skinfab.errors import InputError
from skinfab.material import Mould
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import MOULD_GRID_MM, PREVIEW_CHORD_MM

#: Directions tried from each pad, besides the one to the nearest wall: every 4 degrees.
_DIRECTIONS = 90

#: A way that begins over the sensor's own side of the pad counts this much longer: behind the pad nothing is in the way of the hands.
_AHEAD = 2.0

#: A slot may run this many times the wall's width through it; more obliquely it would be a notch along the wall.
_OBLIQUE = 2.0


@dataclass(frozen=True, eq=False)
class WirePad:
    """One contact pad, in the piece frame (mm).

    Parameters
    ----------
    sensor : str
        Id of the sensor.
    terminal : 1 or 2
        Where the conductor starts, or where it ends.
    at : (2,) float
        Middle of the pad.
    away : (2,) float
        Unit vector from the sensor's pattern to the outside of the pad; zeros where there is no such side.
    bead : float
        Width of the ink.
    ink : (k, 2) float
        The sensor's conductor, to be crossed by no wire if that can be.
    pad : (k, 2) float
        The pad's own stroke.
    """

    sensor: str
    terminal: int
    at: NDArray[np.float64]
    away: NDArray[np.float64] = field(default_factory=lambda: np.zeros(2))
    bead: float = 0.0
    ink: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))
    pad: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))

    @property
    def name(self) -> str:
        return f"pad {self.terminal} of {self.sensor}"


@dataclass(frozen=True, eq=False)
class WireSlot:
    """The slot that a pad's wire leaves by, in the piece frame (mm).

    Parameters
    ----------
    sensor, terminal
        Which pad.
    pad, at, out : (2,) float
        Middle of the pad, where its wire enters the wall, and where it comes out of it.
    shared : bool
        Whether the slot was cut for another pad, and this wire lies in it too.
    """

    sensor: str
    terminal: int
    pad: NDArray[np.float64]
    at: NDArray[np.float64]
    out: NDArray[np.float64]
    shared: bool = False


def wire_pads(sensors: Sequence[Sensor]) -> list[WirePad]:
    """The two pads of each sensor; where a pattern has no pads, the ends of its conductor."""
    pads = []
    for sensor in sensors:
        ink = sensor.path.to_polyline(tolerance=PREVIEW_CHORD_MM)
        stroke = sensor.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM)
        # Both leads run along the pattern's x axis, away from the pads.
        away = -np.array([np.cos(sensor.angle), np.sin(sensor.angle)])
        for terminal, end in ((1, ink[0]), (2, ink[-1])):
            k = int(np.hypot(*(stroke - end).T).argmin())
            pad = stroke[: k + 1] if terminal == 1 else stroke[k:]
            middle = (pad.min(axis=0) + pad.max(axis=0)) / 2  # a square's, however it is turned
            pads.append(WirePad(sensor.id, terminal, middle, away, sensor.pattern.bead, ink, pad))
    return pads


def plan_exits(
    pads: Sequence[WirePad], *, piece: str, cavity: MultiPolygon, outer: MultiPolygon, mould: Mould
) -> tuple[list[WireSlot], tuple[str, ...]]:
    """Choose a slot for each pad.

    The way is straight from the pad to the wall, through no dart, and comes out at the outside. Of all such ways
    the one is taken that crosses no other sensor, has room outside, and crosses not its own conductor and no other
    wire, in this order, and of these the shortest. Two pads have two slots unless only one wall can be reached clear of the other sensors.

    Parameters
    ----------
    pads : sequence of WirePad
    piece : str
        Its id, for the warnings.
    cavity, outer : MultiPolygon
        The silicone, and what the walls enclose, lips left out.
    mould : Mould

    Returns
    -------
    slots : list of WireSlot
        In the order of `pads`, without those that have none.
    warnings : tuple of str
        Each pad that has none, shares one, or whose wire crosses another sensor.

    Raises
    ------
    InputError
        A pad's place is not a point.
    """
    slots: list[WireSlot] = []
    notes: list[str] = []
    edges = _Edges(cavity, outer)
    for pad in pads:
        if np.shape(pad.at) != (2,) or not np.isfinite(pad.at).all():
            raise InputError(f"{pad.name} is at {np.asarray(pad.at).tolist()}; it must be a point (x, y) in mm")
        others = _lines([line for p in pads if p.sensor != pad.sensor for line in (p.ink, p.pad)])
        own = _lines([pad.ink, *(p.pad for p in pads if p.sensor == pad.sensor and p.terminal != pad.terminal)])
        slot, crosses = _own_slot(pad, own=own, others=others, taken=slots, edges=edges, mould=mould)
        if slot is None or crosses:
            shared = _shared_slot(pad, others, slots, cavity)
            slot, crosses = (slot, crosses) if shared is None else (shared, False)
        where = f"piece {piece}: the wire of {pad.name} near ({pad.at[0]:.1f}, {pad.at[1]:.1f}) mm"
        if slot is None:
            notes.append(f"{where} reaches no wall in a straight line, so it has no slot: lead it out over the wall's top")
            continue
        if crosses:
            notes.append(f"{where} has no way out clear of the other sensors: keep it insulated up to its pad")
        if slot.shared:
            notes.append(f"{where} has no wall of its own in reach: it shares the slot at ({slot.at[0]:.1f}, {slot.at[1]:.1f}) mm")
        slots.append(slot)
    return slots, tuple(notes)


def through_wall(slot: WireSlot, *, cavity: MultiPolygon, outer: MultiPolygon) -> WireSlot | None:
    """The slot prolonged to the outside of the finished wall; None where silicone or a pit is on its way."""
    way = _unit(slot.out - slot.at)
    rays = _Edges(cavity, outer).along(slot.at, way[None], wall=np.zeros(1))
    return replace(slot, out=slot.at + rays.out[0] * way) if rays.out[0] < rays.again[0] else None


def slot_region(slot: WireSlot, width: float, *, longer: float) -> BaseGeometry:
    """The slot as a strip from above, `longer` mm past either end."""
    way = _unit(slot.out - slot.at)
    return shapely.LineString([slot.at - longer * way, slot.out + longer * way]).buffer(width / 2, cap_style="flat")


def _own_slot(
    pad: WirePad, *, own: BaseGeometry, others: BaseGeometry, taken: Sequence[WireSlot], edges: _Edges, mould: Mould
) -> tuple[WireSlot | None, bool]:
    """The best straight way through a wall that no slot takes up, and whether it crosses another sensor."""
    angle = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    nearest = shapely.get_coordinates(shapely.shortest_line(shapely.Point(pad.at), edges.shore))[1] - pad.at
    ways = np.vstack([_unit(nearest), np.c_[np.cos(angle), np.sin(angle)]])
    rays = edges.along(pad.at, ways)
    # Each of these is false where the ray does not come out: infinity is not below infinity.
    fits = (rays.out < rays.again) & (rays.out <= rays.wall + _OBLIQUE * mould.wall) & (rays.behind >= rays.out + mould.wall)
    ways, wall, out = ways[fits], rays.wall[fits], rays.out[fits]
    # Lips grow into what is outside now: where they would close a notch, the wire had better not go.
    narrow = rays.behind[fits] < out + 2 * (mould.lip + mould.wall)
    at, end = pad.at + wall[:, None] * ways, pad.at + out[:, None] * ways
    if taken:
        # A wall half as wide as the others stays between two slots.
        apart = shapely.distance(_between(at, end), _lines([np.array([s.at, s.out]) for s in taken]))
        free = apart >= mould.wire_exit + mould.wall / 2
        ways, wall, at, end, narrow = ways[free], wall[free], at[free], end[free], narrow[free]
    if not len(ways):
        return None, False
    wires = _between(np.broadcast_to(pad.at, at.shape), at)
    crosses, crosses_own = (shapely.distance(wires, ink) < pad.bead / 2 for ink in (others, own))
    # The wires before this one end at their slots: a way between a pad and its slot is tangled with them.
    tangled = shapely.distance(wires, _lines([np.array([s.pad, s.at]) for s in taken])) <= 0
    length = wall * np.where(ways @ pad.away < 0, _AHEAD, 1.0)
    best = int(np.lexsort((length.round(6), tangled, crosses_own, narrow, crosses))[0])
    return WireSlot(pad.sensor, pad.terminal, pad.at, at[best], end[best]), bool(crosses[best])


def _shared_slot(pad: WirePad, others: BaseGeometry, slots: Sequence[WireSlot], cavity: MultiPolygon) -> WireSlot | None:
    """The nearest slot of another pad that the wire reaches over silicone, clear of the other sensors."""
    reach = cavity.buffer(MOULD_GRID_MM)
    for slot in sorted(slots, key=lambda s: float(np.hypot(*(s.at - pad.at)))):
        wire = shapely.LineString([pad.at, slot.at])
        if reach.covers(wire) and not shapely.distance(wire, others) < pad.bead / 2:
            return WireSlot(pad.sensor, pad.terminal, pad.at, slot.at, slot.out, shared=True)
    return None


@dataclass(frozen=True, eq=False)
class _Rays:
    """What each of some rays meets, in this order, mm from its start; infinite where it does not."""

    wall: NDArray[np.float64]  # where the silicone ends
    out: NDArray[np.float64]  # where the ray then comes out at the outside
    behind: NDArray[np.float64]  # where it meets the mould again
    again: NDArray[np.float64]  # where it meets silicone again


class _Edges:
    """The edges of silicone and wall, to be met by rays."""

    def __init__(self, cavity: MultiPolygon, outer: MultiPolygon) -> None:
        self.shore = shapely.MultiLineString([ring for part in cavity.geoms for ring in (part.exterior, *part.interiors)])
        self.cavity = _segments(list(self.shore.geoms))
        self.outer = _segments([part.exterior for part in outer.geoms])
        self.pits = _segments([ring for part in outer.geoms for ring in part.interiors])

    def along(self, at: NDArray[np.float64], ways: NDArray[np.float64], *, wall: NDArray[np.float64] | None = None) -> _Rays:
        """Rays from a point in the silicone, or from its edge where `wall` (zeros) says so."""
        silicone, outside, pits = (_hits(at, ways, edges) for edges in (self.cavity, self.outer, self.pits))
        wall = _next(silicone, np.zeros(len(ways))) if wall is None else wall
        out = _next(outside, wall)
        out = np.where(_next(pits, wall) < out, np.inf, out)
        return _Rays(wall, out, _next(outside, out), _next(silicone, wall))


def _hits(at: NDArray[np.float64], ways: NDArray[np.float64], edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far along each ray each edge is met, (ways, edges); infinite where it is not."""
    along, to = edges[:, 1] - edges[:, 0], edges[:, 0] - at
    x, y = ways.T[:, :, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # a ray beside an edge never meets it
        det = x * along[:, 1] - y * along[:, 0]
        t = (to[:, 0] * along[:, 1] - to[:, 1] * along[:, 0]) / det
        s = (to[:, 0] * y - to[:, 1] * x) / det
        return np.where((s >= 0) & (s <= 1) & (t > 0), t, np.inf)


def _next(hits: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """The first hit of each ray that is not at its place `after` itself."""
    later: NDArray[np.float64] = np.where(hits > after[:, None] + MOULD_GRID_MM, hits, np.inf).min(axis=1, initial=np.inf)
    return later


def _segments(rings: Sequence[BaseGeometry]) -> NDArray[np.float64]:
    """(n, 2, 2): the edges of closed rings."""
    return np.concatenate([np.zeros((0, 2, 2)), *(np.stack([c[:-1], c[1:]], axis=1) for c in map(shapely.get_coordinates, rings))])


def _between(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.object_]:
    return np.asarray(shapely.linestrings(np.stack([a, b], axis=1)))


def _lines(runs: Sequence[NDArray[np.float64]]) -> BaseGeometry:
    """All runs of two points or more as one geometry; nothing is infinitely far from an empty one."""
    return shapely.MultiLineString([run for run in runs if len(run) > 1])


def _unit(way: NDArray[np.float64]) -> NDArray[np.float64]:
    return way / max(float(np.hypot(*way)), np.finfo(float).tiny)
