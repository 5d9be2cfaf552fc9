"""Regions between sharp edges: the sides of polyhedra, the wall and lids of a cylinder."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.creases import borders, crease_seams, merge_small
from skinfab.seams.cut import open_pieces
from skinfab.seams.weights import dihedral_angles


@pytest.mark.parametrize(("name", "regions"), [("cube", 6), ("dodecahedron", 12), ("cylinder", 3)])
def test_sides_of_machined_shapes(name: str, regions: int) -> None:
    mesh = shapes.object_mesh(name)
    pieces = open_pieces(mesh, crease_seams(mesh))
    assert len(pieces) == regions
    if name != "cylinder":
        for p in pieces:
            np.testing.assert_allclose(mesh.face_normals[p.faces] @ mesh.face_normals[p.faces[0]], 1, atol=1e-6)


def test_a_crease_that_fades_out_parts_nothing() -> None:
    mesh = Mesh(*shapes.grid(8, 8, lambda s, t: np.stack([s, t, np.abs(s - 0.5) * t**2], axis=1)))
    sharp = dihedral_angles(mesh) > np.radians(35)
    assert 2 < sharp.sum() < 8  # part of the way down the middle
    assert not crease_seams(mesh).any()


def test_smooth_shapes_have_none() -> None:
    assert not crease_seams(Mesh(*shapes.sphere(3))).any()


def test_small_regions_join_the_neighbour_of_the_longest_border() -> None:
    V, F = shapes.grid(10, 10)
    x, y = V[F].mean(axis=1)[:, :2].T
    # A strip of a tenth between left and right; its last cell is a region of its own, beside three others.
    label = np.where(x < 0.4, 7, np.where(x < 0.5, 3, 5))
    label[(label == 3) & (y > 0.9)] = 9
    merged = merge_small(Mesh(V, F), label, 0.05)
    strip, speck = (x > 0.4) & (x < 0.5) & (y < 0.9), (x > 0.4) & (x < 0.5) & (y > 0.9)
    assert len(np.unique(merged)) == 3 and len(np.unique(merged[strip])) == 1
    assert merged[speck][0] in (merged[x < 0.4][0], merged[x > 0.5][0], merged[strip][0])
    everything = merge_small(Mesh(V, F), label, 0.2)
    assert len(np.unique(everything)) == 2  # left and right, each 0.4 and 0.5
    # Each edge of the strip is 0.9 or 1 long on both sides; with an uneven border the longer one wins.
    tall = np.where(x < 0.4, 7, np.where((x < 0.5) & (y < 0.3), 3, 5))
    joined = merge_small(Mesh(V, F), tall, 0.05)
    assert joined[(x > 0.4) & (x < 0.5) & (y < 0.3)][0] == joined[x > 0.5][0]  # 0.3 + 0.1 against 0.3


def test_a_component_alone_stays() -> None:
    V, F = shapes.grid(10, 10)
    mesh = Mesh(np.vstack([V, 0.01 * V + 5]), np.vstack([F, F + len(V)]))
    label = np.repeat([0, 1], len(F))
    np.testing.assert_array_equal(merge_small(mesh, label, 0.5), label)
    assert not borders(mesh, label).any()
