"""The spiral against its closed forms, over hundreds of parameter sets, and its bounds."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.paths import Arc, Line
from skinfab.patterns.base import PatternError
from skinfab.patterns.contact_spiral import ContactSpiral


@st.composite
def spirals(draw: st.DrawFn) -> ContactSpiral:
    n, x, l = draw(st.integers(1, 12)), draw(st.floats(1.4, 6)), draw(st.floats(1.4, 12))  # noqa: E741
    s = 2 * ((n + 1) * x + draw(st.floats(0.7, 10)))
    b = draw(st.floats(1.4, 1)) if s - 2 * x < 1.4 else draw(st.floats(1.4, s - 2 * x))
    return ContactSpiral(n=n, x=x, b=b, l=l, s=s, caps=draw(st.booleans()))


@settings(max_examples=150, deadline=None)
@given(spirals())
def test_closed_forms(p: ContactSpiral) -> None:
    path = p.path()
    # Where the upper lead is a tangent, b = s - 2 x, the arcsine keeps half of the digits.
    assert path.length == pytest.approx(p.length, rel=1e-9)
    box = [[0, p.b / 2 - p.s / 2], [p.l + p.s, p.b / 2 + p.s / 2 - p.x]]
    np.testing.assert_allclose(path.bbox, box, atol=1e-7)
    np.testing.assert_allclose([path.start, path.end], [[0, 0], [0, p.b]], atol=1e-7)
    assert sum(isinstance(s, Arc) for s in path.segments) == 2 * p.n + 2 + 2 * p.caps


@settings(max_examples=200, deadline=None)
@given(spirals())
def test_turns_run_into_each_other_without_a_corner(p: ContactSpiral) -> None:
    segments = p.path().segments
    sharp = [k for k, (a, b) in enumerate(itertools.pairwise(segments)) if heading(a, 1) @ heading(b, 0) < 1 - 1e-9]
    links = {1, 2, p.n + 3, p.n + 4} if not p.caps else set()
    # Only where the leads meet the outer turns, and at the square links.
    assert set(sharp) <= {0, len(segments) - 2} | links
    if p.caps:
        assert not set(sharp) & set(range(1, len(segments) - 2))


@settings(max_examples=120, deadline=None)
@given(spirals())
def test_neighbouring_turns_are_one_pitch_apart(p: ContactSpiral) -> None:
    # Along a ray straight down from the bottom centre the turns are bottom arcs only: their radii are one pitch apart.
    bottom = [s.radius for s in p.path().segments if isinstance(s, Arc) and math.isclose(s.centre[0], p.l + p.s / 2)]
    np.testing.assert_allclose(np.diff(sorted(bottom)), p.x, atol=1e-9)


def heading(segment: Line | Arc, at: int) -> np.ndarray:
    if isinstance(segment, Line):
        return (segment.end - segment.start) / segment.length
    angle = segment.start_angle + at * segment.sweep + np.sign(segment.sweep) * np.pi / 2
    return np.array([np.cos(angle), np.sin(angle)])


GOOD = {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 15}


@pytest.mark.parametrize(
    ("change", "parameter", "nearest"),
    [
        ({"n": 4}, "n", 3),
        ({"n": 0}, "n", 1),
        ({"n": 2.4}, "n", 2),
        ({"x": 1.0}, "x", 1.385),
        ({"b": 1.0}, "b", 1.385),
        ({"b": 12.0}, "b", 11.6),
        ({"l": 0.5}, "l", 1.385),
        ({"s": 3.0}, "s", 8.185),
        ({"pad": 1.0}, "pad", 1.57),
        ({"gap": -1.0}, "gap", 0.0),
    ],
)
def test_a_broken_bound_names_a_value_that_works(change: dict, parameter: str, nearest: float) -> None:
    with pytest.raises(PatternError, match=f"contact-spiral: {parameter} is") as fault:
        ContactSpiral(**{**GOOD, **change})
    assert fault.value.parameter == parameter
    assert fault.value.nearest == pytest.approx(nearest, abs=1e-9)
    mended = {**GOOD, **change, parameter: fault.value.nearest}
    if parameter == "s":
        mended["n"] = 1
    ContactSpiral(**mended)


@pytest.mark.parametrize("value", ["wide", float("nan"), float("inf"), True, None])
def test_only_finite_numbers(value: object) -> None:
    with pytest.raises(ValueError, match=r"x is .*finite number"):
        ContactSpiral(**{**GOOD, "x": value})
    with pytest.raises(ValueError, match=r"caps is .*true or false"):
        ContactSpiral(**GOOD, caps=1)
