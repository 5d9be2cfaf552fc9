"""Primes many times too large are blobs, however well they are retracted; those a little otherwise are not."""

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from gcode.check import check_text
from gcode.emit import emit
from gcode.plan import plan
from gcode.printer import Cleaning, Printer, load_printer
from skinfab.material import Material
from skinfab.paths import Line, Path

HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
LINE = Path((Line((0, 0), (10, 0)),))


@pytest.fixture
def text_of(make_piece: Callable, make_sensor: Callable, material: Material) -> Callable[[Printer], str]:
    """A file of two lines."""

    def text(printer: Printer) -> str:
        sensors = [make_sensor(name, LINE, 20, 20 + 10 * k) for k, name in enumerate("AB")]
        return emit(plan(make_piece(60, 60), sensors, printer=printer, material=material).program, printer)

    return text


def blobs(text: str, printer: Printer) -> list[tuple[int, str, str]]:
    return [(f.line, f.what, f.remedy) for f in check_text(text, printer) if "in one place" in f.what]


@pytest.mark.parametrize(("times", "faults"), [(1, 0), (3, 0), (3.7, 0), (4, 2), (100, 2)])
def test_primes_of_our_own_file_grown_with_their_retracts(text_of: Callable, times: float, faults: int, printer: Printer) -> None:
    e = printer.pump.prime * printer.pump.e_per_mm3
    text, count = re.subn(r"^G1 E(-?)1\.65289", lambda m: f"G1 E{m[1]}{e * times:.5f}", text_of(printer), flags=re.MULTILINE)
    found = check_text(text, printer)
    assert count == 4 and len(found) == faults
    for finding in found:
        assert text.splitlines()[finding.line - 1].startswith(f"G1 E{e * times:.5f}") and finding.pattern
        assert finding.what == f"E{e * times:.6g} is pushed out at standstill in one place, where E6.28012 is the most: it leaves a blob"
        assert finding.remedy == "prime E1.65289 as the printer profile does"


def test_milliseconds_for_seconds_on_grbl(text_of: Callable) -> None:
    grbl = load_printer("generic-grbl")
    text = text_of(grbl).replace("G4 P0.500", "G4 P500")
    found = blobs(text, grbl)
    assert [text.splitlines()[line - 1] for line, _, _ in found] == ["G4 P500"] * 2
    assert {what for _, what, _ in found} == {
        "500 mm^3 is pushed out at standstill in one place, where 1.5 mm^3 is the most: it leaves a blob"
    }
    assert {remedy for _, _, remedy in found} == {"push 0.5 mm^3 as the printer profile does; P of G4 is seconds"}
    assert not check_text(text_of(grbl), grbl)


@pytest.mark.parametrize(
    ("before", "after", "line"),
    [
        ("G1 E160\n" * 5, "G1 E-160\n" * 5, 12),  # told once, where most of it has come out
        ("G1 E2\n" * 3, "G1 E-2\n" * 3, None),
        ("G1 E2\n" * 4, "G1 E-2\n" * 4, 11),
        ("G1 E2\nG1 E-2\n" * 20, "", None),  # never more than 2 at once
        ("G1 E-6\nG0 Z10\nG0 Z1.6\nG1 E12\n", "G1 E-6\n", None),  # half of it only fills the nozzle again
        ("G1 E160\nG1 E-160\n", "", 8),  # drawn back, but it was out
    ],
)
def test_one_standstill_is_judged_as_a_whole(before: str, after: str, line: int | None, printer: Printer) -> None:
    text = f"{HEAD}{before}G1 X110 E40 F240\n{after}G0 Z10 F300\n".replace("G1 E", "G1 F400 E")
    assert [at for at, _, _ in blobs(text, printer)] == ([] if line is None else [line])


def test_the_ball_counts_where_the_profile_primes_nothing(printer: Printer) -> None:
    none = replace(printer, pump=replace(printer.pump, prime=0.0, retract=0.0))
    text = HEAD + "G1 E{0} F400\nG1 X110 E40 F240\nG1 E-{0} F400\nG0 Z10 F300\n"
    assert not check_text(text.format(6.2), none) and len(check_text(text.format(6.4), none)) == 1
    # A wider bead bears more: its own file says how wide.
    wide = "; bead 1.5 mm^2 in cross-section\n" + text.replace("E40", "E124")
    assert not blobs(wide.format(30), none) and blobs(wide.format(36), none)
    more = replace(printer, pump=replace(printer.pump, prime=2.0, retract=2.0))
    assert not blobs(text.format(49), more) and blobs(text.format(50), more)


def test_what_fills_the_nozzle_has_its_own_measure(text_of: Callable, printer: Printer) -> None:
    fills = (
        HEAD.replace("G0 X100", "G0 X5 Y6 F6000\nG0 Z1.6 F300\nG1 E{} F400\nG0 Z10 F300\nG0 X100") + "G1 X110 Y100 E40 F240\nG0 Z10 F300"
    )
    assert not check_text(fills.format(190), printer)  # nobody knows how much it takes
    cleaned = replace(printer, cleaning=Cleaning(5.0, 6.0, 3.0, 2.0))
    assert not check_text(fills.format(49), cleaned)
    ((line, what, remedy),) = blobs(fills.format(50), cleaned)
    assert line == 8 and "where E49.5868 is the most" in what and remedy == "prime E16.5289 as the printer profile does"
    assert not check_text(text_of(cleaned), cleaned)
