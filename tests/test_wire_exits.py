"""Wires: every pad has a way out, judged with shapely on shapes whose answer is plain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import MultiPolygon, Polygon, box
from wire_crossings import crossings

from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.sensor import Sensor
from skinfab.wire_exits import WirePad, WireSlot, exit_warnings, plan_exits, slot_region, through_wall, wire_pads

MOULD = load_material().mould


def exits(pads: list[WirePad], cavity: Polygon, *, outer: Polygon | None = None) -> tuple[list[WireSlot], tuple[str, ...]]:
    walls = cavity.buffer(MOULD.wall, join_style="mitre") if outer is None else outer
    slots = plan_exits(pads, cavity=MultiPolygon([cavity]), outer=MultiPolygon([walls]), mould=MOULD)
    assert [(s.sensor, s.terminal) for s in slots if s] == [(p.sensor, p.terminal) for p, s in zip(pads, slots, strict=True) if s]
    return [s for s in slots if s is not None], exit_warnings(pads, slots, piece="P1")


def all_said(pads: list[WirePad], slots: list[WireSlot], notes: tuple[str, ...]) -> bool:
    """Each crossing has its sentence, and each sentence of a crossing is true."""
    found = crossings(pads, slots)
    said = [note for note in notes if "cross" in note or "clear of the other" in note]
    return len(found) == len(said) and all(any(each in note for note in said) for each in found)


def pad(sensor: str, x: float, y: float, *, terminal: int = 1, away: tuple[float, float] = (0, 0), ink: object = ()) -> WirePad:
    line = np.array(ink, dtype=float).reshape(-1, 2)
    return WirePad(sensor, terminal, np.array([x, y]), np.array(away, dtype=float), 0.8, line)


def test_straight_through_the_nearest_wall() -> None:
    (slot,), notes = exits([pad("C1", 4, 12)], box(0, 0, 40, 30))
    np.testing.assert_allclose([slot.at, slot.out], [[0, 12], [-1.6, 12]], atol=1e-9)
    assert notes == () and not slot.shared and (slot.sensor, slot.terminal) == ("C1", 1)


def test_behind_the_pad_before_over_its_pattern() -> None:
    # The wall ahead is 8 mm off, the one behind 12: within the factor of two, so the wire goes back.
    (slot,), _ = exits([pad("C1", 8, 50, away=(1, 0))], box(0, 0, 20, 100))
    assert slot.at[0] == pytest.approx(20)
    (slot,), _ = exits([pad("C1", 8, 50, away=(1, 0))], box(0, 0, 60, 100))
    assert slot.at[0] == pytest.approx(0)


def test_not_over_another_sensor() -> None:
    # A long conductor lies between the pad and the near wall; the way is round its end or to another wall.
    other = pad("C2", 30, 4, ink=[[10, 2], [10, 26]])
    near = pad("C1", 14, 15)
    slots, notes = exits([near, other], box(0, 0, 60, 30))
    wire = shapely.LineString([near.at, slots[0].at])
    assert wire.distance(shapely.LineString(other.ink)) >= 0.4 and notes == ()
    plain, _ = exits([near, replace(other, ink=np.zeros((0, 2)))], box(0, 0, 60, 30))
    assert plain[0].at[0] == pytest.approx(0)


def test_a_pad_that_is_fenced_in_is_named() -> None:
    fence = [[10, 10], [20, 10], [20, 20], [10, 20], [10, 10]]
    slots, notes = exits([pad("C1", 14, 15), pad("C2", 25, 15, ink=fence)], box(0, 0, 30, 30))
    assert len(slots) == 2
    assert notes == (
        "piece P1: the wire of pad 1 of C1 near (14.0, 15.0) mm has no way out clear of the other sensors, "
        "which it crosses near (10.0, 15.0) mm: keep it insulated up to its pad",
    )


def test_own_conductor_is_gone_round() -> None:
    # It bars the way to the left; to the right the wall is farther.
    (slot,), notes = exits([pad("C1", 10, 15, ink=[[5, 0], [5, 30]])], box(0, 0, 40, 30))
    assert notes == ()
    assert not shapely.LineString([[10, 15], slot.at]).intersects(shapely.LineString([[5, 0], [5, 30]]))


def test_a_wire_does_not_graze_ink() -> None:
    # Straight to the left it would pass the stroke by 0.1 mm; a few degrees aside there is room for a hand.
    stroke = [[4, 15.5], [4, 20]]
    (slot,), notes = exits([pad("C1", 10, 15, ink=stroke)], box(0, 0, 40, 30))
    assert notes == () and slot.at[0] == pytest.approx(0)
    assert shapely.LineString([[10, 15], slot.at]).distance(shapely.LineString(stroke)) >= 0.4 + 1.0


def test_own_conductor_all_round_is_said() -> None:
    fence = [[10, 10], [20, 10], [20, 20], [10, 20], [10, 10]]
    pads = [pad("C1", 15, 14, ink=fence)]
    slots, notes = exits(pads, box(0, 0, 30, 30))
    assert notes == (
        "piece P1: the wire of pad 1 of C1 near (15.0, 14.0) mm crosses its own conductor near (15.0, 10.0) mm: "
        "keep it insulated up to its pad",
    )
    assert all_said(pads, slots, notes)


def test_a_conductor_without_a_pad_is_not_crossed_where_the_wire_ends_on_it() -> None:
    lead = [[10, 15], [30, 15]]
    pads = [pad("C1", 10, 15, ink=lead, away=(-1, 0)), pad("C1", 30, 15, terminal=2, ink=lead, away=(-1, 0))]
    slots, notes = exits(pads, box(0, 0, 34, 30))
    assert notes == () and slots[0].at[0] == pytest.approx(0)
    # Along the lead the wire does cross it: the whole piece is a slit as wide as the lead, with one way out.
    slit, outer = box(0, 14.5, 40, 15.5), box(-20, -20, 41.6, 50)
    pads = pads[:1]
    slots, notes = exits(pads, slit, outer=outer)
    assert slots[0].at[0] == pytest.approx(40) and len(notes) == 1 and "crosses its own conductor near (10.8, 15.0) mm" in notes[0]
    assert all_said(pads, slots, notes)


def test_terminals_in_an_order_opposite_to_the_rim() -> None:
    # Pads in a row along a strip whose only thin wall is at its end, first come far away: one by one they would cross.
    cavity, outer = box(0, 0, 60, 30), box(-20, -20, 61.6, 50)
    for order in (1, -1):
        pads = [pad(f"C{k}", 10 + 5 * k, 6 + 3 * (k % 3) * order + 8 * (order < 0), terminal=1) for k in range(8)][::order]
        slots, notes = exits(pads, cavity, outer=outer)
        assert len(slots) == 8 and crossings(pads, slots) == [] and notes == ()


def test_no_wire_lies_across_another_where_each_has_its_own_way() -> None:
    # Twelve sensors on a disk, listed in any order, the terminals of each turned to the middle: all ways out lead past two sensors.
    rng = np.random.default_rng(4)
    for _ in range(5):
        pads = []
        for k, angle in enumerate(rng.permutation(12) * np.pi / 6):
            out, side = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
            for terminal, sign in ((1, 1), (2, -1)):
                ink = [26 * out + sign * side, 36 * out + 3 * sign * side, 36 * out - 3 * sign * side, 26 * out - sign * side]
                pads.append(pad(f"C{k}", *(24 * out + sign * side), terminal=terminal, away=tuple(-out), ink=ink))
        slots, notes = exits(pads, shapely.Point(0, 0).buffer(45))
        assert len(slots) == 24 and crossings(pads, slots) == [] and notes == ()


def test_wires_that_must_cross_are_said() -> None:
    pads = [pad("C1", 12, 20), pad("C2", 20, 28)]
    slots = [
        WireSlot("C1", 1, pads[0].at, np.array([40.0, 20]), np.array([41.6, 20])),
        WireSlot("C2", 1, pads[1].at, np.array([20.0, 0]), np.array([20, -1.6])),
    ]
    notes = exit_warnings(pads, slots, piece="P7")
    assert notes == ("piece P7: the wires of pad 1 of C1 and pad 1 of C2 cross near (20.0, 20.0) mm: keep both insulated up to their pads",)
    assert all_said(pads, slots, notes)


def test_what_is_said_is_of_the_slots_that_are_cut() -> None:
    # The second wire lost its slot to a lip: the first crosses nothing any more.
    pads = [pad("C1", 12, 20), pad("C2", 20, 28)]
    first = WireSlot("C1", 1, pads[0].at, np.array([40.0, 20]), np.array([41.6, 20]))
    (note,) = exit_warnings(pads, [first, None], piece="P1", blocked={1})
    assert "pad 1 of C2 near (20.0, 28.0) mm finds its way out blocked by lips, so it has no slot" in note


def test_a_place_that_is_barred_is_left_alone() -> None:
    cavity = box(0, 0, 40, 30)
    (slot,) = plan_exits(
        [pad("C1", 4, 12)],
        cavity=MultiPolygon([cavity]),
        outer=MultiPolygon([cavity.buffer(MOULD.wall, join_style="mitre")]),
        mould=MOULD,
        barred=[(0, np.array([0.0, 12.0]))],
    )
    assert slot is not None and np.hypot(*(slot.at - [0, 12])) > MOULD.lip + MOULD.wall


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 9))
def test_every_crossing_is_said(seed: int, sensors: int) -> None:
    """Terminals anywhere on a disk, each sensor's conductor any zig-zag between them."""
    rng = np.random.default_rng(seed)
    pads = []
    for k in range(sensors):
        ends = rng.uniform(-25, 25, (2, 2))
        ink = np.vstack([ends[0], ends.mean(axis=0) + rng.uniform(-4, 4, (3, 2)), ends[1]])
        pads += [pad(f"C{k}", *ends[t], terminal=t + 1, away=(1, 0), ink=ink) for t in (0, 1)]
    slots, notes = exits(pads, shapely.Point(0, 0).buffer(40))
    assert len(slots) == len(pads)
    assert all_said(pads, slots, notes)


