"""Every fact about Marlin that the emitter keeps, each on the text itself."""

import itertools
import math
import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcode.emit import emit, with_chords
from gcode.geometry import Straight
from gcode.plan import Plan
from gcode.printer import Printer, load_printer
from gcode.profile import bundled_printers
from gcode.program import Clean, Comment, Dwell, Extrude, Program, Travel, quantised
from skinfab import __version__
from skinfab.tolerances import ARC_RADIUS_MM

ARC = re.compile(r"^G[23] X(\S+) Y(\S+) I(\S+) J(\S+) E(\S+)", re.MULTILINE)


@pytest.fixture(scope="module")
def text(planned: Plan, printer: Printer) -> str:
    return emit(planned.program, printer)


def words(text: str, letter: str) -> list[str]:
    return [w[1:] for line in text.splitlines() for w in line.partition(";")[0].split() if w[0] == letter]


def test_modes_come_in_the_one_order_that_works(text: str) -> None:
    commands = [line.partition(";")[0].strip() for line in text.splitlines()]
    wanted = ["G21", "G90", "M83", "M302 P1", "M220 S100", "M221 S100", "M900 K0", "G28 X Y"]
    assert [c for c in commands if c][: len(wanted)] == wanted
    assert commands.count("G90") == 1  # a later one would make E absolute


def test_the_header_names_what_the_file_was_made_for(text: str, planned: Plan, printer: Printer) -> None:
    header = text.partition("\n; begin\n")[0].splitlines()
    wanted = [
        "; piece P1",
        f"; printer {printer.name}",
        "; ink 8.2644628 mm of E for 1 mm^3",
        "; bead 0.484 mm^2 in cross-section",
        f"; made by skinfab {__version__}",
    ]
    assert header[1:6] == wanted
    assert not re.search(r"20\d\d", "".join(header))  # no date: the same bytes every day
    assert "; bead" not in emit(replace(planned.program, bead_area=None), printer)


def test_arc_centres_belong_to_the_rounded_ends(text: str) -> None:
    at = None
    found = 0
    for line in text.splitlines():
        if arc := ARC.match(line):
            x, y, i, j = map(float, arc.groups()[:4])
            assert at is not None
            centre = at[0] + i, at[1] + j
            assert abs(math.dist((x, y), centre) - math.hypot(i, j)) <= ARC_RADIUS_MM
            found += 1
        if place := re.match(r"G[0123] X(\S+) Y(\S+)", line):
            at = float(place[1]), float(place[2])
    assert found == 6  # two half turns and two full circles, each of those in two halves


def test_never_r_never_z_on_arcs_never_a_full_circle(text: str) -> None:
    assert not re.search(r"^G[23].*[RZ]", text, re.MULTILINE)
    at = None
    for line in text.splitlines():
        place = re.match(r"G[0123] (X\S+ Y\S+)", line)
        if place:
            assert not (line.startswith(("G2 ", "G3 ")) and place[1] == at)
            at = place[1]


def test_numbers_are_plain_with_fixed_decimals(text: str) -> None:
    for letter, decimals in {"X": 4, "Y": 4, "Z": 4, "I": 4, "J": 4, "E": 5, "F": 1}.items():
        found = [w for w in words(text, letter) if w]  # G28 names its axes without a number
        assert found
        assert all(re.fullmatch(rf"-?\d+\.\d{{{decimals}}}", w) for w in found), letter
    assert "G02" not in text and "G03" not in text and "G01" not in text


@pytest.mark.parametrize("home", ["xyz", "xy", "none"])
@pytest.mark.parametrize("name", bundled_printers())
@given(data=st.data())
@settings(max_examples=30, deadline=None)
def test_lines_are_short_and_ascii_on_every_dialect(
    any_program: st.SearchStrategy[Program], data: st.DataObject, name: str, home: str
) -> None:
    program, printer = data.draw(any_program), replace(load_printer(name), name=200 * "é", home=home)
    around = (Comment(data.draw(st.text())), Comment(300 * "x"), Clean(12345.678), Dwell(0.001))
    text = emit(Program(data.draw(st.text()), (*program.steps, *around)), printer)
    assert "home" in text
    assert all(len(line) <= 96 for line in text.encode("ascii").split(b"\n"))


def test_tiny_numbers_have_no_exponent(printer: Printer) -> None:
    program = Program("P1", (Travel(x=1e-5, y=6e-5, speed=1e-9), Extrude(Straight((1e-5, 6e-5), (1.0, 0.0)), 1e-7, 1e-9)))
    assert emit(program, printer).splitlines()[-3:-1] == ["G0 X0.0000 Y0.0001 F0.1", "G1 X1.0000 Y0.0000 E0.00000"]


def test_e_is_relative_positive_and_carries_its_rest(printer: Printer) -> None:
    # A third of a grid step of E each: alone every one would round to nothing.
    step = 1e-5 / 3 / printer.pump.e_per_mm3
    places = [(0.001 * k, 0.0) for k in range(31)]
    extrusions = [Extrude(Straight(a, b), step, 4.0) for a, b in itertools.pairwise(places)]
    text = emit(Program("P1", (Travel(x=0.0, y=0.0, speed=4.0), *extrusions)), printer)
    given_e = [float(w) for w in words(text, "E")]
    assert min(given_e) >= 0
    assert sum(given_e) == pytest.approx(10e-5)


def test_feed_is_mm_per_minute_and_written_once(printer: Printer) -> None:
    program = Program(
        "P1", (Travel(x=0.0, y=0.0, speed=10.0), Travel(x=1.0, speed=10.0), Travel(x=2.0, speed=4.0), Travel(x=3.0, speed=10.0))
    )
    assert words(emit(program, printer), "F") == ["600.0", "240.0", "600.0"]


def test_dwell_is_milliseconds(printer: Printer) -> None:
    assert emit(Program("P1", (Dwell(1.5), Clean(2.0))), printer).splitlines()[-3:-1] == ["G4 P1500", "G4 P2000 ; clean"]


@pytest.mark.parametrize(
    ("policy", "homing", "reason"), [("xyz", ["G28"], "before the mould"), ("xy", ["G28 X Y"], "wet mould"), ("none", [], "by hand")]
)
def test_home_policy_and_its_reason(printer: Printer, policy: str, homing: list[str], reason: str) -> None:
    lines = emit(Program("P1", (Dwell(1.0),)), replace(printer, home=policy)).splitlines()
    assert [line for line in lines if line.startswith("G28")] == homing
    assert any(line.startswith("; home") and reason in line for line in lines)


def test_arcs_as_lines_keep_tolerance_and_ink(planned: Plan, printer: Printer) -> None:
    text = emit(planned.program, printer, arcs="lines")
    assert not re.search(r"^G[23] ", text, re.MULTILINE)
    native = sum(float(w) for w in words(emit(planned.program, printer), "E"))
    assert sum(float(w) for w in words(text, "E")) == pytest.approx(native, abs=1e-4)
    chorded = with_chords(planned.program, tolerance=0.005)
    coarse = with_chords(planned.program, tolerance=0.5)
    assert len(coarse.steps) < len(chorded.steps)


def test_the_same_program_gives_the_same_bytes(planned: Plan, printer: Printer) -> None:
    assert emit(planned.program, printer) == emit(planned.program, printer)
    again = quantised(planned.program, e_per_mm3=printer.pump.e_per_mm3)
    assert emit(again, printer) == emit(planned.program, printer)
