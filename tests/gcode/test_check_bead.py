"""Ink three times too thick or too thin is found where it is laid; what rounding leaves on a short move is not."""

import pytest

from gcode.check import check_text, judge
from gcode.check_bead import TIMES
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer, load_printer

HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
E = 0.484 * 8.2644628  # mm of E per mm


def found(body: str, printer: Printer, *, area: float | None = None, head: str = HEAD) -> list[tuple[int, str]]:
    judgement = judge(head + body + "G0 Z10 F300\n", printer, bead_area=area)
    return [(f.line, f.what) for f in judgement.findings if "cross-section" in f.what]


@pytest.mark.parametrize("times", [0.1, 0.3, 0.34, 1.0, 2.9, 3.1, 10.0])
def test_one_thick_or_thin_move_in_a_sound_stroke(times: float, printer: Printer) -> None:
    faults = found(f"G1 X110 E{10 * E:.5f} F240\nG1 X115 E{5 * E * times:.5f}\nG1 X120 E{5 * E:.5f}\n", printer)
    if 1 / TIMES <= times <= TIMES:
        assert not faults
    else:
        ((line, what),) = faults
        assert line == 9 and f"{0.484 * times:.3g} mm^2 in cross-section over 5 mm, {times:.2g} of the 0.484 meant" in what


def test_a_short_move_is_named_with_what_it_is_averaged_over(printer: Printer) -> None:
    quarters = [0.25 * E] * 40
    quarters[21] *= 9.9  # 0.25 mm of a mm
    body = "".join(f"G1 X{100.25 + 0.25 * k:.4f} E{e:.5f} F240\n" for k, e in enumerate(quarters))
    ((line, what),) = found(body, printer)
    assert line == 8 + 21 and "its bead is 1.56 mm^2 in cross-section over 1 mm, 3.2 of the 0.484 meant" in what


def test_the_whole_of_a_short_stroke_is_judged(printer: Printer) -> None:
    assert [at for at, _ in found("G1 X100.05 E0.005 F240\n", printer)] == [8]


def test_a_short_move_may_bear_its_neighbours_ink(printer: Printer) -> None:
    many = "".join(f"G1 X{100 + 0.1 * k:.4f} E{0.1 * E * (4 if k % 10 == 0 else 0.667):.5f} F240\n" for k in range(1, 101))
    assert not found(many, printer)
    assert not found(f"G1 X110 E{10 * E:.5f} F240\nG1 X110.01 E0.2\n", printer)


def test_the_files_own_head_says_what_was_meant(printer: Printer, planned: Plan) -> None:
    assert not found("G1 X110 E10 F240\n", printer, area=0.121)
    assert found("G1 X110 E10 F240\n", printer)
    said = "; bead 0.121 mm^2 in cross-section\n"
    assert not found("G1 X110 E10 F240\n", printer, head=said + HEAD)
    assert found("G1 X110 E40 F240\n", printer, head=said + HEAD)
    own = emit(planned.program, printer)
    assert check_text(own, printer) == ()
    thrice = own.replace("; bead 0.484 mm^2", "; bead 0.12 mm^2")
    assert {f.pattern for f in check_text(thrice, printer)} == {"C1", "C2"}


def test_a_file_of_another_process_and_a_spindle_too_fast(planned: Plan) -> None:
    grbl = load_printer("generic-grbl")
    text = emit(planned.program, grbl)
    assert not [f for f in check_text(text, grbl) if "cross-section" in f.what]
    s = next(line for line in text.splitlines() if line.startswith("M3 S2"))
    fault = next(f for f in check_text(text.replace(s, "M3 S900"), grbl) if "cross-section" in f.what)
    assert "change S, or F against it" in fault.remedy