def test_two_pads_two_slots_with_wall_between() -> None:
    pads = [pad("C1", 5, 10, terminal=1), pad("C1", 5, 10.5, terminal=2), pad("C2", 5, 11)]
    slots, notes = exits(pads, box(0, 0, 40, 40))
    cuts = [slot_region(s, MOULD.wire_exit, longer=0) for s in slots]
    assert notes == () and len(cuts) == 3
    assert min(a.distance(b) for k, a in enumerate(cuts) for b in cuts[:k]) >= MOULD.wall / 2 - 1e-9
    wires = [shapely.LineString([s.pad, s.at]) for s in slots]
    assert not any(a.intersects(b) for k, a in enumerate(wires) for b in wires[:k])


def test_a_shared_slot_is_said() -> None:
    # Only at the right end a wall leads outside, the other sides are thick: there is room for one slot.
    cavity, outer = box(0, 0, 30, 1.4), box(-20, -20, 31.6, 21.4)
    slots, notes = exits([pad("C1", 20, 0.7, terminal=1), pad("C1", 10, 0.7, terminal=2)], cavity, outer=outer)
    assert [s.shared for s in slots] == [False, True]
    np.testing.assert_array_equal(slots[0].at, slots[1].at)
    assert (
        len(notes) == 1
        and "the wire of pad 2 of C1" in notes[0]
        and f"shares the slot at ({slots[0].at[0]:.1f}, {slots[0].at[1]:.1f})" in notes[0]
    )


