"""How each wire leaves its mould: straight from its pad to a wall, clear of the other sensors' ink and of the other wires.

A wire is pierced into the pad after curing, lies on the silicone and leaves through a slot in the wall.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
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
from skinfab.wire_choice import CROSSING, choose_ways
from skinfab.wire_ways import Edges, Ways, unit

#: A way over another sensor weighs as much as so many crossings of wires: to insulate a wire is easier than to keep ink whole.
_OVER_OTHERS = 5 * CROSSING

#: A way that lips may close is taken where it saves so many mm; if they do close it, the wire is led anew.
_NARROW_MM = 40.0

#: A wire is laid by hand, to a mm: a way that passes ink nearer than that is taken where it saves so many mm.
_HAND_MM = 1.0
_BESIDE_INK_MM = 20.0


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
    pads: Sequence[WirePad],
    *,
    cavity: MultiPolygon,
    outer: MultiPolygon,
    mould: Mould,
    barred: Sequence[tuple[int, NDArray[np.float64]]] = (),
) -> list[WireSlot | None]:
    """Choose a slot for each pad; None where there is none to be had.

    The way is straight from the pad to the wall, through no dart, and comes out at the outside. Ways are chosen such
    that together they cross no other sensors, and as few conductors of their own and wires as can be, and of these
    choices one with short wires. Two pads have two slots unless only one wall can be reached clear of the other sensors.

    Parameters
    ----------
    pads : sequence of WirePad
    cavity, outer : MultiPolygon
        The silicone, and what the walls enclose, lips left out.
    mould : Mould
    barred : sequence of (pad, (2,) float)
        The pad with this number cannot leave by this place of the silicone's edge, nor near it.

    Raises
    ------
    InputError
        A pad's place is not a point.
    """
    for pad in pads:
        if np.shape(pad.at) != (2,) or not np.isfinite(pad.at).all():
            raise InputError(f"{pad.name} is at {np.asarray(pad.at).tolist()}; it must be a point (x, y) in mm")
    edges = Edges(cavity, outer)
    ways = [edges.ways(pad.at, away=pad.away, mould=mould) for pad in pads]
    for k, at in barred:
        ways[k] = ways[k].only(np.hypot(*(ways[k].wall[:, 0] - at).T) > mould.lip + mould.wall)
    conductors = [_conductors(pad, pads) for pad in pads]
    faults = [_faults(pad, each, near) for pad, each, near in zip(pads, ways, conductors, strict=True)]
    # A wall half as wide as the others stays between two slots.
    chosen = choose_ways(ways, faults, apart=mould.wire_exit + mould.wall / 2)
    slots = [
        None if c is None else WireSlot(pad.sensor, pad.terminal, pad.at, *each.wall[c])
        for pad, each, c in zip(pads, ways, chosen, strict=True)
    ]
    reach = cavity.buffer(MOULD_GRID_MM)
    for k, slot in enumerate(slots):
        if slot is None or _over(slot, pads[k], conductors[k].others) is not None:
            slots[k] = _shared_slot(pads[k], conductors[k], slots, reach) or slot
    return slots


def exit_warnings(
    pads: Sequence[WirePad], slots: Sequence[WireSlot | None], *, piece: str, blocked: Collection[int] = ()
) -> tuple[str, ...]:
    """What the person who lays the wires must know: pads without a slot, shared slots, and all crossings.

    Parameters
    ----------
    pads, slots : sequences of WirePad, WireSlot or None
        As planned and cut, in the same order.
    piece : str
        Its id.
    blocked : collection of int
        The pads whose ways out end at lips.
    """
    notes: list[str] = []
    for k, (pad, slot) in enumerate(zip(pads, slots, strict=True)):
        where = f"piece {piece}: the wire of {pad.name} near {_mm(pad.at)}"
        if slot is None:
            why = "finds its way out blocked by lips" if k in blocked else "reaches no wall in a straight line"
            notes.append(f"{where} {why}, so it has no slot: lead it out over the wall's top")
            continue
        near = _conductors(pad, pads)
        if (met := _over(slot, pad, near.others)) is not None:
            notes.append(
                f"{where} has no way out clear of the other sensors, which it crosses near {_mm(met)}: keep it insulated up to its pad"
            )
        if (met := _over(slot, pad, near.own)) is not None:
            notes.append(f"{where} crosses its own conductor near {_mm(met)}: keep it insulated up to its pad")
        if slot.shared:
            notes.append(f"{where} has no wall of its own in reach: it shares the slot at {_mm(slot.at)}")
        for other, its in zip(pads[:k], slots[:k], strict=True):
            if its is None or not _tangled(slot, [its]):
                continue
            cross = (_wire(slot) & _wire(its)).centroid  # a point, or the middle of what they have in common
            notes.append(
                f"piece {piece}: the wires of {other.name} and {pad.name} cross near {_mm(shapely.get_coordinates(cross)[0])}: "
                "keep both insulated up to their pads"
            )
    return tuple(notes)


def through_wall(slot: WireSlot, *, cavity: MultiPolygon, outer: MultiPolygon) -> WireSlot | None:
    """The slot prolonged to the outside of the finished wall; None where silicone or a pit is on its way."""
    out = Edges(cavity, outer).out(slot.at, unit(slot.out - slot.at))
    return None if out is None else replace(slot, out=out)


def slot_region(slot: WireSlot, width: float, *, longer: float) -> BaseGeometry:
    """The slot as a strip from above, `longer` mm past either end."""
    way = unit(slot.out - slot.at)
    return shapely.LineString([slot.at - longer * way, slot.out + longer * way]).buffer(width / 2, cap_style="flat")


@dataclass(frozen=True, eq=False)
class _Conductors:
    """What a pad's wire should not cross: other sensors with their pads, and its own beyond the pad."""

    others: BaseGeometry
    own: BaseGeometry


