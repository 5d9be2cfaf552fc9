"""Times in closed form and against a planner of small time steps; boxes and counts."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.emit import emit, with_chords
from gcode.estimate import primed, print_time, summarise, timing
from gcode.geometry import Curve, Straight
from gcode.plan import Plan
from gcode.printer import Printer, load_printer
from gcode.program import Dwell, Extrude, Prime, Program, Retract, Travel

A = 500.0


def along(*places: tuple[float, float], speed: float) -> Program:
    return Program("P1", (Travel(x=places[0][0], y=places[0][1], speed=1.0), *(Travel(x=x, y=y, speed=speed) for x, y in places[1:])))


def test_one_move_is_a_trapezoid_or_a_triangle(printer: Printer) -> None:
    assert print_time(along((0, 0), (100, 0), speed=50), printer) == pytest.approx(100 / 50 + 50 / A)
    assert print_time(along((0, 0), (2, 0), speed=50), printer) == pytest.approx(2 * math.sqrt(2 / A))


@given(st.lists(st.floats(0.5, 30), min_size=2, max_size=6), st.floats(1, 200))
def test_cutting_a_line_costs_nothing(parts: list[float], speed: float) -> None:
    ends = np.cumsum([0.0, *parts])
    cut = along(*((float(x), 0.0) for x in ends), speed=speed)
    whole = along((0.0, 0.0), (float(ends[-1]), 0.0), speed=speed)
    assert print_time(cut, load_printer()) == pytest.approx(print_time(whole, load_printer()), rel=1e-6)


def test_reversing_stops_and_a_corner_slows(printer: Printer) -> None:
    there_and_back = print_time(along((0, 0), (50, 0), (0, 0), speed=50), printer)
    assert there_and_back == pytest.approx(2 * (50 / 50 + 50 / A))
    corner = print_time(along((0, 0), (50, 0), (50, 50), speed=50), printer)
    # Junction deviation at 90 degrees: v^2 = a d s / (1 - s), s = sin 45 degrees.
    s = math.sin(math.pi / 4)
    v = math.sqrt(A * printer.motion.junction_deviation * s / (1 - s))
    assert corner == pytest.approx(2 * (50 / 50 + 50 / A) - 2 * (v**2 / (2 * A * 50)) * 1 - 2 * (v / A - v**2 / (A * 50)), rel=1e-6)


def stepped_time(lengths: list[float], joints: list[float], speed: float) -> float:
    """An independent planner: the greatest speed at each of many points that both ways can reach."""
    ds = 0.002
    s = np.arange(0, sum(lengths), ds)
    cap = np.full(len(s) + 1, speed)
    for at, limit in zip(np.cumsum([0.0, *lengths]), [0.0, *joints, 0.0], strict=True):
        k = min(round(at / ds), len(s))
        cap[k] = min(cap[k], limit)
    for k in range(len(s)):
        cap[k + 1] = min(cap[k + 1], math.sqrt(cap[k] ** 2 + 2 * A * ds))
    for k in range(len(s) - 1, -1, -1):
        cap[k] = min(cap[k], math.sqrt(cap[k + 1] ** 2 + 2 * A * ds))
    return float(np.sum(2 * ds / (cap[1:] + cap[:-1])))


@pytest.mark.parametrize("speed", [4.0, 30.0, 120.0])
def test_within_a_tenth_of_an_independent_planner(printer: Printer, speed: float) -> None:
    places = [(0.0, 0.0), (20.0, 0.0), (30.0, 2.0), (31.0, 8.0), (31.0, 8.5), (10.0, 30.0)]
    lengths = [math.dist(a, b) for a, b in itertools.pairwise(places)]
    units = [np.subtract(b, a) / math.dist(a, b) for a, b in itertools.pairwise(places)]
    halves = [math.sqrt((1 + float(u @ v)) / 2) for u, v in itertools.pairwise(units)]
    joints = [math.sqrt(A * printer.motion.junction_deviation * s / (1 - s)) for s in halves]
    assert print_time(along(*places, speed=speed), printer) == pytest.approx(stepped_time(lengths, joints, speed), rel=0.01)


def test_arcs_take_the_time_of_their_fine_chords(planned: Plan, printer: Printer) -> None:
    fine = with_chords(planned.program, tolerance=1e-4)
    assert print_time(fine, printer) == pytest.approx(print_time(planned.program, printer), rel=0.02)


def test_standing_still_counts(printer: Printer) -> None:
    e = 0.5 * printer.pump.e_per_mm3
    rate = printer.pump.e_per_mm3
    assert print_time(Program("P1", (Dwell(2.0), Prime(0.5, 1.0))), printer) == pytest.approx(2.0 + e / rate + rate / A)


def test_slower_acceleration_takes_longer(planned: Plan, printer: Printer) -> None:
    lazy = replace(printer, motion=replace(printer.motion, acceleration=50.0))
    assert print_time(planned.program, lazy) > print_time(planned.program, printer)


def test_summary(planned: Plan, printer: Printer) -> None:
    text = emit(planned.program, printer)
    summary = summarise(planned.program, printer, lines=len(text.splitlines()))
    assert summary.lines == text.count("\n")
    assert summary.arcs == sum(line.startswith(("G2 ", "G3 ")) for line in text.splitlines())
    assert summary.ink_mm3 == planned.program.ink
    assert summary.time_s == print_time(planned.program, printer)


def test_the_box_holds_the_arcs_bulge(printer: Printer) -> None:
    half = Extrude(Curve((10.0, 10.0), (20.0, 10.0), (15.0, 10.0), clockwise=True), 1.0, 4.0)
    line = Extrude(Straight((20.0, 10.0), (22.0, 10.0)), 1.0, 4.0)
    steps = (Travel(z=10.0, speed=5.0), Travel(x=10.0, y=10.0, speed=5.0), Travel(z=1.6, speed=5.0), half, line)
    assert summarise(Program("P1", steps), printer, lines=0).bbox_mm == ((10.0, 10.0, 1.6), (22.0, 15.0, 1.6))
    assert summarise(Program("P1", ()), printer, lines=0).bbox_mm == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


def test_primed_is_the_most_that_is_pushed_beyond_what_is_laid() -> None:
    first = (Prime(25.0, 1.0), Prime(25.0, 1.0))  # at the cleaning place, never drawn back
    to = Travel(x=0.0, y=0.0, speed=1.0)
    pattern = (to, Prime(0.2, 1.0), Extrude(Straight((0.0, 0.0), (9.0, 0.0)), 4.0, 5.0), Retract(0.2, 1.0))
    assert primed(Program("P1", (*first, *pattern, *pattern))) == pytest.approx(50.2)
    assert primed(Program("P1", ())) == 0.0


def test_each_step_has_its_time_and_speeds(planned: Plan, printer: Printer) -> None:
    times = timing(planned.program, printer)
    assert np.allclose(times.start + times.duration, [*times.start[1:], print_time(planned.program, printer)])
    moving = np.flatnonzero(np.isfinite(times.peak))
    assert len(moving) > 20 and (times.duration[moving] > 0).all()
    assert (times.peak >= np.maximum(times.entry, times.leave) - 1e-9)[moving].all()
    for k in moving:
        start, end = times.start[k], times.start[k] + times.duration[k]
        gone = [times.done(int(k), t) for t in np.linspace(start, end, 9)]
        assert gone[0] == 0.0 and gone[-1] == pytest.approx(1.0) and (np.diff(gone) > 0).all()


def test_a_move_speeds_up_and_slows_down(printer: Printer) -> None:
    times = timing(along((0, 0), (100, 0), speed=50), printer)
    ramp = 50 / A
    assert (times.entry[1], times.peak[1], times.leave[1]) == (0.0, 50.0, 0.0)
    assert times.done(1, times.start[1] + ramp) == pytest.approx(50**2 / (2 * A) / 100)
    assert times.done(1, times.start[1] + times.duration[1] / 2) == pytest.approx(0.5)
    assert (times.done(1, -1.0), times.done(1, 1e9)) == (0.0, 1.0)
    waiting = timing(Program("P1", (Dwell(2.0),)), printer)
    assert waiting.done(0, 0.5) == 0.25 and len(timing(Program("P1", ()), printer).start) == 0
