"""Arcs against closed forms and against dense sampling: strong, few, and able to fail."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.paths import Arc, PathError

arcs = st.builds(
    Arc,
    centre=st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
    radius=st.floats(0.1, 50),
    start_angle=st.floats(-7, 7),
    sweep=st.floats(0.01, 6.2) | st.floats(-6.2, -0.01),
)


@given(arcs)
def test_bbox_is_exact(arc: Arc) -> None:
    sampled = arc.point_at(np.linspace(0, 1, 20_001))
    low, high = arc.bbox
    assert np.all(sampled >= low - 1e-9) and np.all(sampled <= high + 1e-9)  # holds every point
    np.testing.assert_allclose(sampled.min(0), low, atol=arc.radius * 1e-6)  # and is no larger
    np.testing.assert_allclose(sampled.max(0), high, atol=arc.radius * 1e-6)


@given(arcs, st.floats(1e-4, 0.05))
def test_polyline_keeps_its_tolerance(arc: Arc, tolerance: float) -> None:
    chords = arc.to_polyline(tolerance=tolerance)
    middles = (chords[1:] + chords[:-1]) / 2
    sagitta = arc.radius - np.linalg.norm(middles - arc.centre, axis=1)
    assert sagitta.max() <= tolerance * (1 + 1e-6)


@given(arcs)
def test_reversing_keeps_the_curve(arc: Arc) -> None:
    back = arc.reversed()
    np.testing.assert_allclose(back.point_at([0, 0.3, 1]), arc.point_at([1, 0.7, 0]), atol=1e-9)
    assert back.length == arc.length


@pytest.mark.parametrize(("radius", "sweep", "says"), [(0, 1, "positive"), (1, 0, "one turn"), (1, 7, "one turn")])
def test_impossible_arcs_say_why(radius: float, sweep: float, says: str) -> None:
    with pytest.raises(PathError, match=says):
        Arc((0, 0), radius, 0.0, sweep)
