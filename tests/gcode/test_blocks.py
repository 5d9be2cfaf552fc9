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
        ("G91 X1", ["G91 X1"]),  # one code: the reader's own
        ("G1 X1 G0 Y1", ["G1 X1 G0 Y1"]),  # two that move: a fault of the line
        ("G90 G90", ["G90 G90"]),
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


def test_marlin_does_not_read_blocks() -> None:
    judged = judge("G28 X Y\nG21 G90\nG1 X1 G0 Y2\n", load_printer())
    assert judged.broken_off is not None and "line 2: a second G" in str(judged.broken_off)