def test_no_wall_in_reach_is_said() -> None:
    slots, notes = exits([pad("C1", 10, 10)], box(0, 0, 20, 20), outer=box(-20, -20, 40, 40))
    assert slots == [] and len(notes) == 1 and "pad 1 of C1 near (10.0, 10.0) mm reaches no wall" in notes[0]


def test_not_into_a_pit_nor_through_a_dart() -> None:
    # A hole in the middle with walls round it is a pit: a wire must not end there.
    ring = Polygon(box(0, 0, 60, 60).exterior.coords, [box(20, 20, 40, 40).exterior.coords])
    (slot,), _ = exits([pad("C1", 16, 30)], ring, outer=ring.buffer(MOULD.wall, join_style="mitre"))
    assert slot.at[0] == pytest.approx(0)
    # A dart 2 mm wide beside the pad is all wall, and silicone lies behind it.
    darted = box(0, 0, 60, 40) - box(29, 10, 31, 40)
    (slot,), _ = exits([pad("C1", 27, 20)], darted, outer=box(-1.6, -1.6, 61.6, 41.6))
    wire = shapely.LineString([slot.at, slot.out])
    assert wire.length <= 2 * MOULD.wall and wire.intersection(darted).length < 1e-6


def test_prolonged_through_a_lip() -> None:
    cavity = MultiPolygon([box(0, 0, 20, 20)])
    slot = WireSlot("C1", 1, np.array([5.0, 10]), np.array([0.0, 10]), np.array([-1.6, 10]))
    longer = through_wall(slot, cavity=cavity, outer=MultiPolygon([box(-5.6, -1.6, 21.6, 21.6)]))
    assert longer is not None
    np.testing.assert_allclose(longer.out, [-5.6, 10])
    beyond = MultiPolygon([box(0, 0, 20, 20), box(-4, 0, -2, 20)])
    assert through_wall(slot, cavity=beyond, outer=MultiPolygon([box(-5.6, -1.6, 21.6, 21.6)])) is None


