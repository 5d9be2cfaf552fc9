"""A file without a move, without homing, or without an end is refused; a whole one is not."""

from dataclasses import replace

import pytest

from gcode.check import check_text
from gcode.emit import END, emit
from gcode.plan import Plan
from gcode.printer import Printer

SOUND = "G28 X Y\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\nG1 X110 Y100 E40 F240\nG0 Z10 F300\n"


def found(text: str, printer: Printer) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(text, printer)]


@pytest.mark.parametrize("text", ["", "\n\n", "; a comment", "G28 X Y\nG90\nM83\n", "M117 hello"])
def test_no_move(text: str, printer: Printer) -> None:
    assert found(text, printer) == [(0, "there is no move in it")]


@pytest.mark.parametrize(
    ("home", "homing", "line", "says"),
    [
        ("xy", "G28 X Y", None, ""),
        ("xy", "G28 X\nG28 Y", None, ""),
        ("xyz", "G28", None, ""),
        ("none", "", None, ""),
        ("xy", "", 0, "never homes X and Y"),
        ("xyz", "", 0, "never homes X and Y and Z"),
        ("xy", "G28 Y", 0, "never homes X, so"),
        ("xyz", "G28 X Y", 0, "never homes Z"),
        ("xy", "G0 Z10 F300\nG0 X5 Y5 F600\nG28 X Y", 2, "moves before X and Y are homed"),
        ("xy", "G0 Z10 F600\nG28 X Y", None, ""),  # a lift first is good
    ],
)
def test_homing_before_the_first_move(printer: Printer, home: str, homing: str, line: int | None, says: str) -> None:
    faults = found(SOUND.replace("G28 X Y", homing, 1), replace(printer, home=home))
    if line is None:
        assert not faults
    else:
        ((at, what),) = faults
        assert at == line and says in what


def test_the_nozzle_ends_above_the_walls(printer: Printer) -> None:
    assert not found(SOUND, printer)
    cut = SOUND.removesuffix("G0 Z10 F300\n")
    assert found(cut, printer) == [(7, "it ends with the nozzle at Z1.6000, below the travel height")]
    assert found(cut + "G0 Z9.9 F300", printer) == [(8, "it ends with the nozzle at Z9.9000, below the travel height")]
    assert (2, "it ends at an unknown height") in found("G28 X Y\nG0 X5 Y5 F600", printer)


def test_our_own_files_are_refused_wherever_they_are_cut(planned: Plan, printer: Printer) -> None:
    lines = emit(planned.program, printer).splitlines()
    assert lines[-1] == END and not found("\n".join(lines), printer)
    for kept in range(1, len(lines)):
        assert any("cut off" in what for _, what in found("\n".join(lines[:kept]), printer)), kept
