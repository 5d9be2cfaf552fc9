"""Low travel: overruns pass, anything that could drag through ink does not."""

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from gcode.check import check_text
from gcode.check_height import bead_radius, crosses_ink, free_length
from gcode.clearance import Laid
from gcode.emit import emit
from gcode.geometry import Straight
from gcode.plan import plan
from gcode.printer import Printer, load_printer
from gcode.trace import trace
from skinfab.material import Material
from skinfab.paths import Path
from skinfab.pieces import Piece

HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
LINE = "G1 X110 Y100 E40 F240\n"


@pytest.mark.parametrize(
    ("body", "says"),
    [
        (LINE + "G0 X111 Y100\nG0 Z10 F300", None),  # an end overrun of 1 mm
        ("G1 E4 F400\n" + LINE + "G1 E-4 F400\nG0 X111 Y100 F240\nG0 Z10 F300", None),  # and after a retract
        ("G0 X101 Y100\nG1 X110 Y100 E36 F240", None),  # a start overrun
        ("G0 X101 Y100\nG1 E4 F400\nG1 X110 Y100 E36 F240\nG1 E-4 F400", None),
        (LINE + "G0 X112 Y100\nG0 Z10 F300", "below the travel height"),  # too long for one
        (LINE + "G0 X120 Y120\nG1 X130 Y120 E40", "below the travel height"),  # on to the next pattern
        (LINE + "G0 X130 Y130 Z10 F300", "below the travel height"),  # lifting on the way
        (LINE + "G0 X109 Y100\nG0 Z10 F300", "drags the nozzle"),  # back over its own bead
        (LINE + "G1 X110 Y101 E4\nG1 X109 Y101 E4\nG0 X109 Y100.2\nG0 Z10 F300", "drags the nozzle"),
        (LINE + "G0 X111 Y100\nG0 X111 Y99.5\nG0 Z10 F300", "below the travel height"),  # leads nowhere
    ],
)
def test_low_travel(body: str, says: str | None, printer: Printer) -> None:
    faults = [f.what for f in check_text(HEAD + body + "\nG0 Z10 F300", printer)]
    assert (not faults) if says is None else any(says in what for what in faults), faults


def test_an_entry_through_an_earlier_pattern(printer: Printer) -> None:
    entry = "G0 Z10 F300\nG0 X105 Y100.8 F6000\nG0 Z1.6 F300\nG0 X105 Y99.8 F240\nG1 X105 Y90 E39.2 F240"
    assert any("drags" in f.what for f in check_text(HEAD + LINE + entry, printer))


def test_bead_radius_is_that_of_a_round_bead(printer: Printer) -> None:
    move = trace(HEAD + LINE).moves[-1]
    assert bead_radius(move, printer) == pytest.approx(0.785 / 2, abs=1e-3)
    assert bead_radius(None, printer) == 0.0


def test_free_length_stops_before_ink() -> None:
    wall = Laid([Straight((1.0, -5.0), (1.0, 5.0))])
    assert free_length((0.0, 0.0), (1.0, 0.0), 2.0, wall, 0.3, leaves=False) == pytest.approx(0.6)
    assert free_length((0.0, 0.0), (-1.0, 0.0), 2.0, wall, 0.3, leaves=False) == 2.0
    assert free_length((0.9, 0.0), (1.0, 0.0), 2.0, wall, 0.3, leaves=False) == 0.0
    assert not crosses_ink(Straight((1.0, 5.0), (1.0, 6.0)), wall, 0.3, leaves=True)
    assert crosses_ink(Straight((1.0, 5.0), (1.0, 4.0)), wall, 0.3, leaves=True)


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
def test_a_travel_at_a_height_that_nobody_knows(
    make_piece: Callable[..., Piece], make_sensor: Callable, hairpin: Path, material: Material, name: str
) -> None:
    printer = load_printer(name)
    planned = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=printer, material=material)
    text = emit(planned.program, printer)
    assert check_text(text, printer) == ()
    # Without the first lift, the head goes to the first pattern as low as it stands.
    blind, count = re.subn(r"^G[01] Z10.0000 (F.*)\n", "", text, count=1, flags=re.MULTILINE)
    assert count == 1
    (fault,) = check_text(blind, printer)
    assert "travels at an unknown height" in fault.what and fault.pattern == "C1"
    assert fault.line == next(k for k, line in enumerate(blind.splitlines(), 1) if re.match("G[01] X", line))


