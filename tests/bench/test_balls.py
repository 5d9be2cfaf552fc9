"""Balls of any number of triangles."""

import numpy as np
import pytest

from skinfab.bench.balls import bumpy_ball
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh


@pytest.mark.parametrize("triangles", [200, 1000, 5000])
def test_closed_wound_outward_and_of_the_size_asked_for(triangles: int) -> None:
    V, F = bumpy_ball(triangles)
    mesh = Mesh(V, F, "ball")
    assert abs(len(F) / triangles - 1) < 0.2 and len(V) - len(mesh.topology.E) + len(F) == 2
    edges = np.sort(F[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    volume = np.einsum("ij,ij->", V[F[:, 0]], np.cross(V[F[:, 1]], V[F[:, 2]])) / 6
    assert volume == pytest.approx(4 / 3 * np.pi * 30**3, rel=0.15)


def test_the_same_surface_at_every_size() -> None:
    coarse, fine = (Mesh(*bumpy_ball(n), "ball").area for n in (5000, 20000))
    assert coarse == pytest.approx(fine, rel=5e-3)
    areas = Mesh(*bumpy_ball(20000), "ball").face_areas
    assert areas.max() < 6 * areas.min()


def test_sizes_that_are_not_made() -> None:
    with pytest.raises(InputError, match="150 to 4000000"):
        bumpy_ball(10)
