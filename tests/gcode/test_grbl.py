"""GRBL's dialect: the pump as spindle, emit and parse the same program, the checks of the others, and LinuxCNC as a witness."""

import itertools
import math
import re
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.check import check_program, check_text
from gcode.emit import emit, on_grid_of
from gcode.estimate import print_time
from gcode.parse import parse
from gcode.plan import Plan, plan
from gcode.printer import Cleaning, Printer, load_printer
from gcode.program import Clean, Extrude, Prime, Program, Retract
from gcode.trace import trace
from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.sensor import Sensor

GRBL = load_printer("generic-grbl")


@pytest.fixture(scope="module")
def on_grbl(make_piece: Callable, material: Material) -> Plan:
    sensors = [
        Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 30, 60, 0.4, 0),
        Sensor("S1", "P1", StrainLines(l1=60.0, l2=54.0, b=6.0), 40, 110, 0.7, 1),
    ]
    return plan(make_piece(160, 170), sensors, printer=GRBL, material=material)


@given(st.data())
def test_emit_and_parse_are_inverse(any_program: st.SearchStrategy[Program], data: st.DataObject) -> None:
    program = on_grid_of(data.draw(any_program), GRBL)
    assert on_grid_of(program, GRBL) == program
    assert parse(emit(program, GRBL)) == program


def test_a_real_plan_passes_and_comes_back(on_grbl: Plan) -> None:
    assert check_program(on_grbl.program, GRBL) == ()
    text = emit(on_grbl.program, GRBL)
    assert parse(text) == on_grbl.program
    assert not re.search(r"^[^;]*\b(E-?\d|M83|M302|M220|M221|M900|G0|G28)", text, re.MULTILINE)
    assert text.splitlines()[-1] == "M2" and max(len(line.partition(";")[0]) for line in text.splitlines()) <= 80


def test_the_ink_is_area_times_length(on_grbl: Plan, material: Material, make_piece: Callable) -> None:
    lengths = sum(s.shape.length for s in on_grbl.program.steps if isinstance(s, Extrude))
    # S has two decimals, so that of 242.00 a step is out by 2e-5 at most.
    assert on_grbl.program.ink == pytest.approx(material.ink.bead_area_mm2 * lengths, rel=3e-5)
    moves = trace(emit(on_grbl.program, GRBL), spindle=GRBL.spindle).moves
    assert math.fsum(m.e for m in moves if m.is_planar) == pytest.approx(on_grbl.program.ink, rel=1e-12)
    assert math.fsum(m.e for m in moves if not m.is_planar) == pytest.approx(0.0, abs=1e-12)  # prime and retract cancel


def test_the_pump_stands_while_the_head_travels(on_grbl: Plan) -> None:
    lines = [line for line in emit(on_grbl.program, GRBL).splitlines() if not line.startswith(";")]
    pump = "M5"
    for before, line in itertools.pairwise(lines):
        pump = line if line.startswith(("M3", "M4", "M5")) else pump
        if line.startswith("G1") and "Z" in line:
            assert pump.startswith("M5"), (before, line)
    assert pump == "M5"


def test_cleaning_and_first_ink(make_piece: Callable, material: Material, hairpin, make_sensor: Callable) -> None:  # type: ignore[no-untyped-def]
    clean = replace(GRBL, cleaning=Cleaning(x=5.0, y=6.0, seconds=3.0, initial_extrude=20.0))
    planned = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=clean, material=material)
    assert check_program(planned.program, clean) == ()
    assert parse(emit(planned.program, clean)) == planned.program
    assert sum(isinstance(s, Clean) for s in planned.program.steps) == 2
    assert [s.volume for s in planned.program.steps if isinstance(s, Prime)] == pytest.approx([20.0, 0.5])
    assert [s.volume for s in planned.program.steps if isinstance(s, Retract)] == [0.5]


HEAD = "G21\nG90\nG17\nG94\nM5\nG1 Z10.0000 F300\nG1 X50 Y50 F1200\nG1 Z1.6 F300\n"
TAIL = "M5\nG1 Z10 F300\nM2\n"


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("M3 S242\nG1 X60 F300\n", None),
        ("M83\nM3 S242\nG1 X60 F300\n", "GRBL does not know M83"),
        ("M302 P1\n", "GRBL does not know M302"),
        ("G1 X60 E4 F300\n", "no E axis"),
        ("G28 X Y\n", "stored in the machine"),
        ("G38.2 Z-5 F100\n", "probes"),
        ("G92 X0\n", "moves the origin"),
        ("G93\n", "one over a time"),
        ("G1 X60 A3 F300\n", "does not know A on G1"),
        ("M3 S1500\nG1 X60 F300\n", "not within 0 and the spindle's 1000"),
        ("M3 S242\nG1 X60 F900\n", None),
        ("M3 S5\nG1 X60 F300\n", "pump is steady"),
        ("M4 S242\nG1 X60 F300\n", "pump runs backwards"),
        ("M3 S242\nG1 X60 F300\nG1 Z10 F300\nG1 X80 F1200\n", "above the greatest print height"),
        ("M3 S242\nG1 X260 F300\n", "bed ends"),
        ("M3 S242\nG3 X60 Y50 I5.2 J0 F300\n", "off the circle"),
        (
            "M3 S100\nG4 P0.5\nM5\nM3 S242\nG1 X60 F300\nM5\nM4 S100\nG4 P0.5\nM5\nM3 S100\nG4 P0.3\nM3 S242\nG1 X70 F300\n",
            "mm^3 of ink less",
        ),
    ],
)
def test_planted_faults(body: str, says: str | None) -> None:
    found = [f.what for f in check_text(HEAD + body + TAIL, GRBL)]
    assert any(says in what for what in found) if says else not found, found


def test_time_stops_where_the_pump_turns(on_grbl: Plan) -> None:
    """GRBL waits for the head to stand before it changes S: never less than without that."""
    without = print_time(on_grbl.program, replace(GRBL, spindle=None))
    assert without < print_time(on_grbl.program, GRBL) < without * 1.05


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"home": "xy"}, "GRBL homes by \\$H"),
        ({"e_per_mm3": 2.0}, "has no E axis"),
        ({"flow_max": 11.0}, "asks for S1100"),
        ({"s_max": 0.0}, "spindle, s_max is 0; it must be more than zero"),
    ],
)
def test_profiles_that_contradict_themselves(tmp_path, change: dict, says: str) -> None:  # type: ignore[no-untyped-def]
    tables = {"home": "", "e_per_mm3": "[pump]\n", "flow_max": "[pump]\n", "s_max": "[spindle]\n"}
    ((key, value),) = change.items()
    own = tmp_path / "own.toml"
    own.write_text(f'extends = "generic-grbl"\n{tables[key]}{key} = {value!r}\n')
    with pytest.raises(InputError, match=says):
        load_printer(own)


def test_no_e_axis_is_no_marlin_printer(tmp_path) -> None:  # type: ignore[no-untyped-def]
    text = (tmp_path / "own.toml", 'extends = "generic-marlin"\n[spindle]\ns_per_flow = 10\ns_max = 1000\n')
    text[0].write_text(text[1])
    with pytest.raises(InputError, match="home is 'xy'"):
        load_printer(text[0])


def test_a_piece_of_a_marlin_printer_is_not_a_grbl_file(planned: Plan, printer: Printer) -> None:
    assert any("GRBL does not know M83" in f.what for f in check_text(emit(planned.program, printer), GRBL))
