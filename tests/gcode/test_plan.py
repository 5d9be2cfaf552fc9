"""Where the ink goes: the sensors' paths on the bed, in a short order, with no speed beyond a limit."""

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gcode.check import check_program
from gcode.geometry import Curve, Straight
from gcode.plan import Plan, allowed_speed, bed_offset, plan
from gcode.printer import Cleaning, Park, Printer
from gcode.program import PRINT_OVERRUN, Clean, Comment, Dwell, Extrude, Prime, Retract, Travel
from skinfab.errors import InputError, RefusedError
from skinfab.material import Material
from skinfab.paths import Arc, Line, Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.distance import Curves, distance
from skinfab.placement.sensor import Sensor


def extrusions(planned: Plan) -> list[Extrude]:
    return [s for s in planned.program.steps if isinstance(s, Extrude)]


def test_the_piece_is_centred_on_the_real_bed(make_piece: Callable[..., Piece], printer: Printer) -> None:
    assert bed_offset(make_piece(120, 100), printer) == (115.0, 125.0)
    moved = replace(printer, bed=replace(printer.bed, origin=(-3.0, 2.5)))
    assert bed_offset(make_piece(120, 100), moved) == (112.0, 127.5)
    with pytest.raises(RefusedError, match=r"351\.0 mm deep, the bed .* is 350 mm"):
        bed_offset(make_piece(10, 351), printer)


def test_ink_follows_the_sensors(planned: Plan, hairpin: Path, material: Material) -> None:
    assert planned.program.ink == pytest.approx(2 * hairpin.length * material.ink.bead_area_mm2, rel=1e-5)
    first = [s.shape for s in extrusions(planned)]
    expected = hairpin.transformed(angle=0.0, shift=np.add((20, 20), planned.offset))
    samples = expected.point_at(np.linspace(0, 1, 50))
    nearest = [min(abs(math.dist(p, s.point_at(t))) for s in first for t in np.linspace(0, 1, 400)) for p in samples]
    assert max(nearest) < 0.2


@pytest.mark.parametrize("angle", [0.0, 0.7, 3.0])
def test_real_patterns_pass_the_check(make_piece: Callable[..., Piece], printer: Printer, material: Material, angle: float) -> None:
    spiral = ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0)
    strain = StrainLines(l1=60.0, l2=54.0, b=6.0)
    sensors = [Sensor("C1", "P1", spiral, 60, 60, angle, 0), Sensor("S1", "P1", strain, 130, 120, angle, 1)]
    planned = plan(make_piece(220, 220), sensors, printer=printer, material=material)
    assert check_program(planned.program, printer) == ()
    length = sum(s.printed_path.length for s in sensors)
    assert planned.program.ink == pytest.approx(length * material.ink.bead_area_mm2, rel=1e-5)


def test_no_command_asks_for_more_e_than_the_firmware_takes(planned: Plan, printer: Printer) -> None:
    # The 60 mm lines need 240 mm of E each, the firmware takes 200.
    assert max(s.volume * printer.pump.e_per_mm3 for s in extrusions(planned)) <= printer.pump.max_e


def test_each_pattern_is_primed_printed_retracted_and_lifted(planned: Plan, printer: Printer) -> None:
    kinds = [type(s) for s in planned.program.steps]
    assert kinds.count(Prime) == kinds.count(Retract) == 2
    starts = [k for k, s in enumerate(planned.program.steps) if isinstance(s, Comment)]
    for k, begin in enumerate(starts):
        if k + 1 == len(starts):
            break  # the park
        steps = planned.program.steps[begin + 1 : starts[k + 1]]
        assert isinstance(steps[0], Travel) and steps[0].z is None  # above the walls still
        assert steps[1] == Travel(z=printer.heights.print, speed=printer.motion.z_speed)
        assert Travel(z=printer.heights.travel, speed=printer.motion.z_speed) in steps[-2:]
        assert isinstance(steps[-1], Dwell)
        first = next(j for j, s in enumerate(steps) if isinstance(s, Extrude))
        assert isinstance(steps[first - 1], Prime)


