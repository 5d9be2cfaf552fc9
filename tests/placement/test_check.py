"""Containment and clearance at their limits: tangent, holes, slits, neighbours; and what the findings say."""

import dataclasses
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.check import Checker, check_sensor, find_faults, validate
from skinfab.placement.sensor import Sensor

MATERIAL = load_material()
SPIRAL = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15)
KEEP = SPIRAL.bead / 2 + MATERIAL.margin  # centre line to edge


def put(
    x: float, y: float, angle: float = 0.0, *, id: str = "C1", pattern: ContactSpiral | StrainLines = SPIRAL, channel: int = 0
) -> Sensor:
    return Sensor(id, "P1", pattern, x, y, angle, channel)


def test_margin_zero_is_met_exactly_and_a_hair_more_is_not(sheet: Callable) -> None:
    _, piece = sheet(60, 60)
    # The lowest point of the spiral is the bottom of an arc, at b/2 - s/2: chords would put it higher.
    lowest = KEEP - (SPIRAL.b / 2 - SPIRAL.s / 2)
    assert check_sensor(piece, put(20, lowest), (), material=MATERIAL) == []
    (text,) = check_sensor(piece, put(20, lowest - 0.002), (), material=MATERIAL)
    assert text.startswith("C1 is 0.002 mm too close to the edge of piece P1 (0.9980 mm from bead to edge, 1 mm is the margin)")
    no_margin = dataclasses.replace(MATERIAL, margin=0.0)
    assert check_sensor(piece, put(20, lowest - MATERIAL.margin), (), material=no_margin) == []
    (text,) = check_sensor(piece, put(20, lowest - MATERIAL.margin - 0.01), (), material=no_margin)
    assert text == "C1 is 0.010 mm outside piece P1, which spans 0 to 60 x 0 to 60 mm"


@pytest.mark.parametrize(
    ("dx", "says"), [(0.6, "C1 is 0.6 mm outside piece P1"), (5.0, "C1 is 5.0 mm outside"), (500.0, "C1 is 500.0 mm outside")]
)
def test_outside_says_by_how_much(sheet: Callable, dx: float, says: str) -> None:
    _, piece = sheet(60, 60)
    touching = 60 - SPIRAL.bead / 2 - (SPIRAL.l + SPIRAL.s)
    (text,) = check_sensor(piece, put(touching + dx, 30), (), material=MATERIAL)
    assert text.startswith(says)


def test_a_hole_counts(sheet: Callable) -> None:
    _, piece = sheet(60, 60, without=lambda c: (np.abs(c - 30) < 5).all(axis=1))
    assert piece.topology.euler == 0
    across = put(20, 30, pattern=StrainLines(l1=30, l2=24, b=6))
    assert any("outside piece P1" in f for f in check_sensor(piece, across, (), material=MATERIAL))
    below = put(20, 25 - KEEP - 6, pattern=StrainLines(l1=30, l2=24, b=6, pad=0))
    assert check_sensor(piece, below, (), material=MATERIAL) == []
    assert check_sensor(piece, dataclasses.replace(below, y=below.y + 0.01), (), material=MATERIAL) != []


def test_a_small_hole_inside_a_turn_counts(sheet: Callable) -> None:
    # The bead goes round the hole: nothing is outside, but the margin to the hole is broken.
    wide = StrainLines(l1=50, l2=40, b=15, lines=2)
    _, piece = sheet(80, 60, step=1, without=lambda c: (np.abs(c - [30, 30]) < [1, 7]).all(axis=1))
    (text,) = check_sensor(piece, put(15, 22.5, pattern=wide), (), material=MATERIAL)
    assert "too close to the edge" in text


def test_a_slit_without_width_counts(sheet: Callable) -> None:
    mesh, whole = sheet(60, 60)
    _, slit = sheet(60, 60, slit=True)
    assert slit.area == pytest.approx(whole.area)
    across = put(20, 15)
    assert check_sensor(whole, across, (), material=MATERIAL) == []
    (text,) = check_sensor(slit, across, (), material=MATERIAL)
    assert text == "C1 crosses an edge of piece P1 (a dart or a slit)"
    assert check_sensor(slit, put(20, 45), (), material=MATERIAL) == []  # above the slit's end
    assert len(mesh.V) == len(whole.vertices)


def test_neighbours_keep_the_gap(sheet: Callable) -> None:
    _, piece = sheet(80, 60)
    one = put(10, 15)
    high = one.y + SPIRAL.b / 2 + SPIRAL.s / 2 - SPIRAL.x  # top of the lower sensor
    two = put(10, high + SPIRAL.bead + MATERIAL.gap + SPIRAL.s / 2 - SPIRAL.b / 2, id="C2")
    # Not straight above one another: the top arc's centre is x further left.
    two = dataclasses.replace(two, x=10 - SPIRAL.x)
    assert check_sensor(piece, two, (one, two), material=MATERIAL) == []
    nearer = dataclasses.replace(two, y=two.y - 0.2)
    assert check_sensor(piece, nearer, (one,), material=MATERIAL) == ["C2 is 0.2 mm too close to C1"]
    elsewhere = dataclasses.replace(one, piece="P2")
    assert check_sensor(piece, nearer, (elsewhere,), material=MATERIAL) == []


def test_too_close_to_itself(sheet: Callable) -> None:
    _, piece = sheet(80, 60)
    dense = StrainLines(l1=30, l2=20, b=3, bead=0.5, gap=0.5)
    assert check_sensor(piece, put(20, 20, pattern=dense), (), material=MATERIAL) == ["C1 is 0.1 mm too close to itself"]
    dense = StrainLines(l1=30, l2=20, b=3, bead=0.4, gap=0.6)
    assert check_sensor(piece, put(20, 20, pattern=dense), (), material=MATERIAL) == []


