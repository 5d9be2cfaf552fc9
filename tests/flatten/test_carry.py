"""Carrying a layout: exact on a plane, of high order on a curved sheet, and true to its side of a seam."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.carry import carrier
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import distortion_of, shaped_areas, singular_values
from skinfab.mesh.decimate import Decimated, decimate


def test_a_linear_layout_of_a_plane_is_carried_exactly() -> None:
    V, F = shapes.grid(30, 30)
    few = decimate(V, F, faces=150)
    A = np.array([[2.0, 0.5], [-1.0, 3.0]])
    np.testing.assert_allclose(carrier(V, few).carry(few.V[:, :2] @ A), V[:, :2] @ A, atol=1e-12)


def test_interpolation_gives_the_nearest_points() -> None:
    V, F = shapes.cap(20, 1.0)
    few = decimate(V, F, faces=200)
    onto = carrier(V, few)
    foot = onto.interpolation @ few.V
    np.testing.assert_allclose(foot + onto.away, V, atol=1e-12)
    # No point of any triangle is nearer: against all of them, sampled.
    rng = np.random.default_rng(1)
    weights = rng.dirichlet(np.ones(3), 60)
    samples = np.einsum("sk,fkd->fsd", weights, few.V[few.F]).reshape(-1, 3)
    for v in rng.integers(0, len(V), 40):
        assert np.linalg.norm(onto.away[v]) <= np.linalg.norm(samples - V[v], axis=1).min() + 1e-12


def test_the_carried_layout_is_near_the_least_d_where_interpolation_flips() -> None:
    V, F = shapes.wavy(60)
    few = decimate(V, F, faces=len(F) // 8)
    flat, onto = flatten_isometric(few.V, few.F), carrier(V, few)
    smooth, linear = (singular_values(V, F, uv) for uv in (onto.carry(flat), onto.interpolation @ flat))
    assert (linear[:, 1] <= 1e-9).any()  # the naive way: every vertex beyond the coarse boundary lands on it
    area = shaped_areas(V, F)[0]
    least, carried = (np.average(distortion_of(s), weights=area) for s in (singular_values(V, F, flatten_isometric(V, F)), smooth))
    assert smooth[:, 1].min() > 0.9 and least <= carried < least + 1e-5


def test_the_two_sides_of_a_seam_are_not_mixed_up() -> None:
    """A cylinder opened along a line: first and last column lie on each other, and go to opposite ends of the sheet."""
    V, F = shapes.cylinder_sheet(96, 40)
    few = decimate(V, F, faces=600)
    turn = np.zeros(len(few.V))
    column = np.arange(len(V)) % 97
    np.maximum.at(turn, few.onto, column / 96.0)
    carried = carrier(V, few).carry(np.stack([turn, few.V[:, 2]], axis=1))[:, 0]
    np.testing.assert_allclose(V[column == 0], V[column == 96], atol=1e-12)
    assert carried[column == 0].max() < 0.2 and carried[column == 96].min() > 0.8


@pytest.mark.filterwarnings("error")
def test_coarse_triangles_without_area_are_walked_past() -> None:
    V = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 0]])
    F = np.array([[0, 1, 4], [1, 2, 4], [0, 4, 2], [0, 2, 3]])  # the third has no area
    found = carrier(np.array([[1.5, 0.5, 0.25]]), Decimated(V, F, np.array([4])))
    assert found.face.tolist() != [2]
    np.testing.assert_allclose(found.carry(V[:, :2]), [[1.5, 0.5]], atol=1e-12)