def test_entry_and_exit_run_along_the_tangent(make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material) -> None:
    path = Path((Line((0, 0), (20, 0)), Arc((20, 10), 10.0, -math.pi / 2, math.pi / 2)))
    long = replace(printer, process=replace(printer.process, overrun_start=2.0, overrun_end=1.5, print_overrun=1.0))
    planned = plan(make_piece(100, 100), [make_sensor("C1", path, 40, 40)], printer=long, material=material)
    dx, dy = planned.offset
    travels = [(s.x, s.y) for s in planned.program.steps if isinstance(s, Travel) and s.x is not None]
    expected = [(40 + dx - 3, 40 + dy), (40 + dx - 1, 40 + dy), (70 + dx, 50 + dy + 1.5)]
    np.testing.assert_allclose(travels[:-1], expected, atol=1e-4)
    assert planned.program.ink == pytest.approx(material.ink.bead_area_mm2 * (path.length + 1.0), rel=1e-5)
    assert check_program(planned.program, long) == ()
    assert planned.warnings == ()


def test_overruns_stop_where_the_nozzle_would_meet_the_wall_and_say_so(
    make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material
) -> None:
    planned = plan(make_piece(100, 20), [make_sensor("C1", Path((Line((0, 0), (97.3, 0)),)), 1.4, 10)], printer=printer, material=material)
    assert planned.warnings == (
        "C1: start overrun cut from 1 to 0.5 mm, for the mould's wall is near",
        "C1: end overrun cut from 1 to 0.4 mm, for the mould's wall is near",
    )
    assert check_program(planned.program, printer) == ()


def test_the_order_does_not_depend_on_the_input(make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material) -> None:
    line = Path((Line((0, 0), (10, 0)),))
    sensors = [make_sensor(name, line, 20, 10 + y) for name, y in [("A", 0), ("B", 40), ("C", 20)]]
    there, back = (plan(make_piece(60, 80), s, printer=printer, material=material) for s in (sensors, sensors[::-1]))
    assert there == back


def test_speeds_are_lowered_to_each_limit(printer: Printer) -> None:
    fast = replace(
        printer,
        motion=replace(printer.motion, straight_speed=100.0, curve_speed=200.0),
        pump=replace(printer.pump, flow_max=20.0, max_e_speed=400.0),
    )
    line = Straight((0.0, 0.0), (10.0, 0.0))
    half = Curve((0.0, 0.0), (0.4, 0.0), (0.2, 0.0), clockwise=True)
    speed, why = allowed_speed(line, 0.484, fast)
    assert speed == pytest.approx(20 / 0.484) and "flow" in why
    speed, why = allowed_speed(half, 0.484, fast)
    assert speed == pytest.approx(math.sqrt(500 * 0.2)) and "v^2" in why
    speed, why = allowed_speed(line, 0.484, replace(fast, pump=replace(fast.pump, max_e_speed=25.0)))
    assert speed == pytest.approx(6.25, rel=1e-4) and "E axis" in why
    speed, why = allowed_speed(line, 0.01, replace(fast, motion=replace(fast.motion, max_speed=60.0)))
    assert speed == 60 and "printer's limit" in why
    assert allowed_speed(line, 0.484, printer)[1] == "the profile"


def test_the_papers_speeds_are_lowered_and_reported(
    make_piece: Callable, make_sensor: Callable, hairpin: Path, printer: Printer, material: Material
) -> None:
    seed = replace(printer, motion=replace(printer.motion, straight_speed=100.0, curve_speed=200.0))
    planned = plan(make_piece(120, 100), [make_sensor("C1", hairpin, 30, 40)], printer=seed, material=material)
    assert "C1: speed lowered from 100 to 6.198 mm/s on 2 segments by the flow limit of 3 mm^3/s" in planned.warnings
    assert "C1: speed lowered from 200 to 6.198 mm/s on 2 segments by the flow limit of 3 mm^3/s" in planned.warnings
    assert [f for f in check_program(planned.program, seed) if "limit" in f.what and "travel" not in f.what] == []


def test_the_head_parks_above_the_walls_at_the_profiles_place(
    make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material
) -> None:
    line = Path((Line((0, 0), (10, 0)),))
    moved = replace(printer, bed=replace(printer.bed, origin=(-3.0, 2.5)), park=Park(7.0, 300.0))
    planned = plan(make_piece(60, 60), [make_sensor("A", line, 20, 20)], printer=moved, material=material)
    assert planned.program.steps[-2:] == (Comment("park"), Travel(4.0, 302.5, speed=printer.motion.travel_speed))
    heights = [s.z for s in planned.program.steps if isinstance(s, Travel) and s.z is not None]
    assert heights[-1] == printer.heights.travel
    bare = plan(make_piece(60, 60), [make_sensor("A", line, 20, 20)], printer=replace(moved, park=None), material=material)
    assert bare.program.steps == planned.program.steps[:-2]
    assert check_program(planned.program, moved) == check_program(bare.program, moved) == ()


