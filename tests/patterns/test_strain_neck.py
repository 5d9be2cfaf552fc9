"""The meander behind a narrow neck against its closed forms, its bounds, and the peer's two of four and of six lines."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from random_patterns import patterns

from skinfab.paths import Arc, Line
from skinfab.patterns.base import PatternError
from skinfab.patterns.strain_neck import StrainNeck

GOOD = {"l1": 15, "l2": 40, "l3": 32, "b1": 2, "b2": 12}


@settings(max_examples=200, deadline=None)
@given(patterns("strain-neck"))
def test_closed_forms(p: StrainNeck) -> None:
    path, beside = p.path(), (p.b2 - p.b1) / 2
    assert path.length == pytest.approx(p.length, rel=1e-12)
    np.testing.assert_allclose(path.bbox, [[0, -beside], [p.l1 + p.l2, p.b1 + beside]], atol=1e-9)
    np.testing.assert_allclose([path.start, path.end], [[0, 0], [0, p.b1]], atol=1e-9)


@settings(max_examples=120, deadline=None)
@given(patterns("strain-neck"))
def test_lines_and_arcs_take_turns_without_a_corner(p: StrainNeck) -> None:
    segments = p.path().segments
    assert [isinstance(s, Arc) for s in segments] == [bool(k % 2) for k in range(2 * p.lines + 7)]
    for before, after in itertools.pairwise(segments):
        line, arc, joint = (before, after, before.end) if isinstance(before, Line) else (after, before, after.start)
        assert abs((line.end - line.start) @ (joint - arc.centre)) < 1e-9 * line.length
    # No line runs backwards over what came before it: every straight part is at least a bead long.
    assert min(s.length for s in segments if isinstance(s, Line)) >= p.bead - 1e-9


@pytest.mark.parametrize("lines", [4, 6])
def test_corners_are_where_the_peer_has_them(lines: int) -> None:
    l1, l2, l3, b1, b2 = 10.0, 44.0, 30.0, 3.0, 18.0
    r, side = b2 / (2 * (lines - 1)), (b2 - b1) / 2
    pattern = StrainNeck(l1=l1, l2=l2, l3=l3, b1=b1, b2=b2, lines=lines)
    # From the frame of TSDF, whose body begins at y = 0, to that of the lower lead.
    corners = [(l1 - r, side), (l1, side - r), (l1, r), (l1 + r, 0)]
    for k in range(lines - 1):
        x = l1 + l2 - l3 + r if k % 2 else l1 + l2 - r
        corners += [(x, 2 * r * k), (x, 2 * r * (k + 1))]
    corners += [(l1 + r, b2), (l1, b2 - r), (l1, side + b1 + r), (l1 - r, side + b1), (0, side + b1)]
    ends = [s.end for s in pattern.path().segments]
    np.testing.assert_allclose(ends, np.array(corners) - [0, side], atol=1e-9)


@pytest.mark.parametrize(
    ("change", "parameter", "nearest"),
    [
        ({"lines": 2}, "lines", 4),
        ({"lines": 7}, "lines", 6),
        ({"b1": 1.0}, "b1", 1.385),
        ({"b1": 4.0}, "b2", 16.71),  # 3 (b1 + 2 bead): two corners on either side of the leads
        ({"b2": 4.0}, "b2", 10.71),
        ({"b2": 6.9, "lines": 6, "b1": 1.4}, "b2", 6.925),
        ({"l1": 3.0}, "l1", 3.385),
        ({"l3": 4.0}, "l3", 4.785),
        ({"l2": 33.0}, "l2", 33.385),
    ],
)
def test_a_broken_bound_names_a_value_that_works(change: dict, parameter: str, nearest: float) -> None:
    with pytest.raises(PatternError, match=f"strain-neck: {parameter} is") as fault:
        StrainNeck(**{**GOOD, **change})
    assert (fault.value.parameter, fault.value.nearest) == (parameter, pytest.approx(nearest))
    StrainNeck(**{**GOOD, **change, parameter: fault.value.nearest})


def test_length_by_hand() -> None:
    # Leads 2 x 13, neck 2 x 1, long lines 2 x 36, loops 2 x 28, five half-turns of radius 2 and four corners of it.
    assert StrainNeck(**GOOD).length == pytest.approx(26 + 2 + 72 + 56 + 5 * 2 * math.pi)
