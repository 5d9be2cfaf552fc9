"""Brackets, lower case and asterisks that a firmware reads otherwise than they are meant; harmless ones pass."""

from __future__ import annotations

import pytest

from gcode.check import check_text
from gcode.check_lines import checksum
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer, load_printer

SOUND = "G28 X Y\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\nG1 X110 Y100 E40 F240\nG0 Z10 F300\n"
GRBL = load_printer("generic-grbl")


def told(printer: Printer, old: str, new: str) -> list[tuple[int, str]]:
    """What is found in the sound file with one text in place of another."""
    assert old in SOUND
    return [(f.line, f.what) for f in check_text(SOUND.replace(old, new, 1), printer)]


@pytest.mark.parametrize(
    ("old", "new", "obeyed"),
    [
        ("G1 X110 Y100 E40 F240", "G1 X110 Y100 E40 F240 (X500 Z0)", "X500 Z0"),
        ("G1 X110 Y100 E40 F240", "G1 X110 (to X 120)Y100 E40 F240", "X120"),
        ("G1 X110 Y100 E40 F240", "G1 X110 Y100 E40 F240 (E)", "E"),  # takes the E before it back
        ("G1 X110 Y100 E40 F240", "N7 G1 X110 Y100 E40 F240 (a) (Z-.5)", "Z-.5"),
        ("G28 X Y", "G28 X Y (Zero later)", "Z"),
        ("G28 X Y", "G28 X Y (Origin)", "O"),
        ("M302 P1", "M302 P1 (P0)", "P0"),
    ],
)
def test_words_in_brackets_that_marlin_obeys(printer: Printer, old: str, new: str, obeyed: str) -> None:
    ((line, what),) = told(printer, old, new)
    assert line == SOUND.split("\n").index(old) + 1
    assert what == f"Marlin obeys {obeyed} in the brackets, unless it was built with PAREN_COMMENTS"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("M83", "M83 (E is relative: X5)"),
        ("M83", "(X500 Z0)\nM83"),
        ("M83", "M117 (X500)\nM83"),
        ("M83", "M83 ; (X500) g1"),
        ("G1 X110 Y100 E40 F240", "G1 X110 Y100 E40 F240 (fast, x500 z0)"),
        ("G1 X110 Y100 E40 F240", "G1 X110 Y100 E40 F240 (Line 5 of Part B2)"),
        ("G1 X110 Y100 E40 F240", "G1 X110 Y100 E40 F240 ()"),
        ("G28 X Y", "G28 X Y (both Axes)"),
    ],
)
def test_harmless_brackets(printer: Printer, old: str, new: str) -> None:
    assert not told(printer, old, new)


@pytest.mark.parametrize("before", ["", "N7 "])
def test_a_bracket_before_the_command_hides_it(printer: Printer, before: str) -> None:
    ((line, what),) = told(printer, "G1 X110", f"{before}(a stroke) G1 X110")
    assert (line, "unknown command and does nothing at G1" in what) == (7, True)


@pytest.mark.parametrize(
    "new",
    [
        "g1 X110 Y100 E40 F240",
        "G1 X110 Y100 e40 F240",
        "n7 G1 X110 Y100 E40 F240",
        "G1 X110 Y100 E40 F240\nm117 Hello",
        "t0\nG1 X110 Y100 E40 F240",
    ],
)
def test_lower_case_is_passed_over(printer: Printer, new: str) -> None:
    (what,) = [what for _, what in told(printer, "G1 X110 Y100 E40 F240", new)]
    assert what == "Marlin passes over lower case, unless it was built with GCODE_CASE_INSENSITIVE"


def test_a_writer_of_lower_case_is_told_once(printer: Printer) -> None:
    (fault,) = check_text(SOUND.lower(), printer)
    assert fault.line == 1 and fault.what.endswith("GCODE_CASE_INSENSITIVE, in 8 lines from here on")


@pytest.mark.parametrize(
    "line", ["M117 hello G1 x5", "; g1 x10", "M486 S0 ; a", 'M486 S1 A"thumb.stl"', "M486 AShape-Box", "M400 (a note)", "(g1 x5)"]
)
def test_small_letters_that_are_no_words(printer: Printer, line: str) -> None:
    assert not told(printer, "M83", f"M83\n{line}")


def test_grbl_halts_at_an_asterisk_right_or_wrong() -> None:
    sound = "G21\nG90\nG1 Z10 F300\nG1 X10 Y10 F600 (a * b) ; c * d\n"
    assert not check_text(sound, GRBL)
    line = "N3 G1 Z10 F300"
    for sum_of in (checksum(line), checksum(line) ^ 1):
        (fault,) = check_text(sound.replace(line[3:], f"{line}*{sum_of}"), GRBL)
        assert (fault.line, fault.what) == (3, "GRBL knows no checksums and halts at an asterisk")
    (fault,) = check_text("\n".join(f"{each}*7" for each in ("G21", "G90", "G1 Z10 F300")), GRBL)
    assert (fault.line, fault.what) == (1, "GRBL knows no checksums and halts at an asterisk, in 3 lines from here on")


def test_grbl_knows_brackets_and_small_letters() -> None:
    assert not check_text("g21\ng90\n(up) g1 z10 f300 (X500)\nG1 x10 Y10 F600\n", GRBL)


def test_our_own_files_have_none_of_these(planned: Plan, printer: Printer) -> None:
    assert not check_text(emit(planned.program, printer), printer)
