"""Areas, normals and lengths of a mesh against closed forms."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh


def test_cube() -> None:
    V, F = shapes.cube(3)
    mesh = Mesh(30 * V, F, "cube")
    assert mesh.area == pytest.approx(6 * 900) and repr(mesh) == "Mesh('cube', 56 vertices, 108 faces)"
    np.testing.assert_allclose(mesh.face_areas, 50)
    outward = mesh.V[mesh.F].mean(axis=1) - 15
    np.testing.assert_allclose(np.einsum("ij,ij->i", mesh.face_normals, outward), 15)
    assert set(mesh.edge_lengths.round(9)) == {10.0, round(np.sqrt(200), 9)}
    np.testing.assert_array_equal(mesh.bbox, [[0, 0, 0], [30, 30, 30]])


def test_faces_without_area_have_no_normal() -> None:
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 1, 3]]))
    np.testing.assert_array_equal(mesh.face_normals, [[0, 0, 0], [0, 0, 1]])
    np.testing.assert_array_equal(mesh.face_areas, [0, 0.5])


def test_any_arrays_become_plain_ones() -> None:
    mesh = Mesh(np.asfortranarray(np.eye(3, dtype=np.float32)), np.array([[0, 1, 2]], dtype=np.uint32))
    assert (mesh.V.dtype, mesh.F.dtype) == (np.float64, np.int64)
    assert mesh.V.flags.c_contiguous
