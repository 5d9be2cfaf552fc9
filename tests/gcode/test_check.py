"""Every planted fault is found, at its line, and a sound file has none."""

import math
import re
from dataclasses import replace

import pytest

from gcode.check import check_program, check_text
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer

HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
BODY = "G1 X110 Y100 E40 F240\n"
LIFT = "\nG0 Z10 F300\n"


def found(text: str, printer: Printer) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(text, printer)]


def test_a_sound_file_has_no_finding(planned: Plan, printer: Printer) -> None:
    assert check_program(planned.program, printer) == ()
    assert check_text(emit(planned.program, printer, arcs="lines"), printer) == ()
    assert check_text(HEAD + BODY + "G0 Z10 F300", printer) == ()


@pytest.mark.parametrize(
    ("body", "line", "says"),
    [
        ("G0 Z10\nG0 X345 Y100 F6000\nG0 Z1.6 F300\nG3 X345 Y110 I0 J5 E50 F200", 0, None),  # to X350 exactly
        ("G0 Z10\nG0 X345.01 Y100 F6000\nG0 Z1.6 F300\nG3 X345.01 Y110 I0 J5 E50 F200", 11, "reaches X350.0100"),
        ("G0 Z10\nG0 X2 Y100 F6000\nG0 Z1.6 F300\nG2 X2 Y110 I0 J5 E50 F200", 11, "reaches X-3.0000"),
        ("G0 Z10\nG0 X-1 F6000", 9, "begins at X0.0000"),
        ("G0 Z401", 8, "machine ends at Z400.0000"),
        ("G0 Z-0.1", 8, "machine begins at Z0.0000"),
        ("G3 X110 Y100 I5.002 J0 E60 F200", 8, "off the circle"),
        ("G3 X110 Y100 I5.0009 J0 E60 F200", 0, None),
        ("G3 X100 Y100 I5 J0 E120 F200", 8, "full circle"),
        ("G3 X110 Y100 R5 E60 F200", 8, "R form"),
        ("G3 X110 Y100 Z1.65 I5 J0 E60 F200", 8, "Z on an arc"),
        ("G1 X110 Y100 E-40 F240", 8, "negative while the head moves"),
        ("G1 X160 Y100 E240 F240", 8, "beyond the firmware's 200 mm"),
        ("G1 E-240 F240", 8, "beyond the firmware's 200 mm"),
        ("G90\nG1 X110 Y100 E40 F240", 8, "G90 after M83"),
        ("G0 Z1.4 F300\nG1 X110 Y100 E40 F240", 9, "below the least print height"),
        ("G0 Z1.8 F300\nG1 X110 Y100 E40 F240", 9, "above the greatest print height"),
        ("G1 X110 Y100 E40 F480", 8, "limit of the E axis"),
        ("G1 X110 Y100 E12 F3000", 8, "flow of 3"),
        ("G1 X110 Y100 E40 F30", 8, "pump is steady"),
        ("G0 X200 F24000\nG0 Z10 F300", 8, "limit of the printer in X and Y"),
        ("G1 E5 F3000\nG1 X110 Y100 E40 F240", 8, "limit of the E axis"),
        ("G3 X100.2 Y100 I0.1 J0 E0.3 F600", 8, "v^2 <= a R"),
        ("G1 X110 Y100 E40 F240\nG28", 9, "homes Z"),
        ("G1 X110 Y100 E40 F240" + 80 * " " + "S0", 8, "bytes long"),
        ("G1 X110 Y100 E40 F240 ;" + 80 * "x", 0, None),
    ],
)
def test_planted_faults(body: str, line: int, says: str | None, printer: Printer) -> None:
    faults = found(HEAD + body + LIFT, printer)
    if says is None:
        assert not faults
    else:
        assert any(at == line and says in what for at, what in faults), faults


def test_missing_modes(printer: Printer) -> None:
    assert any("M302" in what for _, what in found(HEAD.replace("M302 P1", "") + BODY, printer))
    assert any("no speed" in what for _, what in found("G90\nM83\nM302 P1\nG0 X1 Y1", printer))
    assert any("unknown place" in what for _, what in found("G90\nM83\nM302 P1\nG0 Z1.6 F300\nG1 X5 Y5 E1 F240", printer))
    assert any("unknown height" in what for _, what in found("G90\nM83\nM302 P1\nG0 X1 Y5 F300\nG1 X5 Y5 E16 F240", printer))


def test_the_peers_spiral_that_jumps_to_its_circle(printer: Printer) -> None:
    """The lead stops at x = l although its circle, through (l + s, b/2), meets y = 0 a little before or after that."""
    lead, s, b, x0, y0 = 6.0, 22.0, 3.0, 100.0, 100.0
    centre, radius = (x0 + lead + s / 2, y0 + b / 2), s / 2
    jump = math.dist((x0 + lead, y0), centre) - radius
    assert jump > 0.05
    text = f"G1 X{x0 + lead:.2f} Y{y0:.2f} E24 F240\nG3 X{x0 + lead + s:.2f} Y{y0 + b / 2:.2f} I{s / 2:.2f} J{b / 2:.2f} E132 F240"
    ((line, what),) = found(HEAD + text + LIFT, printer)
    assert line == 9 and f"{jump:.4f} mm off the circle" in what
    # Trimmed to the circle, as this project does, the same arc passes.
    trimmed = centre[0] - math.sqrt(radius**2 - b**2 / 4)
    lead_in = f"G1 X{trimmed:.4f} Y{y0:.4f} E24 F240\n"
    text = f"{lead_in}G3 X{x0 + lead + s:.4f} Y{y0 + b / 2:.4f} I{centre[0] - trimmed:.4f} J{b / 2:.4f} E132 F240"
    assert not found(HEAD + text + LIFT, printer)


def test_a_printer_without_arcs(planned: Plan, printer: Printer) -> None:
    flat = replace(printer, arcs=False)
    assert any("draws no arcs" in f.what for f in check_program(planned.program, flat))
    assert not check_text(emit(planned.program, flat, arcs="lines"), flat)


def test_an_origin_offset_moves_the_bed(planned: Plan, printer: Printer) -> None:
    moved = replace(printer, bed=replace(printer.bed, origin=(-300.0, 0.0)))
    assert any("bed ends at X50.0000" in f.what for f in check_program(planned.program, moved))


def test_homing_z_is_fine_where_the_policy_says_so(printer: Printer) -> None:
    assert not found("G28\n" + HEAD + BODY + LIFT, replace(printer, home="xyz"))


def test_findings_name_the_pattern_and_come_in_order(planned: Plan, printer: Printer) -> None:
    text = emit(planned.program, printer)
    last = text.rindex("G3 ")
    faults = check_text(text[:last] + re.sub("I-?[0-9.]+", "I9.0000", text[last:], count=1), printer)
    assert faults and {f.pattern for f in faults} == {"C2"}
    assert [f.line for f in faults] == sorted(f.line for f in faults)
    assert str(faults[0]).startswith(f"line {faults[0].line}, pattern C2: ")
