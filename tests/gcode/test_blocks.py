"""Lines of several codes: the order of RS-274, and the same moves as one code a line."""

import pytest

from gcode.blocks import parted
from gcode.check import judge
from gcode.printer import load_printer
from gcode.trace import trace

GRBL = load_printer("generic-grbl")


@pytest.mark.parametrize(
    ("body", "parts"),
    [
        ("G21 G17 G90 G94", ["G21", "G17", "G90", "G94"]),
        ("N10 G0 Z10 G90", ["G90", "G0Z10"]),
        ("G1 X1 M3 S200 F50", ["M3S200", "G1X1F50"]),
        ("G21 M5", ["M5", "G21"]),
        ("M5 M2", ["M5", "M2"]),
        ("X5 Y5 F600 G1", ["G1X5Y5F600"]),
        ("G91 X1", ["G91", "X1"]),
        ("G90 X0 Y0 F300", ["G90", "X0Y0F300"]),
        ("M3 S240 F300", ["M3S240", "F300"]),
        ("M5 X400", ["M5", "X400"]),
        ("G20 F3", ["G20", "F3"]),
        ("T1 M6", ["T1", "M6"]),
        ("N10", []),
        ("n5 g1 x1", ["G1x1".upper()]),
        ("G1 X1", ["G1 X1"]),
        ("X1", ["X1"]),
        ("G4 P1 G1 Y80", ["G4P1", "G1Y80"]),  # it dwells, then moves
        ("G1 Y80 F100 S5 G4 P1", ["S5", "G4P1", "G1Y80F100"]),  # S acts first of all
        ("M3 S100 G4 P.5 G91 X1 M0", ["M3S100", "G4P.5", "G91", "X1", "M0"]),
        ("G4 P1 X5", ["G4P1", "X5"]),
        ("G4 P1 F300", ["G4P1", "F300"]),
        ("G4P1", ["G4P1"]),
        ("G4", ["G4"]),
        ("G4 P1 A3", ["G4 P1 A3"]),
        ("G4 P1 G28", ["G4 P1 G28"]),  # two of a modal group
        ("G4 P1 P2", ["G4P1P2"]),
        ("G1 X1 G0 Y1", ["G1 X1 G0 Y1"]),  # two that move: a fault of the line
        ("G90 G90", ["G90 G90"]),
        ("G90 G91 G0 X1", ["G90 G91 G0 X1"]),  # two of a modal group: GRBL halts there
        ("M3 M5", ["M3 M5"]),
        ("G0 G80", ["G0 G80"]),
        ("G90 what G21", ["G90 what G21"]),
    ],
)
def test_parts(body: str, parts: list[str]) -> None:
    assert parted(body) == parts


def test_grbl_follows_a_block_as_its_parts() -> None:
    block = "G21 G17 G90 G94\nG0 Z10 F600\nX5 Y5 F600 G1\nM3 S100 G1 X9 F120\nM5 M2\n"
    single = "G21\nG17\nG90\nG94\nG0 Z10 F600\nG1 X5 Y5 F600\nM3 S100\nG1 X9 F120\nM5\nM2\n"
    one, two = trace(block, spindle=GRBL.spindle), trace(single, spindle=GRBL.spindle)
    assert [(m.start, m.end, m.e, m.speed) for m in one.moves] == [(m.start, m.end, m.e, m.speed) for m in two.moves]
    assert [m.line for m in one.moves] == [2, 3, 4]


def test_a_dwell_with_the_pump_on_lays_its_ink_before_the_line_moves() -> None:
    one = trace("G0 X0 Y0 Z5\nM3 S50\nS100 G4 P2 G1 X10 F600\n", spindle=GRBL.spindle)
    assert [(m.line, m.e) for m in one.moves] == [(1, 0.0), (3, 2.0), (3, 1.0)]
    assert one.moves[-1].end == (10.0, 0.0, 5.0) and not one.faults


@pytest.mark.parametrize("line", ["G90 X400", "G17 X400", "G94 X400", "M5 X400", "G21 Y5 X400"])
def test_the_motion_of_a_line_of_modes_is_judged(line: str) -> None:
    text = f"G21\nG90\nG0 Z10\nG1 X5 Y5 F600\n{line}\nG1 X10\n"
    assert any("X400" in str(f) and f.line == 5 for f in judge(text, GRBL).findings)


def test_what_grbl_takes_on_any_line_is_no_fault() -> None:
    text = "N1\nG21 G90 G40 G49 G80\nT1\nG0 Z10 F600\nG1 X5 Y5\nG21 F300\nG1 X6\n"
    found = judge(text, GRBL)
    assert not found.broken_off and not [f for f in found.findings if f.line < 7]


@pytest.mark.parametrize("line", ["G90 G91 G0 X1", "G20 G21", "M3 M5", "G4 P1 G28"])
def test_two_of_a_modal_group_break_it_off(line: str) -> None:
    assert "line 2: a second" in str(judge(f"G21\n{line}\n", GRBL).broken_off)


def test_marlin_does_not_read_blocks() -> None:
    judged = judge("G28 X Y\nG21 G90\nG1 X1 G0 Y2\n", load_printer())
    assert judged.broken_off is not None and "line 2: a second G" in str(judged.broken_off)
