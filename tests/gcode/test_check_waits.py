"""Waits planted into running ink are found; those that our own files have between strokes are none."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from gcode.check import check_text
from gcode.emit import emit
from gcode.plan import plan
from gcode.printer import Cleaning, Printer, load_printer

HEAD = "G28 X Y\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
STROKES = (
    HEAD
    + "{start}G1 X110 E40 F240\n{within}G1 Y110 E40\n{end}G0 Z10 F300\n{lifted}G0 X100 Y120 F6000\nG0 Z1.6 F300\nG1 X110 E40 F240\nG0 Z10\n"
)
PLACES = ("start", "within", "end", "lifted")


def found(printer: Printer, place: str, line: str) -> list[str]:
    faults = check_text(STROKES.format(**{p: f"{line}\n" if p == place else "" for p in PLACES}), printer)
    return [f.what for f in faults]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("G4 S600", "G4 waits 600 s within a stroke"),
        ("G4 P600000", "G4 waits 600 s within a stroke"),
        ("G4 P1 S2", "G4 waits 2 s within a stroke"),
        ("M109 S0", "M109 may wait for a temperature within a stroke"),
        ("M190 R0", "M190 may wait for a temperature within a stroke"),
        ("M192", "M192 may wait for a temperature within a stroke"),
    ],
)
def test_a_wait_within_a_stroke(printer: Printer, line: str, says: str) -> None:
    (what,) = found(printer, "within", line)
    assert what.startswith(says)
    assert not [place for place in PLACES if place != "within" and found(printer, place, line)]


@pytest.mark.parametrize("line", ["G4", "G4 P0", "G4 S0", "M400", "M104 S0"])
def test_what_waits_for_nothing_passes(printer: Printer, line: str) -> None:
    assert not found(printer, "within", line)


def test_ink_at_standstill_does_not_end_a_stroke(printer: Printer) -> None:
    assert found(printer, "within", "G1 E0.5 F60\nG1 E-0.5\nG4 S5")[0].startswith("G4 waits 5 s")
    lifted = found(printer, "within", "G0 Z10 F300\nG4 S5\nG0 Z1.6")
    assert lifted and not [what for what in lifted if "waits" in what]  # it comes down into its own bead


@pytest.mark.parametrize(
    ("way", "count"),
    [
        ("G0 X111 Y100\nG4 P90000\n", 1),  # a stop that is moved a little
        ("G4 P90000\nG0 X111 Y100\n", 1),
        ("G0 X111\nG4 S1\nM109 S0\nG0 X110.5\n", 2),
        ("G0 Z1.7\nG4 S5\nG0 Z1.6\n", 1),  # still within print height
        ("G0 X111\nG0 Z10 F300\nG4 S5\nG0 Z1.6\n", 0),
        ("G0 Z10 F300\nG0 X111\nG0 Z1.6\nG4 S5\n", 0),  # it comes down and the pump settles
        ("G0 X111\nG4 S5\nG0 Z10 F300\nG0 Z1.6\n", 0),  # the stroke ends behind the overrun
    ],
)
def test_only_a_lift_ends_a_stroke(printer: Printer, way: str, count: int) -> None:
    waits = [f for f in found(printer, "within", way.rstrip()) if "within a stroke" in f]
    assert len(waits) == count


@pytest.mark.parametrize(
    ("line", "says"), [("M25", "M25 waits for someone to resume"), ("M226 P1 S1", "M226 waits for a pin"), ("M0", "M0 waits for a click")]
)
def test_waiting_for_somebody_between_strokes_too(printer: Printer, line: str, says: str) -> None:
    for place in ("within", "end", "lifted"):
        (what,) = found(printer, place, line)
        assert what == f"{says} in the midst of the ink, and the silicone sets meanwhile"
    assert not found(printer, "start", line)


@pytest.mark.parametrize(
    ("dwells", "told"),
    [
        ("G4 S600\nG4 S300", []),
        ("G4 S600\nG4 S301", [(11, "G4 waits 301 s more, 901 s in all in the midst of the ink, where 900 is the most")]),
        ("G4 S600\nG0 X120 F6000\nG4 S600\nG4 S600", [(12, "G4 waits 600 s more, 1200 s in all in the midst of the ink")]),  # told once
        ("G4 S1000\nG4 S1000", [(10, "G4 waits 1000 s in the midst of the ink")]),
    ],
)
def test_dwells_add_up_from_ink_to_ink(printer: Printer, dwells: str, told: list[tuple[int, str]]) -> None:
    faults = check_text(STROKES.format(start="", within="", end="", lifted=dwells + "\n"), printer)
    assert [f.line for f in faults] == [line for line, _ in told]
    assert all(f.what.startswith(what) for f, (_, what) in zip(faults, told, strict=True))


def test_dwells_of_two_gaps_do_not_add_up(printer: Printer) -> None:
    more = "G0 X100 Y140 F6000\nG0 Z1.6 F300\nG1 X110 E40 F240\nG0 Z10\n"
    assert not check_text(STROKES.format(start="G4 S600\n", within="", end="", lifted="G4 S600\n") + "G4 S600\n" + more, printer)


def test_grbl_waits_in_seconds() -> None:
    grbl = load_printer("generic-grbl")
    text = "G21\nG90\nG1 Z10 F300\nG1 X50 Y50\nG1 Z1.6\nM3 S242\n{}G1 X60\n{}G1 Y60\nM5\nG1 Z10\nG4 P9\n"
    for wait in ("G4 P0.5\n", "M5\nG4 P0.5\nM3\n"):  # with the pump on, and at rest
        (fault,) = [f for f in check_text(text.format("", wait), grbl) if "within a stroke" in f.what]
        assert fault.what == "G4 waits 0.5 s within a stroke, and ink gathers where the nozzle stands"
    (fault,) = [f for f in check_text(text.format("", "M5\nG4 P1000\nM3\n"), grbl) if "midst" in f.what]
    assert fault.remedy == "shorten it, or take it out; P is seconds"
    # A pump that is let come to speed before the bead is no wait within it.
    assert not [f for f in check_text(text.format("G4 P0.5\n", ""), grbl) if "within a stroke" in f.what]


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-grbl"])
@pytest.mark.parametrize("beyond", [0.0, 1.0])
def test_our_own_waits_are_fine(make_piece: Callable, make_sensor: Callable, hairpin: object, material, name: str, beyond: float) -> None:  # type: ignore[no-untyped-def]
    printer = load_printer(name)
    process = replace(printer.process, pause=5.0, print_overrun=beyond, overrun_start=beyond, overrun_end=beyond)
    printer = replace(printer, process=process, cleaning=Cleaning(5.0, 6.0, 3.0, 0.5, 2.0, 15.0))
    sensors = [make_sensor("C1", hairpin, 20, 20), make_sensor("C2", hairpin, 30, 60, 0.2)]
    text = emit(plan(make_piece(120, 100), sensors, printer=printer, material=material).program, printer)
    assert text.count("G4 P") > 3 and not check_text(text, printer)


def test_a_wait_that_the_profile_asks_for_is_meant(printer: Printer) -> None:
    text = STROKES.format(start="", within="", end="", lifted="G4 S1200\n")
    (fault,) = check_text(text, printer)
    assert fault.line == 10 and "G4 waits 1200 s in the midst of the ink, where 900 is the most" in fault.what
    assert not check_text(text, replace(printer, process=replace(printer.process, pause=1200.0)))
    assert not check_text(text, replace(printer, cleaning=Cleaning(5.0, 6.0, 1200.0, 0.0)))
