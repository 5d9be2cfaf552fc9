"""The nozzle's side keeps off the mould's wall: exactly as far as its radius and clearance say, and only below the wall's top."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.check import check_program
from gcode.check_wall import Wall, needed_room, wall_findings, wall_of
from gcode.moves import Finding
from gcode.plan import plan
from gcode.printer import Nozzle, Printer, load_printer
from gcode.trace import trace
from gcode.write import checked_text
from skinfab.errors import RefusedError
from skinfab.material import Material, load_material
from skinfab.paths import Path
from skinfab.pieces import Piece

HEAD = "G90\nM83\nM302 P1\nG0 Z10 F300\nG0 X50 Y50 F6000\nG0 Z1.6 F300\n"
NOZZLE = Nozzle(outer_radius=0.64, clearance=0.2)


@pytest.fixture(scope="module")
def upright() -> Material:
    material = load_material()
    return replace(material, mould=replace(material.mould, draft_deg=0.0))


def found(body: str, piece: Piece, material: Material, nozzle: Nozzle = NOZZLE) -> list[Finding]:
    return list(wall_findings(trace(HEAD + body), wall_of(piece, material, (0.0, 0.0)), nozzle))


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("G1 X99.16 E8 F240", None),
        ("G1 X99.15 E8 F240", None),
        ("G1 X99.17 E8 F240", r"at X99\.17 Y50\.00 Z1\.60 the nozzle's axis is 0\.83 mm from the mould's wall, which stands 3 mm high"),
        ("G1 X101 E8 F240", r"Z1\.60 it runs across the mould's wall"),
        ("G3 X50 Y52 I0 J1 E8 F240", None),
        # Both ends of this arc are 20 mm from any wall: its bulge is not.
        ("G0 X80 Y40 F6000\nG3 X80 Y60 I6 J10 E8 F240", None),
        ("G0 X80 Y40 F6000\nG3 X80 Y60 I7 J10 E8 F240", r"at X99\.2\d Y5\d\.\d\d Z1\.60"),
        ("G0 Z3 F300\nG0 X99.9 Y99.9 F6000", None),
        ("G0 Z2.99 F300\nG0 X99.9 Y50 F6000", r"Z2\.99 the nozzle's axis is 0\.10 mm"),
        ("G0 Z10 F300\nG0 X99.5 F6000\nG0 Z1.6 F300\nG0 Z10 F300", r"at X99\.50 Y50\.00 Z1\.60"),
    ],
)
def test_moves_by_the_wall(make_piece: Callable[..., Piece], upright: Material, body: str, says: str | None) -> None:
    faults = found(body, make_piece(100, 100), upright)
    if says is None:
        assert faults == []
    else:
        assert faults
        assert re.search(says, faults[0].what), faults[0].what


@pytest.mark.parametrize(
    ("body", "remedies"),
    [
        ("G1 X99.66 E8 F240", ["move the sensor 0.50 mm inward, or take a thinner nozzle"]),
        (
            "G0 Z2 F300\nG0 X101 F6000",
            ["lift to Z3 or more before it; where that is the travel height raise travel under [heights]"],
        ),
        (
            "G0 Z10 F300\nG0 X100 F6000\nG0 Z1.6 F300",
            ["lift to Z3 or more before it; where that is the travel height raise travel under [heights]"],
        ),
        (
            "G0 Z10 F300\nG0 X99.66 F6000\nG0 Z1.6 F300\nG1 E1 F60\nG0 Z10 F300",
            [
                "lift to Z3 or more before it, or move the sensor 0.50 mm inward, or take a thinner nozzle",
                "move the sensor 0.50 mm inward, or take a thinner nozzle",
                "lift to Z3 or more before it, or move the sensor 0.50 mm inward, or take a thinner nozzle",
            ],
        ),
    ],
)
def test_the_remedy_suits_what_moves(make_piece: Callable[..., Piece], upright: Material, body: str, remedies: list[str]) -> None:
    faults = found(body, make_piece(100, 100), upright)
    assert [f.remedy.partition(" (nozzle")[0] for f in faults] == remedies


@given(st.floats(0.2, 3.0), st.floats(0.0, 1.0), st.floats(-math.pi, math.pi))
def test_it_refuses_at_the_needed_room_and_no_sooner(
    make_piece: Callable[..., Piece], radius: float, clearance: float, angle: float
) -> None:
    nozzle = Nozzle(radius, clearance)
    material = load_material()
    material = replace(material, mould=replace(material.mould, draft_deg=0.0))
    middle = np.array([50.0, 50.0])
    turned = make_piece(100, 100)
    c, s = math.cos(angle), math.sin(angle)
    turned = Piece("P1", turned.faces, turned.vertices, turned.F, (turned.UV - middle) @ np.array([[c, s], [-s, c]]) + middle)
    for room, fine in ((radius + clearance + 1e-3, True), (radius + clearance - 1e-3, False)):
        x, y = middle + (50 - room) * np.array([c, s])
        assert (found(f"G1 X{x:.6f} Y{y:.6f} E8 F240", turned, material, nozzle) == []) is fine


def test_walls_lean(make_piece: Callable[..., Piece], upright: Material) -> None:
    leaning = replace(upright, mould=replace(upright.mould, draft_deg=10.0))
    wall = wall_of(make_piece(100, 100), leaning, (0.0, 0.0))
    assert needed_room(wall, NOZZLE, 0.25) == pytest.approx(0.84 + math.tan(math.radians(10)))  # 1 mm below the middle
    assert needed_room(wall, NOZZLE, 1.6) == pytest.approx(0.84) and needed_room(wall, NOZZLE, 3.0) == 0.0
    assert found("G0 Z0.25 F300\nG1 X99.05 E8 F240", make_piece(100, 100), leaning)
    assert not found("G0 Z0.25 F300\nG1 X98.98 E8 F240", make_piece(100, 100), leaning)


def test_a_hole_has_a_wall_too(upright: Material) -> None:
    inner = np.array([[40, 40], [60, 40], [60, 60], [40, 60]], dtype=float)
    outer = np.array([[0, 0], [100, 0], [100, 100], [0, 100]], dtype=float)
    F = np.array([[k, (k + 1) % 4, 4 + k] for k in range(4)] + [[(k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)])
    ring = Piece("P1", np.arange(8), np.arange(8), F, np.vstack([outer, inner]))
    body = "G0 Z10 F300\nG0 X20 Y39 F6000\nG0 Z1.6 F300\nG1 X80 Y{:g} E8 F240"
    assert not found(body.format(39), ring, upright)
    assert found(body.format(39.5), ring, upright)


def test_many_moves_are_all_looked_at(make_piece: Callable[..., Piece], upright: Material) -> None:
    safe = "".join(f"G1 X{50 + k % 2} E0.3 F240\n" for k in range(1500))
    assert not found(safe, make_piece(100, 100), upright)
    (fault,) = found(safe + "G1 X99.5 E8 F240\n", make_piece(100, 100), upright)
    assert fault.line == HEAD.count("\n") + 1501


def test_only_moves_near_the_wall_are_measured(
    make_piece: Callable[..., Piece], upright: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    measured = 0
    exact = Wall.room

    def counted(wall: Wall, segments: list) -> float:
        nonlocal measured
        measured += len(segments)
        return exact(wall, segments)

    monkeypatch.setattr(Wall, "room", counted)
    inner = "".join(f"G1 X{50 + k % 2} E0.3 F240\n" for k in range(1000))
    arc = "G0 X97.16 Y50 F6000\nG3 X97.16 Y54 I0 J2 E20 F240\n"  # to X99.16 in its middle
    assert not found(inner + arc, make_piece(100, 100), upright)
    assert measured == 1
    assert found(inner + arc.replace("97.16", "97.2"), make_piece(100, 100), upright)


def test_a_thick_nozzle_is_refused_before_anything_is_written(
    make_piece: Callable[..., Piece], make_sensor: Callable, hairpin: Path, printer: Printer, material: Material
) -> None:
    piece = make_piece(120, 100)
    sensors = [make_sensor("C1", hairpin, 20, 3), make_sensor("C2", hairpin, 30, 60, 0.2)]
    planned = plan(piece, sensors, printer=printer, material=material)
    wall = wall_of(piece, material, planned.offset)
    assert check_program(planned.program, printer, wall=wall) == ()
    thick = replace(printer, nozzle=Nozzle(3.0, 0.2))
    with pytest.raises(RefusedError) as refused:
        checked_text(planned.program, printer=thick, wall=wall)
    assert "pattern C1: at X" in str(refused.value) and "move the sensor 0.20 mm inward, or take a thinner nozzle" in str(refused.value)


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
def test_the_bundled_nozzles_suit_the_bundled_margin(name: str) -> None:
    """A bead's edge is `margin` from the skin's edge, so that a sensor that may be placed can also be printed."""
    printer, material = load_printer(name), load_material()
    least = material.ink.bead_width / 2 + material.margin
    slope = math.tan(math.radians(material.mould.draft_deg))
    lean = max(material.depth / 2 - printer.heights.print_min, 0.0) * slope
    assert printer.nozzle.outer_radius + printer.nozzle.clearance + lean < least


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("G28 X Y\nG0 Z1.6 F300\nG0 X50 Y50\nG1 X60 E8", [3]),
        ("G28 X Y\nG0 Z2.9 F300\nG91\nG0 X50", [4]),
        ("G28 X Y\nG0 Z3 F300\nG0 X50 Y50", []),
        ("G0 Z1.6 F300\nG28 X Y", [2]),  # homing, before any ink
        ("G0 Z3 F300\nG28 X Y", []),
        ("G0 Z1.6 F300\nG28 X R2", []),
    ],
)
def test_ways_that_nobody_knows(make_piece: Callable[..., Piece], upright: Material, text: str, lines: list[int]) -> None:
    faults = list(wall_findings(trace("M83\nM302 P1\n" + text), wall_of(make_piece(100, 100), upright, (0.0, 0.0)), NOZZLE))
    assert [f.line - 2 for f in faults] == lines and all("unknown place" in f.what for f in faults)