def _conductors(pad: WirePad, pads: Sequence[WirePad]) -> _Conductors:
    others = [line for p in pads if p.sensor != pad.sensor for line in (p.ink, p.pad)]
    own = [pad.ink, *(p.pad for p in pads if p.sensor == pad.sensor and p.terminal != pad.terminal)]
    # Where there is no pad the wire ends on the conductor itself: a bead from its end they must have parted.
    return _Conductors(_lines(others), _lines(own) - shapely.Point(pad.at).buffer(pad.bead))


def _faults(pad: WirePad, ways: Ways, near: _Conductors) -> NDArray[np.float64]:
    """What is wrong with each way whatever the other wires do, see `skinfab.wire_choice.choose_ways`."""
    wires = shapely.linestrings(ways.wire)
    to_others, to_own = (shapely.distance(wires, lines) - pad.bead / 2 for lines in (near.others, near.own))
    soft = _NARROW_MM * ways.narrow + _BESIDE_INK_MM * (np.fmin(to_others, to_own) < _HAND_MM)
    return _OVER_OTHERS * (to_others < 0) + CROSSING * (to_own < 0) + soft


def _shared_slot(pad: WirePad, near: _Conductors, slots: Sequence[WireSlot | None], reach: BaseGeometry) -> WireSlot | None:
    """The slot of another pad that the wire reaches over silicone, clear of the other sensors: with few crossings, and near."""
    found: list[tuple[int, float, int, WireSlot]] = []
    for slot in slots:
        if slot is None or slot.shared or (slot.sensor, slot.terminal) == (pad.sensor, pad.terminal):
            continue
        mine = WireSlot(pad.sensor, pad.terminal, pad.at, slot.at, slot.out, shared=True)
        if reach.covers(_wire(mine)) and _over(mine, pad, near.others) is None:
            crossings = len(_tangled(mine, slots)) + (_over(mine, pad, near.own) is not None)
            found.append((crossings, float(np.hypot(*(slot.at - pad.at))), len(found), mine))
    return min(found)[-1] if found else None


def _over(slot: WireSlot, pad: WirePad, lines: BaseGeometry) -> NDArray[np.float64] | None:
    """Where a wire lies on some conductor; None where it does not."""
    wire = _wire(slot)
    if not shapely.distance(wire, lines) < pad.bead / 2:
        return None
    return shapely.get_coordinates(shapely.shortest_line(lines, wire))[0]


def _tangled(slot: WireSlot, slots: Sequence[WireSlot | None]) -> list[int]:
    """Which of other wires cross this one; wires that meet in the slot they share do not."""
    wire = _wire(slot)
    return [
        j
        for j, s in enumerate(slots)
        if s is not None
        and (s.sensor, s.terminal) != (slot.sensor, slot.terminal)
        and not np.array_equal(s.at, slot.at)
        and wire.intersects(_wire(s))
    ]


def _wire(slot: WireSlot) -> BaseGeometry:
    return shapely.LineString([slot.pad, slot.at])


def _mm(at: NDArray[np.float64]) -> str:
    return f"({at[0]:.1f}, {at[1]:.1f}) mm"


def _lines(runs: Sequence[NDArray[np.float64]]) -> BaseGeometry:
    """All runs of two points or more as one geometry; nothing is infinitely far from an empty one."""
    return shapely.MultiLineString([run for run in runs if len(run) > 1])
