"""A likeness of a mesh: fewer triangles, each one of the old ones, none far from where it was."""

import numpy as np
import pytest

from skinfab.bench.disks import bumpy_cap
from skinfab.mesh.cluster import clustered
from skinfab.mesh.model import Mesh


@pytest.fixture(scope="module")
def cap():
    return Mesh(*bumpy_cap(60_000))


@pytest.mark.parametrize("faces", [2_000, 10_000, 30_000])
def test_there_are_about_as_many_triangles_as_were_asked_for(cap, faces):
    assert 0.5 * faces < len(clustered(cap, faces=faces).mesh.F) < 1.5 * faces


def test_every_triangle_is_one_of_the_fine_ones_moved_by_less_than_a_cell(cap):
    rough = clustered(cap, faces=10_000)
    moved = rough.mesh.V[rough.mesh.F] - cap.V[cap.F[rough.face]]
    assert np.linalg.norm(moved, axis=2).max() <= np.sqrt(3) * rough.cell
    assert len(np.unique(rough.face)) == len(rough.face)


def test_nothing_is_left_without_area():
    G = clustered(Mesh(*bumpy_cap(5_000)), faces=300).mesh.F
    assert (G != np.roll(G, 1, axis=1)).all()


@pytest.mark.parametrize("mesh", [Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)), Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))])
def test_what_has_no_area_stays_as_it_is(mesh):
    assert clustered(mesh, faces=10).mesh is mesh
