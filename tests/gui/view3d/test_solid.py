"""Smooth where the surface is, sharp at its creases; closed only where what is behind is hidden."""

import numpy as np
from shapes import cube, cylinder_sheet, sphere

from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh


def test_a_ball_is_smooth_and_a_cube_is_not():
    for shape, share in ((sphere(3), 1.0), (cube(1), 0.0)):
        mesh = Mesh(*shape)
        solid = Solid.of(mesh)
        assert (solid.normal < len(mesh.V)).mean() == share
        corners = solid.normals[solid.normal]
        np.testing.assert_allclose(np.linalg.norm(corners, axis=2), 1, rtol=1e-5)
        assert (np.einsum("mcx,mx->mc", corners, mesh.face_normals) > 0.86).all()


def test_closed_is_closed_and_wound_outward():
    V, F = sphere(2)
    assert Solid.of(Mesh(V, F)).closed
    assert not Solid.of(Mesh(V, F[:, ::-1])).closed  # inside out: the front would be left out
    assert not Solid.of(Mesh(V, F[1:])).closed
    assert not Solid.of(Mesh(*cylinder_sheet())).closed


def test_degenerate_faces_have_finite_normals():
    V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    assert np.isfinite(Solid.of(Mesh(V, np.array([[0, 1, 2], [1, 1, 1]]))).normals).all()


def test_slack_grows_with_the_object_and_by_what_is_asked_for():
    V, F = sphere(1)
    assert Solid.of(Mesh(100 * V, F)).slack == 100 * Solid.of(Mesh(V, F)).slack
    assert Solid.of(Mesh(V, F), slack=2.0).slack > 2
