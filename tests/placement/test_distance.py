"""Arc-aware distances against dense sampling, and closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from skinfab.paths import Arc, Line, Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.distance import Curves, distance, distance_within, self_distance

points = st.tuples(st.floats(-20, 20), st.floats(-20, 20))
segments = st.one_of(
    st.builds(Line, points, points).filter(lambda s: s.length > 0.01),
    st.builds(
        Arc,
        centre=points,
        radius=st.floats(0.5, 15),
        start_angle=st.floats(-7, 7),
        sweep=st.floats(0.05, 6.28) | st.floats(-6.28, -0.05),
    ),
)


@settings(max_examples=200, deadline=None)
@given(segments, segments)
def test_two_segments_against_sampling(one: Line | Arc, two: Line | Arc) -> None:
    exact = distance(Curves.of_segments([one]), Curves.of_segments([two]))
    count = 2001
    a, b = (s.point_at(np.linspace(0, 1, count)) for s in (one, two))
    sampled = cKDTree(a).query(b)[0].min()
    # Sampling can only be too large, by no more than half a step of either.
    assert exact <= sampled + 1e-9
    assert exact >= sampled - (one.length + two.length) / (2 * (count - 1)) - 1e-9


@settings(max_examples=40, deadline=None)
@given(st.lists(segments, min_size=1, max_size=12), st.lists(segments, min_size=1, max_size=12))
def test_many_segments_are_the_least_of_all_pairs(ones: list, twos: list) -> None:
    whole = distance(Curves.of_segments(ones), Curves.of_segments(twos))
    pairs = min(distance(Curves.of_segments([a]), Curves.of_segments([b])) for a in ones for b in twos)
    assert whole == pytest.approx(pairs, abs=1e-12)
    assert whole == pytest.approx(distance(Curves.of_segments(twos), Curves.of_segments(ones)), abs=1e-9)


def test_an_arc_is_not_its_chords() -> None:
    # Coarse chords of this ring lie 0.76 mm inside it: they would pass a wall that the ring touches.
    ring = Path((Arc((0, 0), 10.0, math.pi / 8, 2 * math.pi),))
    wall = Curves.of_edges(np.array([[[10.0, -5.0], [10.0, 5.0]]]))
    assert distance(Curves.of_segments(ring.segments), wall) == pytest.approx(0, abs=1e-12)
    chords = ring.point_at(np.linspace(0, 1, 9))
    assert distance(Curves.of_edges(np.stack([chords[:-1], chords[1:]], axis=1)), wall) > 0.7


def test_concentric_and_contained_arcs() -> None:
    def apart(one: Arc, two: Arc) -> float:
        return distance(Curves.of_segments([one]), Curves.of_segments([two]))

    assert apart(Arc((0, 0), 3.0, 0.1, 2.0), Arc((0, 0), 5.0, 1.0, 2.0)) == pytest.approx(2)
    assert apart(Arc((1, 0), 1.0, 0.0, 2 * math.pi), Arc((0, 0), 3.0, 0.0, 2 * math.pi)) == pytest.approx(1)


def test_an_edge_without_length_is_a_point() -> None:
    point = Curves.of_edges(np.array([[[0.0, 3.0], [0.0, 3.0]]]))
    assert distance(point, Curves.of_segments([Line((-1, 0), (1, 0))])) == pytest.approx(3)
    assert distance(point, Curves.of_segments([Arc((0, 0), 1.0, 0.0, 3.0)])) == pytest.approx(2)
    assert distance(Curves.of_edges(np.zeros((0, 2, 2))), point) == math.inf


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 6), st.floats(1.5, 4), st.floats(1.5, 8), st.booleans())
def test_a_spiral_keeps_its_pitch_from_itself(n: int, x: float, b: float, caps: bool) -> None:
    s = 2 * ((n + 1) * x + x / 2 + b)
    spiral = ContactSpiral(n=n, x=x, b=b, l=4, s=s, caps=caps)
    need = min(x, b)
    measured = self_distance(spiral.path(), apart=2 * need)
    assert measured >= need * (1 - 1e-9)
    assert measured <= need * 1.15


def test_self_distance_sees_a_turn_that_is_too_tight() -> None:
    need = 1.385
    fine = StrainLines(l1=30, l2=24, b=3 * need)
    assert self_distance(fine.path(), apart=math.pi / 2 * need) == pytest.approx(need)
    tight = StrainLines(l1=30, l2=24, b=3 * 0.9, bead=0.4, gap=0.5)
    assert self_distance(tight.path(), apart=math.pi / 2 * need) == pytest.approx(0.9)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.floats(1, 8), st.floats(-3, 3)), min_size=2, max_size=7), st.floats(0.5, 4))
def test_self_distance_against_sampling(moves: list[tuple[float, float]], apart: float) -> None:
    at, heading, parts = np.zeros(2), 0.0, []
    for k, (length, turn) in enumerate(moves):
        if k % 2 and abs(turn) > 0.2:
            radius = length / abs(turn)
            centre = at + np.sign(turn) * radius * np.array([-np.sin(heading), np.cos(heading)])
            part = Arc(centre, radius, heading - np.sign(turn) * np.pi / 2, turn)
            heading += turn
        else:
            part = Line(at, at + length * np.array([np.cos(heading), np.sin(heading)]))
        parts.append(part)
        at = part.end
    path = Path(tuple(parts))
    count = int(path.length / 0.02)
    along = np.linspace(0, 1, count + 1)
    xy = path.point_at(along)
    far = np.abs(along[:, None] - along[None]) * path.length
    between = np.hypot(*np.moveaxis(xy[:, None] - xy[None], 2, 0))
    exact = self_distance(path, apart=apart)
    # Never below the truth by more than the sampling; never above what all pairs a little farther apart would give.
    assert exact >= between[far >= apart - 0.02].min(initial=math.inf) - 0.03
    assert exact <= between[far >= apart * 9 / 8 + 0.02].min(initial=math.inf) + 0.03


@pytest.mark.parametrize("reach", [0.5, 3.0, 50.0])
def test_within_reach_is_the_distance_itself(reach: float) -> None:
    rng = np.random.default_rng(5)
    near = 0
    for _ in range(60):
        one, two = (Curves.of_edges(rng.uniform(0, 12, (7, 1, 2)) + rng.uniform(-1, 1, (7, 2, 2)) + rng.uniform(0, 9, 2)) for _ in range(2))
        apart = distance(one, two)
        near += apart < reach
        assert distance_within(one, two, reach) == (apart if apart < reach else np.inf)
    assert near