def test_a_place_that_is_none() -> None:
    with pytest.raises(InputError, match="pad 1 of C1 is at"):
        exits([pad("C1", np.nan, 3)], box(0, 0, 20, 20))


def test_pads_of_sensors() -> None:
    spiral = Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=24.0), x=50.0, y=60.0, angle=0.7, channel=0)
    bare = Sensor("S1", "P1", StrainLines(l1=30, l2=24, b=6, pad=0.0), x=10.0, y=10.0, angle=0.0, channel=1)
    first, last, start, end = wire_pads([spiral, bare])
    assert [(p.sensor, p.terminal) for p in (first, last, start, end)] == [("C1", 1), ("C1", 2), ("S1", 1), ("S1", 2)]
    # In the pattern frame the squares of 3 mm lie at x = -2.215 .. 0, below y = 0 and above y = b.
    reach = 3.0 - 0.785
    turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    for p, y in ((first, -reach / 2), (last, 3.0 + reach / 2)):
        np.testing.assert_allclose(p.at, turn @ [-reach / 2, y] + [50, 60], atol=1e-9)
        np.testing.assert_allclose(p.away, turn @ [-1, 0])
    np.testing.assert_allclose(start.at, bare.path.start)
    np.testing.assert_allclose(end.at, bare.path.end)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_every_slot_is_a_way_out(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    cavity = Polygon(rng.uniform(25, 40, 40)[:, None] * np.c_[np.cos(angle), np.sin(angle)])
    outer = cavity.buffer(MOULD.wall * 1.5, join_style="mitre", mitre_limit=2).buffer(-MOULD.wall / 2, join_style="mitre", mitre_limit=2)
    pads = [pad(f"C{k // 2}", *rng.uniform(-12, 12, 2), terminal=k % 2 + 1) for k in range(6)]
    slots, notes = exits(pads, cavity, outer=outer)
    assert len(slots) + sum("no slot" in note for note in notes) == 6
    for slot in slots:
        assert shapely.LineString([slot.pad, slot.at]).within(cavity.buffer(1e-6))
        if not slot.shared:
            wall = shapely.LineString([slot.at, slot.out])
            assert wall.within(outer.buffer(1e-6)) and wall.intersection(cavity).length < 1e-6
            assert shapely.Point(slot.out).distance(shapely.LineString(outer.exterior)) < 1e-6
