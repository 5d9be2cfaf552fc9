"""Times, places and ink of a program agree with the program, its text and its estimate."""

from dataclasses import replace

import numpy as np
import pytest

from gcode.estimate import print_time
from gcode.piece import piece_program
from gcode.preview import ROLES, strokes
from gcode.printer import Cleaning, load_printer
from gcode.program import Comment, Extrude, Prime, Retract
from gcode.trace import trace
from gui.toolpath.timeline import CHORD_MM, DRAWN, ROLE_NAMES, legend, runs, timeline
from skinfab.material import load_material


def test_it_ends_when_the_estimate_says(program, line):
    assert line.end == pytest.approx(print_time(program.program, program.printer))
    assert (np.diff(line.start) >= 0).all() and line.start[0] == 0.0
    assert len(line) == sum(not isinstance(step, Comment) for step in program.program.steps)


def test_ink_is_that_of_the_program(program, line):
    assert line.ink[-1] == pytest.approx(program.program.ink) and (np.diff(line.ink) >= 0).all()
    assert line.at(-5.0).ink == 0.0 and line.at(1e9).ink == pytest.approx(program.program.ink)
    times = np.linspace(0, line.end, 500)
    assert (np.diff([line.at(t).ink for t in times]) >= 0).all()


def test_the_line_under_the_head_says_where_it_goes(program, line):
    for k, i in enumerate(line.index):
        step, words = program.program.steps[i], line.lines[line.line[k] - 1]
        if isinstance(step, Extrude):
            x, y = step.shape.end
            assert f"X{x:.4f} Y{y:.4f}" in words
            assert line.place[k + 1, :2] == pytest.approx((x, y), abs=1e-9)
    assert (np.diff(line.line) > 0).all()


def test_roles_are_those_of_the_picture(program, line):
    judged = trace(program.text, spindle=program.printer.spindle, motion=program.printer.motion)
    drawn = {s.line: s.role for s in strokes(judged, program.printer) if s.shape is not None or s.role != "cleaning"}
    mine = {int(n): ROLE_NAMES[role] for n, role in zip(line.line, line.role, strict=True)}
    assert drawn.items() <= mine.items() and {"print", "travel", "prime", "retract"} <= set(drawn.values())
    for k, i in enumerate(line.index):
        kind = type(program.program.steps[i])
        if kind in (Prime, Retract):
            assert ROLE_NAMES[line.role[k]] == {Prime: "prime", Retract: "retract"}[kind]
    assert set(DRAWN) == set(ROLES)


def test_patterns_are_named(line):
    inked = {line.patterns[line.pattern[k]] for k in range(len(line)) if ROLE_NAMES[line.role[k]] == "print"}
    assert inked == {"C1", "C2"}
    assert line.patterns[0] == ""


def test_the_head_goes_on_without_jumps(line):
    times = np.linspace(line.start[3], line.end, 4000)
    at = np.array([line.at(t).at for t in times])
    fastest = 1.001 * line.speed.max() * (times[1] - times[0])
    assert np.isfinite(at).all() and np.linalg.norm(np.diff(at, axis=0), axis=1).max() <= fastest * np.sqrt(2)


def test_arcs_are_followed(marlin):
    assert marlin.curves
    k, curve = next(iter(marlin.curves.items()))
    time = float(marlin.start[k] + marlin.timing.duration[marlin.index[k]] / 2)
    now = marlin.at(time)
    assert now.step == k and 0.4 < now.done < 0.6
    assert np.hypot(*(now.at[:2] - curve.centre)) == pytest.approx(curve.radius, abs=1e-9)
    way = marlin.way(k, now.done)
    assert np.hypot(*(way[-1] - now.at[:2])) < 2 * CHORD_MM + 0.01 and way[0] == pytest.approx(curve.start)
    assert np.array_equal(marlin.way(k, 1.0)[-1], marlin.parts[marlin.part_step == k][-1, 1])


def test_what_has_no_way_draws_none(marlin):
    wait = next(k for k in range(len(marlin)) if ROLE_NAMES[marlin.role[k]] == "wait")
    assert marlin.way(wait, 0.5).shape == (0, 2) and marlin.at(float(marlin.start[wait]) + 0.01).role == "wait"


def test_before_homing_nobody_knows_the_place(marlin):
    first = marlin.at(0.0)
    assert np.isfinite(first.at).sum() <= 3 and marlin.place.shape == (len(marlin) + 1, 3)
    assert np.isfinite(marlin.parts).all()


def test_steps_of_lines(line):
    for k in range(0, len(line), 7):
        assert line.step_of_line(int(line.line[k])) == k
    assert line.step_of_line(1) == 0 and line.step_of_line(10**6) == len(line) - 1


def test_runs_are_all_of_it_in_few_lines(line):
    drawn = runs(line)
    assert sum(len(points) - 1 for _, _, points in drawn) == len(line.parts) and len(drawn) < len(line.parts) / 3
    assert [role for role, _, _ in drawn] == sorted((role for role, _, _ in drawn), key=DRAWN.index)
    inked = sum(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() for role, _, points in drawn if role == "print")  # chords
    assert line.amounts["print"][0] * 0.998 < inked <= line.amounts["print"][0] * (1 + 1e-9)


def test_the_legend_counts(program, line):
    said = dict(legend(line))
    primes = sum(isinstance(step, Prime) for step in program.program.steps)
    assert said["prime"] == f"prime {primes} times"
    assert said["print"] == f"print {line.amounts['print'][0]:.0f} mm"
    length = sum(s.shape.length for s in program.program.steps if isinstance(s, Extrude))
    assert line.amounts["print"][0] == pytest.approx(length)


def test_the_box_is_that_of_the_ink(program, line):
    low, high = line.box
    for step in program.program.steps:
        if isinstance(step, Extrude):
            (x0, y0), (x1, y1) = step.shape.bbox
            assert (low - CHORD_MM <= (x0, y0)).all() and (high + CHORD_MM >= (x1, y1)).all()


def test_a_cleaning_is_a_dot_at_its_place(printed):
    printer = load_printer()
    place = Cleaning(x=20.0, y=330.0, seconds=3.0, initial_extrude=1.0)
    path = timeline(piece_program(printed, "P1", printer=replace(printer, cleaning=place), material=load_material()))
    cleaning = [k for k in range(len(path)) if ROLE_NAMES[path.role[k]] == "cleaning" and path.way(k, 1.0).shape == (1, 2)]
    assert cleaning and all(path.way(k, 1.0)[0] == pytest.approx((20.0, 330.0)) for k in cleaning)
    assert any(path.at(float(path.start[k]) + 1.0).role == "cleaning" for k in cleaning)