def test_cleaning_after_each_pattern_and_first_ink_there(
    make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material
) -> None:
    clean = replace(printer, cleaning=Cleaning(x=5.0, y=6.0, seconds=3.0, initial_extrude=60.0))
    line = Path((Line((0, 0), (10, 0)),))
    planned = plan(make_piece(60, 60), [make_sensor("A", line, 20, 20), make_sensor("B", line, 20, 30)], printer=clean, material=material)
    steps = planned.program.steps
    assert sum(isinstance(s, Clean) for s in steps) == 3
    first = next(k for k, s in enumerate(steps) if isinstance(s, Clean))
    primes = [s for s in steps[:first] if isinstance(s, Prime)]
    assert len(primes) == 3  # 60 mm^3 are 496 mm of E, the firmware takes 200 at once
    assert sum(p.volume for p in primes) == pytest.approx(60, abs=1e-4)
    assert check_program(planned.program, clean) == ()


def test_wrong_sensors_are_told(make_piece: Callable, make_sensor: Callable, hairpin: Path, printer: Printer, material: Material) -> None:
    with pytest.raises(InputError, match="piece P1 has no sensor"):
        plan(make_piece(50, 50), [], printer=printer, material=material)
    with pytest.raises(InputError, match="C1 lies on piece P2, not on P1"):
        plan(make_piece(50, 50), [make_sensor("C1", hairpin, 0, 0, piece="P2")], printer=printer, material=material)


def test_ink_before_a_path_keeps_off_what_is_printed_later(
    make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material
) -> None:
    """A print-overrun of 6 mm would run across its neighbour, 3 mm away, whichever of the two comes first."""
    along, across = Path((Line((0, 0), (20, 0)),)), Path((Line((0, 0), (0, 20)),))
    long = replace(printer, process=replace(printer.process, print_overrun=6.0))
    for dx in (-3, 23):
        sensors = [make_sensor("A", along, 50, 50), make_sensor("B", across, 50 + dx, 42)]
        planned = plan(make_piece(120, 100), sensors, printer=long, material=material)
        shapes = {"A": [], "B": []}
        pattern = ""
        for step in planned.program.steps:
            if isinstance(step, Comment) and step.text.startswith("pattern "):
                pattern = step.text.split()[1]
            elif isinstance(step, Extrude):
                shapes[pattern].append(step.shape.segment)
        apart = distance(Curves.of_segments(shapes["A"]), Curves.of_segments(shapes["B"]))
        assert apart >= material.ink.bead_width + material.gap - 1e-4, dx


@pytest.mark.parametrize("pad", [0.0, 2.0, 3.0])
@pytest.mark.parametrize("kind", [ContactSpiral, StrainLines])
def test_a_pad_is_no_obstacle_to_the_ink_before_it(
    make_piece: Callable, printer: Printer, material: Material, kind: type[ContactSpiral | StrainLines], pad: float
) -> None:
    """The rows of a pad lie closer than two beads may; ink runs on along its first row all the same, and stays off the conductor."""
    long = replace(printer, process=replace(printer.process, print_overrun=1.0))
    sensor = Sensor("A", "P1", kind(**{**kind.example, "pad": pad}), 60, 80, 0.3, 0)
    planned = plan(make_piece(220, 200), [sensor], printer=long, material=material)
    assert planned.warnings == ()
    assert planned.program.ink == pytest.approx(material.ink.bead_area_mm2 * (sensor.printed_path.length + 1.0), rel=1e-5)
    assert check_program(planned.program, long) == ()
    if pad:
        conductor = sensor.path.transformed(angle=0.0, shift=planned.offset)
        apart = distance(Curves.of_segments([extrusions(planned)[0].shape.segment]), Curves.of_segments(conductor.segments))
        assert apart >= material.ink.bead_width + material.gap - 1e-4


def test_ink_before_a_path_stops_short_of_its_own_conductor_and_says_so(make_piece: Callable, printer: Printer, material: Material) -> None:
    long = replace(printer, process=replace(printer.process, print_overrun=10.0))
    sensor = Sensor("A", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 60, 80, 0.3, 0)
    planned = plan(make_piece(220, 200), [sensor], printer=long, material=material)
    (warning,) = planned.warnings
    assert warning.startswith("A: print-overrun cut from 10 to ") and warning.endswith(" mm, for its own path is near")
    conductor = sensor.path.transformed(angle=0.0, shift=planned.offset)
    apart = distance(Curves.of_segments([extrusions(planned)[0].shape.segment]), Curves.of_segments(conductor.segments))
    assert material.ink.bead_width + material.gap - 1e-4 <= apart < 3.0


