"""GRBL's dialect: the pump as spindle, emit and parse the same program, the checks of the others, and LinuxCNC as a witness."""

import itertools
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path as FilePath

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcode.check import check_program, check_text
from gcode.emit import emit, on_grid_of, with_chords
from gcode.estimate import print_time
from gcode.geometry import shape_of
from gcode.grbl import spindle_s
from gcode.parse import parse
from gcode.plan import Plan, plan
from gcode.printer import Cleaning, Printer, Spindle, load_printer
from gcode.program import Clean, Extrude, Prime, Program, Retract, Travel
from gcode.trace import trace
from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.paths import Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import SPINDLE_FRACTION

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
    assert on_grbl.program.ink == pytest.approx(material.ink.bead_area_mm2 * lengths, rel=1e-9)
    moves = trace(emit(on_grbl.program, GRBL), spindle=GRBL.spindle).moves
    assert math.fsum(m.e for m in moves if m.is_planar) == pytest.approx(on_grbl.program.ink, rel=1e-12)
    assert math.fsum(m.e for m in moves if not m.is_planar) == pytest.approx(0.0, abs=1e-12)  # prime and retract cancel


def rates_of(text: str) -> list[float]:
    """S of each turn of the pump, in order."""
    return [float(s) for s in re.findall(r"^M[34] S(\S+)$", text, re.MULTILINE)]


@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_one_bead_is_one_rate(on_grbl: Plan, arcs: str) -> None:
    """Rounded to 0.0001 mm each length is a little off; and chords are shorter than their arc, by its radius. S minds neither."""
    text = emit(on_grbl.program, GRBL, arcs=arcs)  # type: ignore[arg-type]
    # For each of the two patterns: prime, the bead, retract.
    assert rates_of(text) == [100.0, 242.0, 100.0] * 2
    assert len(re.findall("^G1 .*X|^G[23]", text, re.MULTILINE)) > 50


@st.composite
def spindles(draw: st.DrawFn) -> tuple[Printer, float, float]:
    """A printer whose S is anything, and a bead (mm^2) and a speed (mm/s) that take 2 % to 100 % of the greatest S."""
    area, speed = draw(st.floats(0.05, 2.0)), draw(st.floats(0.5, 50.0))
    s_max = draw(st.sampled_from((1.0, 100.0, 255.0, 1000.0, 12345.6)))
    return replace(GRBL, spindle=Spindle(s_max * draw(st.floats(0.02, 1.0)) / (area * speed), s_max)), area, speed


@given(st.data())
@settings(max_examples=300)
def test_rates_are_few_and_the_ink_per_mm_is_kept(any_path: st.SearchStrategy[Path], data: st.DataObject) -> None:
    """Whatever the unit of S, the bead and the speeds: F gives way, by less than a step of the PWM, never beyond what was asked for."""
    printer, area, speed = data.draw(spindles())
    shapes = [shape_of(s) for s in data.draw(any_path).segments]
    speeds = [speed * (1 - data.draw(st.floats(0.0, 0.01))) for _ in shapes]
    steps = [Extrude(shape, area * shape.length, v) for shape, v in zip(shapes, speeds, strict=True)]
    program = on_grid_of(Program("P1", (Travel(*shapes[0].start, speed=20.0), *steps)), printer)
    laid = [s for s in program.steps if isinstance(s, Extrude)]
    for step in laid:
        assert step.volume / step.shape.length == pytest.approx(area, rel=1e-4)
    assert program.ink == pytest.approx(area * math.fsum(s.shape.length for s in laid), rel=1e-4)
    assert program.ink == pytest.approx(area * math.fsum(s.length for s in shapes), rel=1e-4, abs=area * 2e-3 * len(shapes))
    assert max((s.speed for s in laid), default=0.0) <= max(speeds) * (1 + 1e-9)
    assert min((s.speed for s in laid), default=speed) >= min(speeds) * (1 - SPINDLE_FRACTION) * (1 - 1e-4)
    text = emit(program, printer)
    rates = sorted(set(rates_of(text)))
    # Speeds within 1 % span two and a half such steps.
    assert len(rates) <= 3 and all(b > a * (1 + SPINDLE_FRACTION) for a, b in itertools.pairwise(rates))
    assert parse(text) == program and on_grid_of(program, printer) == program
    chords = on_grid_of(with_chords(program, tolerance=0.005), printer)
    assert parse(emit(chords, printer)) == chords
    assert chords.ink == pytest.approx(program.ink, rel=2e-4, abs=area * 1e-4 * len(chords.steps))


def test_eight_bits_are_coarse_as_the_docs_say(on_grbl: Plan) -> None:
    """GRBL 1.1 makes 1 + S / $30 * 254 of S, rounded down; the docs give one step of that as a share of the bundled bead's flow."""
    spindle = GRBL.spindle
    assert spindle is not None
    (s,) = {spindle_s(step, spindle) for step in on_grbl.program.steps if isinstance(step, Extrude)}
    docs = (FilePath(__file__).parents[2] / "docs/printers.md").read_text(encoding="utf-8")
    for s_max in (spindle.s_max, 300.0):
        assert f"{s_max / 254 / s:.1%}".replace("%", " %") in docs
    assert f"S{s:g}" in docs


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
            "holds 0.2 mm^3 less",
        ),
    ],
)
def test_planted_faults(body: str, says: str | None) -> None:
    found = [f.what for f in check_text(HEAD + body + TAIL, GRBL)]
    assert any(says in what for what in found) if says else not found, found


def test_time_stops_where_the_pump_turns(make_piece: Callable, make_sensor: Callable, material: Material, hairpin: Path) -> None:
    """GRBL waits for the head to stand before it changes S: a hairpin with slower curves has four such places."""
    slow = replace(GRBL, motion=replace(GRBL.motion, curve_speed=4.0), pump=replace(GRBL.pump, prime=0.0, retract=0.0))
    program = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 20, 20)], printer=slow, material=material).program
    assert len(rates_of(emit(program, slow))) == 4
    # Three stops at 4 mm/s and 100 mm/s^2, each 0.04 s at least.
    assert print_time(program, slow) > print_time(program, replace(slow, spindle=None)) + 3 * 0.04


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
