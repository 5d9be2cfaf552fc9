"""Pieces to expect: by closed forms of curvature, and never more than are found."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.auto import find_seams
from skinfab.seams.expect import expected_pieces
from skinfab.seams.judge import Limits


@pytest.mark.parametrize(
    ("surface", "steradians"),
    [
        (shapes.sphere(3), 4 * np.pi),
        (shapes.cap(20, 1.2), 2 * np.pi * (1 - np.cos(1.2))),
        (shapes.torus(3, 1, 48, 24), 0),
        (shapes.cylinder_sheet(), 0),
        (shapes.cone_sheet(), 0),
        (shapes.cube(6), 0),
    ],
    ids=["sphere", "cap", "torus", "cylinder", "cone", "cube"],
)
def test_curvature_of_known_surfaces(surface, steradians: float) -> None:
    """A cap's border row is left out; a sphere's twelve five-armed corners are none."""
    V, F = surface
    found = expected_pieces(Mesh(V, F))
    assert found.curvature_sr == pytest.approx(steradians, rel=0.1, abs=1e-9)
    again = expected_pieces(Mesh(1000 * V @ shapes.rotation(1).T, F))
    assert again.curvature_sr == pytest.approx(found.curvature_sr, abs=1e-9) and again.pieces == found.pieces


def test_tighter_bounds_and_more_components_need_more() -> None:
    V, F = shapes.sphere(3)
    ball = Mesh(V, F)
    assert [expected_pieces(ball, mean).pieces for mean in (4.01, 4.02, 4.05, 4.2)] == [3, 2, 2, 2]  # closed
    assert [expected_pieces(ball, mean).compact for mean in (4.01, 4.02, 4.05, 4.2)] == [7, 5, 3, 2]
    two = expected_pieces(Mesh(np.vstack([V, V + 9]), np.vstack([F, F + len(V)])))
    assert (two.pieces, two.components) == (4, 2)
    open_ones = expected_pieces(Mesh(*shapes.cap(20, 1.2)), 4.001)
    assert (open_ones.pieces, expected_pieces(Mesh(*shapes.cap(20, 1.2)), 4.2).pieces) == (3, 1)


def test_a_fine_mesh_is_that_of_its_shape() -> None:
    V, F = shapes.sphere(5)
    rough = V * (1 + 2e-4 * np.random.default_rng(0).normal(size=len(V)))[:, None]
    assert len(F) > 20_000
    assert expected_pieces(Mesh(rough, F)).curvature_sr == pytest.approx(4 * np.pi, rel=0.05)


@pytest.mark.parametrize("mean", [4.02, 4.1])
def test_never_more_than_simple_pieces_that_are_found(mean: float) -> None:
    V, F = shapes.sphere(2)
    bumpy = Mesh(V * (10 + np.sin(3 * V[:, :1]) + V[:, 1:2] ** 2), F)
    expected = expected_pieces(bumpy, mean)
    assert 1 <= expected.pieces <= len(find_seams(bumpy, Limits(mean=mean), neck=0.1, aim="simplest").pieces)