@pytest.mark.parametrize("angle", [0.3, 2.0])
@pytest.mark.parametrize("kind", [ContactSpiral, StrainLines])
def test_ink_goes_on_past_a_paths_end(
    make_piece: Callable, printer: Printer, material: Material, kind: type[ContactSpiral | StrainLines], angle: float
) -> None:
    """Along the tangent of the end, after the last of the path and before the retract; whichever end comes last."""
    long = replace(printer, process=replace(printer.process, print_overrun=1.0, print_overrun_end=1.5))
    sensor = Sensor("A", "P1", kind(**kind.example), 60, 80, angle, 0)
    planned = plan(make_piece(220, 200), [sensor], printer=long, material=material)
    assert planned.warnings == () and check_program(planned.program, long) == ()
    assert planned.program.ink == pytest.approx(material.ink.bead_area_mm2 * (sensor.printed_path.length + 2.5), rel=1e-5)
    laid = extrusions(planned)
    first, last = laid[0].shape, laid[-1].shape
    assert (first.length, last.length) == pytest.approx((1.0, 1.5), abs=2e-4)
    np.testing.assert_allclose(last.directions[0], laid[-2].shape.directions[1], atol=1e-3)
    steps = planned.program.steps
    said = [k for k, s in enumerate(steps) if isinstance(s, Comment) and s.text == PRINT_OVERRUN]
    assert [steps[k + 1] for k in said] == [laid[0], laid[-1]]
    assert steps[said[0] + 2] == Comment("path") and isinstance(steps[said[1] + 2], Retract)
    # The end overrun begins where the ink ends.
    out = next(s for s in steps[said[1] :] if isinstance(s, Travel))
    assert math.dist((out.x, out.y), last.end) == pytest.approx(1.0, abs=2e-4)


def test_ink_past_an_end_keeps_off_other_ink_past_an_end(
    make_piece: Callable, make_sensor: Callable, printer: Printer, material: Material
) -> None:
    """Two lines in a row, 10 mm apart: 6 mm of ink past the end of each would meet in the middle."""
    long = replace(printer, process=replace(printer.process, print_overrun=6.0, print_overrun_end=6.0))
    line = Path((Line((0, 0), (20, 0)),))
    planned = plan(make_piece(140, 60), [make_sensor(n, line, x, 30) for n, x in (("A", 30), ("B", 60))], printer=long, material=material)
    assert check_program(planned.program, long) == ()
    (warning,) = [w for w in planned.warnings if "print-overrun" in w]
    assert "for pattern " in warning
    runs = sorted((min(s.start[0], s.end[0]), max(s.start[0], s.end[0])) for s in (e.shape for e in extrusions(planned)))
    gaps = [b[0] - a[1] for a, b in itertools.pairwise(runs) if b[0] - a[1] > 1e-3]
    assert len(gaps) == 1 and gaps[0] >= material.ink.bead_width + material.gap - 1e-4


def test_travel_never_crosses_wet_ink_at_print_height(make_piece: Callable, printer: Printer, material: Material) -> None:
    """Twelve spirals and long overruns: every way below the wall's top is within an overrun of its own pattern."""
    long = replace(printer, process=replace(printer.process, overrun_start=8.0, overrun_end=8.0, print_overrun=4.0))
    spiral = ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0)
    sensors = [Sensor(f"C{k}", "P1", spiral, 40 + 45 * (k % 4), 40 + 45 * (k // 4), 0.9 * k, k) for k in range(12)]
    planned = plan(make_piece(260, 200), sensors, printer=long, material=material)
    assert check_program(planned.program, long) == ()
    ink, z, at = [], 10.0, (0.0, 0.0)
    for step in planned.program.steps:
        if isinstance(step, Extrude):
            ink.append(step.shape.segment)
            at = step.shape.end
        elif isinstance(step, Travel):
            to = (at[0] if step.x is None else step.x, at[1] if step.y is None else step.y)
            z = z if step.z is None else step.z
            if to != at and z < 3.0:
                # What it leaves or enters lies under its first radius of bead; beyond that it is free.
                away = Curves.of_segments([Line(np.array(at) + (np.array(to) - at) * min(0.5 / math.dist(at, to), 1.0), to)])
                assert not ink or distance(away, Curves.of_segments(ink)) > 0.35
            at = to
