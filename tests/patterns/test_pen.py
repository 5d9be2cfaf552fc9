"""The pen goes on where it is, and the way it heads."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.paths import PathError
from skinfab.patterns.pen import Pen

moves = st.lists(st.tuples(st.floats(0.1, 20), st.floats(0.05, 6.2) | st.floats(-6.2, -0.05)), min_size=1, max_size=12)


@given(moves)
def test_the_way_back_comes_home(steps: list[tuple[float, float]]) -> None:
    # Every bend, then turn round and every bend the other way: a test of headings as much as of places.
    pen = Pen()
    for radius, angle in steps:
        pen.bend(radius, angle)
        pen.forward(radius)
    pen.turn(np.pi)
    for radius, angle in reversed(steps):
        pen.forward(radius)
        pen.bend(radius, -angle)
    np.testing.assert_allclose(pen.path.end, 0, atol=1e-9)
    assert pen.path.length == pytest.approx(2 * sum(r * (abs(a) + 1) for r, a in steps))


def test_left_is_positive() -> None:
    pen = Pen()
    pen.forward(5.0)
    pen.bend(2.0, np.pi / 2)
    pen.turn(-np.pi / 2)
    pen.forward(1.0)
    np.testing.assert_allclose(pen.path.segments[1].end, [7, 2], atol=1e-12)
    np.testing.assert_allclose(pen.path.end, [8, 2], atol=1e-12)


def test_nothing_drawn_is_no_path() -> None:
    with pytest.raises(PathError, match="at least one segment"):
        _ = Pen().path
