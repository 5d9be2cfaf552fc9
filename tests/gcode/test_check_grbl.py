"""Commands that GRBL takes but a print in a wet mould does not."""

import pytest

from gcode.check import check_text
from gcode.printer import load_printer

INK = "M3 S242\nG1 X{0} F300\nM5\nG1 Z10\n"
HEAD = "G21\nG90\nG1 Z10 F300\nG1 X50 Y50\nG1 Z1.6\n"
BETWEEN = "G1 X50 Y60\nG1 Z1.6\n"


def found(between: str, after: str = "", before: str = "") -> list[tuple[int, str]]:
    text = before + HEAD + INK.format(60) + between + BETWEEN + INK.format(60) + after
    return [(f.line, f.what) for f in check_text(text, load_printer("generic-grbl"))]


def test_the_sound_file_is_sound() -> None:
    assert not found("", after="M0\nM2\n", before="G54\nG17\nG94\nM0\n")


def test_a_foreign_file_of_modal_lines_is_judged_as_its_long_form() -> None:
    modal = "G21\nG90\nF300\nG1 Z10\nX50 Y50\nZ1.6\nS242\nM3\nX60\nY{0}\nM5\nZ10\n"
    spelt = "G21\nG90\nG1 Z10 F300\nG1 Z10\nG1 X50 Y50\nG1 Z1.6\nM5\nM3 S242\nG1 X60\nG1 Y{0}\nM5\nG1 Z10\n"
    grbl = load_printer("generic-grbl")
    assert not check_text(modal.format(60), grbl)
    assert check_text(modal.format(900), grbl) == check_text(spelt.format(900), grbl) != ()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("M0", "M0 waits for a click in the midst of the ink"),
        ("M1", "M1 waits for a click in the midst of the ink"),
        ("G53 G0 X10", "G53 moves in the machine's own places"),
        ("G55", "G55 moves the origin"),
        ("G28", "G28 goes to a place stored"),
        ("G38.2 Z-5", "G38.2 probes"),
        ("M6", "GRBL does not know M6"),
        ("M84", "GRBL does not know M84"),
        ("G93", "G93 reads F as one over a time"),
    ],
)
def test_planted_faults(line: str, says: str) -> None:
    # After G28 nobody knows the height, which is told at the next travel.
    (at, what), *more = found(line + "\n")
    assert at == 10 and says in what and ["unknown height" in told for _, told in more] == [True] * (line == "G28")