@pytest.mark.parametrize(
    ("start", "home", "lines"),
    [
        ("G28 X Y\nG0 X100 Y100 F6000\nG0 Z10 F300", "xy", [2]),
        ("G28 X Y\nG0 X100 Y100 Z10 F300", "xy", [2]),  # it rises on the way
        ("G28 X Y\nG91\nG0 Z10 F300\nG90\nG0 X100 Y100 F6000\nG0 Z10 F300", "xy", [5]),  # ten above who knows what
        ("G28\nG0 X100 Y100 F6000\nG0 Z10 F300", "xyz", [2]),
        ("G28\nG1 Z5 F300\nG0 Z10\nG0 X100 Y100 F6000", "xyz", []),  # as slicers begin
        ("G28\nG0 Z15 F300\nG28 X Y\nG0 X100 Y100 F6000", "xyz", []),
    ],
)
def test_the_height_is_said_before_the_first_travel(start: str, home: str, lines: list[int], printer: Printer) -> None:
    text = f"{start}\nG90\nM83\nM302 P1\nG0 Z1.6 F300\n{LINE}G0 Z10 F300"
    faults = check_text(text, replace(printer, home=home))
    assert [f.line for f in faults] == lines and all("unknown height" in f.what for f in faults)


def untold(text: str, printer: Printer) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(text, printer) if "unknown place" in f.what or "it homes" in f.what]


@pytest.mark.parametrize(
    ("body", "lines"),
    [
        ("G28 X Y\nG0 Z10 F300\nG0 X50 Y50 F6000\nG0 Z1.6 F300\nG1 X60 E40 F240\n", []),
        ("G28 X Y\nG0 Z1.6 F300\nG0 X50 Y50 F6000\nG1 X60 E40 F240\n", [3]),
        ("G28 X Y\nG0 Z10 F300\nG0 X50 Y50 Z1.6 F300\nG1 X60 E40 F240\n", [3]),  # down in one diagonal
        ("G28 X Y\nG0 Z10 F300\nG91\nG0 X50 Y50 Z-8.4 F300\nG90\nG0 X50 Y50\nG1 X60 E40 F240\n", [4, 6]),  # by so much from nowhere
        ("G28 X Y\nG0 Z1.6 F300\nG91\nG0 X5 F600\nG90\nG0 Z10 F300\nG0 X50 Y50\nG0 Z1.6 F300\nG1 X60 E40 F240\n", [4]),
        ("G28 X Y\nG91\nG0 Z10 F300\nG90\nG0 Z10\nG0 X50 Y50\nG0 Z1.6\nG1 X60 E40 F240\n", []),
    ],
)
def test_a_low_way_over_an_unknown_place(body: str, lines: list[int], printer: Printer) -> None:
    text = f"M83\nM302 P1\n{body}G0 Z10 F300\n"
    assert [line - 2 for line, _ in untold(text, printer)] == lines


@pytest.mark.parametrize(
    ("homing", "lines"),
    [
        ("G28 X Y\nG0 X90 Y90\n", [9, 10]),
        ("G28 X\nG0 Y105\nG0 X90\n", [9, 10, 11]),
        ("G28 X R8.4\nG0 Z10 F300\nG0 X90 Y105\n", []),  # Marlin rises by R before
        ("G0 Z10 F300\nG28 X Y\nG0 X90 Y90\n", []),
        ("G0 Z10 F300\nG28 X Y\nG0 Z1.6 F300\nG0 X90 Y90\n", [12]),
    ],
)
def test_homing_in_wet_ink(homing: str, lines: list[int], printer: Printer) -> None:
    text = HEAD + LINE + homing + "G0 Z10 F300\n"
    assert [line for line, _ in untold(text, printer)] == lines
    if not lines:
        assert check_text(text, printer) == ()


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_our_own_file_without_its_first_way(
    make_piece: Callable[..., Piece], make_sensor: Callable, hairpin: Path, material: Material, name: str, arcs: str
) -> None:
    printer = load_printer(name)
    program = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=printer, material=material).program
    text = emit(program, printer, arcs=arcs)  # type: ignore[arg-type]
    assert check_text(text, printer) == ()
    lost, count = re.subn(r"^G[01] X\S+ Y\S+( F\S+)?\n(?=G[01] Z1.6)", "", text, count=1, flags=re.MULTILINE)
    assert count == 1
    assert any("from or to an unknown place at Z1.6" in f.what for f in check_text(lost, printer))


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin"])
def test_homing_planted_behind_the_retract(
    make_piece: Callable[..., Piece], make_sensor: Callable, hairpin: Path, material: Material, name: str
) -> None:
    printer = load_printer(name)
    text = emit(plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=printer, material=material).program, printer)
    planted, count = re.subn(r"^(G1 E-.*)\n", r"\1\nG28 X Y\n", text, count=1, flags=re.MULTILINE)
    assert count == 1
    told = [f.what for f in check_text(planted, printer)]
    assert any("it homes X and Y at Z1.6" in what for what in told)


def test_grbl_over_an_unknown_place() -> None:
    grbl = load_printer("generic-grbl")
    low = "G21\nG90\nG0 Z1.6\nG0 X50 Y50\nM3 S242\nG1 X60 F300\nM5\nG0 Z10\n"
    assert [line for line, _ in untold(low, grbl)] == [4]
    assert check_text(low.replace("G0 Z1.6\nG0 X50 Y50", "G0 Z10\nG0 X50 Y50\nG0 Z1.6"), grbl) == ()