def test_validate_names_the_worst_first(sheet: Callable) -> None:
    _, piece = sheet(60, 60)
    good, off, far = put(20, 30), put(55, 30, id="C2", channel=1), dataclasses.replace(put(0, 0, id="C3", channel=1), piece="P9")
    validate(SimpleNamespace(pieces=(piece,), sensors=(good,)), MATERIAL)
    with pytest.raises(
        RefusedError, match=r"channel 1 is used by more.*C3 is on piece P9, which does not exist; there are P1.*C2 is .* outside piece P1"
    ):
        validate(SimpleNamespace(pieces=(piece,), sensors=(good, off, far)), MATERIAL)
    many = tuple(put(55, 30, id=f"C{k}", channel=k) for k in range(9))
    with pytest.raises(RefusedError, match=r"and \d+ more"):
        validate(SimpleNamespace(pieces=(piece,), sensors=many), MATERIAL)


@pytest.mark.parametrize(("area", "bead", "least"), [(0.484, 0.785, None), (0.484, 0.7849, 0.785), (0.19, 0.5, None), (1.0, 1.0, 1.128)])
def test_a_bead_is_no_narrower_than_it_is_printed(sheet: Callable, area: float, bead: float, least: float | None) -> None:
    _, piece = sheet(80, 60)
    material = dataclasses.replace(MATERIAL, ink=dataclasses.replace(MATERIAL.ink, bead_area_mm2=area))
    skin = SimpleNamespace(pieces=(piece,), sensors=(put(20, 20, pattern=StrainLines(l1=30, l2=20, b=6, bead=bead, gap=0.6)),))
    if least is None:
        validate(skin, material)
        return
    with pytest.raises(InputError, match=rf"^C1: strain-lines: bead is {bead}; it must be at least {least}, .* {area:g} mm\^2 of ink"):
        validate(skin, material)
    (sensor,) = skin.sensors
    skin.sensors = (dataclasses.replace(sensor, pattern=dataclasses.replace(sensor.pattern, bead=least)),)
    validate(skin, material)


def test_advice_is_in_the_right_number(sheet: Callable) -> None:
    _, piece = sheet(60, 60)

    def refusal(*sensors: Sensor) -> str:
        with pytest.raises(RefusedError) as refused:
            validate(SimpleNamespace(pieces=(piece,), sensors=sensors), MATERIAL)
        return str(refused.value)

    off, also = put(55, 30), put(-5, 30, id="C2", channel=1)
    assert refusal(off).endswith("P1, which spans 0 to 60 x 0 to 60 mm; move, turn or shrink it")
    assert refusal(off, also).endswith("move, turn or shrink them")
    # C2 is wrong twice: it lies on C1 and off the piece.
    assert refusal(put(20, 30), put(50, 30, id="C2", channel=1), put(50, 30, id="C3", channel=2)).endswith("move, turn or shrink them")
    twice = refusal(put(8, 10), put(48, 48, 3.1, id="C2", channel=0))
    assert twice == "channel 0 is used by more than one sensor"


def test_many_sensors_are_judged_each_by_its_own_piece_and_pattern(sheet: Callable) -> None:
    # What is kept from one sensor to the next must not leak: the same place on two pieces, two patterns on one.
    _, large = sheet(60, 60)
    small = dataclasses.replace(sheet(30, 30)[1], id="P2")
    dense = StrainLines(l1=30, l2=20, b=3, bead=0.5, gap=0.5)
    thin = dataclasses.replace(MATERIAL, ink=dataclasses.replace(MATERIAL.ink, bead_area_mm2=0.19))
    sensors = (
        put(30, 30),
        dataclasses.replace(put(30, 30, id="C2", channel=1), piece="P2"),
        put(10, 50, pattern=dense, id="S1", channel=2),
    )
    with pytest.raises(RefusedError) as refused:
        validate(SimpleNamespace(pieces=(large, small), sensors=sensors), thin)
    said = str(refused.value).split("; ")
    assert [s.split(" mm ", 1)[1] for s in said[:2]] == ["outside piece P2, which spans 0 to 30 x 0 to 30 mm", "too close to itself"]
    assert said[2:] == ["move, turn or shrink them"]


def test_a_checker_says_the_same_from_one_place_to_the_next(sheet: Callable) -> None:
    """What it keeps of earlier places and pieces is not mistaken for the present."""
    _, piece = sheet(60, 60, slit=True)
    _, smaller = sheet(40, 60)
    checker, neighbour = Checker(MATERIAL), put(20, 45, id="C2")
    seen = set()
    for k, angle in enumerate(np.linspace(0, 6, 40)):
        sensor = put(10 + k % 9 * 6.0, 5 + k % 7 * 9.0, float(angle))
        for ground in (piece, smaller):
            fresh = find_faults(ground, sensor, (neighbour,), material=MATERIAL)
            assert checker.faults(ground, sensor, (neighbour,)) == fresh
            seen |= {f.brief.split("mm ")[-1] for f in fresh}
    assert len(seen) == 4  # outside, at the edge, at the neighbour, across the slit: all were met


def test_findings_name_the_other_and_have_few_words(sheet: Callable) -> None:
    _, piece = sheet(60, 60)
    one, two = put(10, 30), put(22, 30, id="C2")
    (found,) = find_faults(piece, two, (one,), material=MATERIAL)
    assert found.other == "C1" and found.text == "C2 overlaps C1" and found.brief == "overlaps C1"
