"""The program's lines and arcs against the exact paths they come from."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.geometry import Curve, Straight, joined_box, shape_of
from skinfab.paths import Arc

arcs = st.builds(
    Arc,
    centre=st.tuples(st.floats(-300, 300), st.floats(-300, 300)),
    radius=st.floats(0.1, 100),
    start_angle=st.floats(-7, 7),
    sweep=st.floats(0.01, 6.2) | st.floats(-6.2, -0.01),
)


@given(arcs)
def test_a_curve_is_the_arc_it_was_made_from(arc: Arc) -> None:
    curve = shape_of(arc)
    assert isinstance(curve, Curve)
    assert curve.length == pytest.approx(arc.length, rel=1e-9, abs=1e-9)
    assert curve.sweep == pytest.approx(arc.sweep, abs=1e-9)
    np.testing.assert_allclose(curve.bbox, arc.bbox, atol=1e-6)
    np.testing.assert_allclose(curve.point_at(0.37), arc.point_at(0.37), atol=1e-9)
    np.testing.assert_allclose(curve.segment.point_at(0.9), arc.point_at(0.9), atol=1e-9)


@given(arcs, st.integers(1, 9))
def test_parts_lie_on_the_whole(arc: Arc, count: int) -> None:
    curve = shape_of(arc)
    parts = curve.split(count)
    assert [p.start for p in parts[1:]] == [p.end for p in parts[:-1]]
    assert (parts[0].start, parts[-1].end) == (curve.start, curve.end)
    assert math.fsum(p.length for p in parts) == pytest.approx(curve.length)
    np.testing.assert_allclose(joined_box([p.bbox for p in parts]), curve.bbox, atol=1e-6)


@given(arcs, st.floats(1e-4, 0.05))
def test_chords_keep_their_tolerance(arc: Arc, tolerance: float) -> None:
    curve = shape_of(arc)
    assert isinstance(curve, Curve)
    chords, points = curve.chords(tolerance), curve.chord_points(tolerance)
    for chord in chords:
        assert curve.radius - math.dist(chord.point_at(0.5), curve.centre) <= tolerance * (1 + 1e-6) + 1e-9
    np.testing.assert_allclose(points, [chords[0].start, *(chord.end for chord in chords)], atol=1e-9)
    assert (tuple(points[0]), tuple(points[-1])) == (curve.start, curve.end)


@given(arcs)
def test_directions_are_the_limits_of_short_steps(arc: Arc) -> None:
    curve = shape_of(arc)
    first, last = curve.directions
    step = 1e-6
    near_start = np.subtract(curve.point_at(step), curve.start) / (curve.length * step)
    near_end = np.subtract(curve.end, curve.point_at(1 - step)) / (curve.length * step)
    np.testing.assert_allclose(near_start, first, atol=1e-3)
    np.testing.assert_allclose(near_end, last, atol=1e-3)


def test_equal_ends_are_a_full_turn() -> None:
    circle = Curve((1.0, 0.0), (1.0, 0.0), (0.0, 0.0), clockwise=True)
    assert circle.sweep == -math.tau
    assert circle.bbox == ((-1.0, -1.0), (1.0, 1.0))


def test_straight() -> None:
    line = Straight((1.0, 2.0), (4.0, -2.0))
    assert line.length == 5.0
    assert line.bbox == ((1.0, -2.0), (4.0, 2.0))
    assert line.directions[0] == (0.6, -0.8)
    assert line.segment.length == 5.0
    assert [p.length for p in line.split(2)] == [2.5, 2.5]
