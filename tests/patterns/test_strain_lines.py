"""The meander against its closed forms, over hundreds of parameter sets, and its bounds."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.paths import Arc
from skinfab.patterns.base import PatternError
from skinfab.patterns.strain_lines import StrainLines


@st.composite
def meanders(draw: st.DrawFn) -> StrainLines:
    lines = 2 * draw(st.integers(1, 8))
    b = (lines - 1) * draw(st.floats(1.4, 5))
    l2 = b / (lines - 1) + draw(st.floats(0.8, 60))
    return StrainLines(l1=l2 + draw(st.floats(1.4, 20)), l2=l2, b=b, lines=lines)


@settings(max_examples=150, deadline=None)
@given(meanders())
def test_closed_forms(p: StrainLines) -> None:
    path = p.path()
    assert path.length == pytest.approx(p.length, rel=1e-12)
    np.testing.assert_allclose(path.bbox, [[0, 0], [p.l1, p.b]], atol=1e-9)
    np.testing.assert_allclose([path.start, path.end], [[0, 0], [0, p.b]], atol=1e-9)


@settings(max_examples=200, deadline=None)
@given(meanders())
def test_every_turn_is_tangent(p: StrainLines) -> None:
    for line, arc, back in zip(p.path().segments[::2], p.path().segments[1::2], p.path().segments[2::2], strict=False):
        assert isinstance(arc, Arc)
        # Radius at right angles to both lines: the arc leaves and arrives along them.
        assert abs((line.end - line.start) @ (arc.start - arc.centre)) < 1e-9 * line.length
        assert abs((back.end - back.start) @ (arc.end - arc.centre)) < 1e-9 * back.length
        assert (line.end - line.start) @ (back.end - back.start) < 0


def test_the_robot_finger_of_the_paper() -> None:
    p = StrainLines(l1=60, l2=54, b=6)
    assert p.length == pytest.approx(2 * 59 + 2 * 52 + 3 * math.pi)
    assert round(p.path().length, 2) == 231.42


GOOD = {"l1": 60, "l2": 54, "b": 6}


@pytest.mark.parametrize(
    ("change", "parameter", "nearest"),
    [
        ({"lines": 5}, "lines", 4),
        ({"lines": 0}, "lines", 2),
        ({"b": 4.0}, "b", 4.155),
        ({"l2": 2.0}, "l2", 2.785),
        ({"l1": 50.0}, "l1", 55.385),
        ({"b": 6.0, "lines": 6}, "b", 6.925),
    ],
)
def test_a_broken_bound_names_a_value_that_works(change: dict, parameter: str, nearest: float) -> None:
    with pytest.raises(PatternError, match=f"strain-lines: {parameter} is") as fault:
        StrainLines(**{**GOOD, **change})
    assert (fault.value.parameter, fault.value.nearest) == (parameter, pytest.approx(nearest))
    StrainLines(**{**GOOD, **change, parameter: fault.value.nearest})
