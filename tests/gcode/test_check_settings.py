"""Limits that a file sets away from the profile's are found, with the way they go; the profile's own are fine."""

from dataclasses import replace

import pytest

from gcode.check import check_text
from gcode.check_settings import LIMITS
from gcode.printer import Printer, load_printer
from gcode.words import SETTINGS

SOUND = "G28 X Y\nM83\nM302 P1\n{}\nG21\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\nG1 X110 Y100 E40 F240\nG0 Z10 F300\n"


def found(line: str, printer: Printer) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(SOUND.format(line), printer)]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("M201 X1000", ["M201 X1000 raises the acceleration to 1000, the profile says 500"]),
        ("M201 X500 Y100 Z5", ["M201 Y100 lowers the acceleration to 100, the profile says 500"]),
        (
            "M203 X100 Y500",
            ["M203 X100 lowers the greatest speed to 100, the profile says 300", "M203 Y500 raises the greatest speed to 500"],
        ),
        ("M203 Z2", ["M203 Z2 lowers the greatest speed to 2, the profile says 5"]),
        ("M203 E50", ["M203 E50 raises the greatest speed to 50, the profile says 25"]),
        ("M204 S3000", ["M204 S3000 raises the acceleration to 3000"]),
        ("M204 P500 T1500", ["M204 T1500 raises the acceleration to 1500"]),
        ("M205 J0.02", ["M205 J0.02 lowers the junction deviation to 0.02, the profile says 0.08"]),
        ("G20 ; inches\nM203 X10", ["M203 X10 lowers the greatest speed to 254"]),
    ],
)
def test_planted_faults(line: str, says: list[str], printer: Printer) -> None:
    faults = found(line, printer)
    assert [at for at, _ in faults] == [4 + line.count("\n")] * len(says)
    assert all(start in what for (_, what), start in zip(faults, says, strict=True)), faults


@pytest.mark.parametrize(
    "line", ["M201 X500 Y500 Z100 E5000", "M203 X300 Y300 Z20 E25 T0", "M204 P500 T500 R3000", "M205 J0.08 X8 Y8", "M203", "M204"]
)
def test_what_the_profile_says_is_fine(line: str, printer: Printer) -> None:
    assert not found(line, printer)


def test_another_profile_says_otherwise(printer: Printer) -> None:
    fast = replace(printer, motion=replace(printer.motion, acceleration=3000.0))
    assert not found("M204 S3000", fast)


def test_the_words_of_every_limit_are_read() -> None:
    assert LIMITS.keys() <= SETTINGS


def test_grbl_halts_at_all_of_them() -> None:
    grbl = load_printer("generic-grbl")
    assert any("GRBL does not know M204" in f.what for f in check_text("M204 S100\nG1 Z10 F300\n", grbl))
    assert not any(f.line == 1 for f in check_text("G54\nG1 Z10 F300\n", grbl))
