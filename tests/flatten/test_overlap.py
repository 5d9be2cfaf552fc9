"""Covered twice, by winding numbers, against the union of the triangles themselves."""

import numpy as np
import pytest
import shapely
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.overlap import overlap_area
from skinfab.mesh.topology import Topology
from skinfab.tolerances import OVERLAP_FRACTION


def by_union(F: np.ndarray, UV: np.ndarray) -> float:
    triangles = shapely.polygons(UV[F])
    return float(shapely.area(triangles).sum() - shapely.area(shapely.union_all(triangles)))


@settings(max_examples=40, deadline=None)
@given(st.floats(0.2, 2.7), st.integers(0, 10_000))
def test_curled_strips_against_the_union(turns: float, seed: int) -> None:
    """Up to 2.7 turns: places covered once, twice and three times."""
    rng = np.random.default_rng(seed)
    wobble = 1 + 0.1 * rng.standard_normal(61)

    def curl(s, t):
        r, a = np.tile(wobble, 4) + 0.5 * t, 2 * np.pi * turns * s
        return np.stack([r * np.cos(a), r * np.sin(a), 0 * s], axis=1)

    V, F = shapes.grid(60, 3, curl)
    UV = V[:, :2]
    area = float(shapely.area(shapely.polygons(UV[F])).sum())
    want = by_union(F, UV)
    for flat in (UV, UV * [-1, 1]):  # a mirrored layout is covered as often
        assert overlap_area(F, flat) == pytest.approx(want, abs=1e-9 * area)
    assert (want > 0.01 * area) if turns > 1.2 else True


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000))
def test_plane_layouts_have_none(seed: int) -> None:
    V, F = shapes.random_disk(seed, 40)
    assert overlap_area(F, V[:, :2]) == 0


def test_holes_are_not_covered() -> None:
    V, F = shapes.holed()
    assert overlap_area(F, V[:, :2]) == 0


def test_two_components_on_each_other() -> None:
    V, F = shapes.grid(4, 4)
    UV = np.vstack([V, V + 0.5])[:, :2]
    assert overlap_area(np.vstack([F, F + len(V)]), UV) == pytest.approx(0.25, abs=1e-12)


@pytest.mark.parametrize("turn", np.linspace(0.1, 6.2, 9))
def test_a_net_that_touches_itself_is_accepted(turn: float) -> None:
    """Eight squares round a ninth that is missing, opened along one edge: both sides of it meet again."""
    cells = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    squares = np.array([corner + c for c in cells], dtype=float)
    points, index = np.unique(squares.reshape(-1, 2), axis=0, return_inverse=True)
    index = index.reshape(8, 4)
    # The last square has its own copies of the two corners it shares with the first.
    shared = np.intersect1d(index[0], index[7])
    for k, v in enumerate(shared):
        index[7][index[7] == v] = len(points) + k
    points = np.vstack([points, points[shared]])
    F = np.vstack([index[:, [0, 1, 2]], index[:, [0, 2, 3]]])
    c, s = np.cos(turn), np.sin(turn)
    noise = 1e-13 * np.random.default_rng(0).standard_normal(points.shape)
    UV = points @ np.array([[c, s], [-s, c]]) + noise
    # The case is real: its outline is not simple.
    assert not shapely.LinearRing(points[Topology(F).boundary_loops[0]]).is_simple
    assert overlap_area(F, UV) <= OVERLAP_FRACTION * 8
    # Pushed over the seam by a tenth, the last square covers a tenth of the first.
    inner = np.isin(np.arange(len(points)), index[7])
    pushed = np.where(inner[:, None], UV + 0.1 * np.array([c, s]) @ np.array([[0, -1], [1, 0]]), UV)
    assert overlap_area(F, pushed) == pytest.approx(by_union(F, pushed), abs=1e-9)
    assert overlap_area(F, pushed) > 0.04


def test_coordinates_that_are_no_numbers() -> None:
    V, F = shapes.grid(3, 3)
    UV = V[:, :2].copy()
    UV[5, 0] = np.nan
    assert np.isnan(overlap_area(F, UV))
