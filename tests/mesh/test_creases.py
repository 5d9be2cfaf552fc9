"""Sharp edges of meshes whose angles are known, and what taking them apart leaves whole."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.creases import split_at_creases, turns
from skinfab.mesh.model import Mesh


@pytest.mark.parametrize("n", [1, 3])
def test_a_cube_turns_by_right_angles_and_falls_apart_into_its_faces(n: int) -> None:
    cube = Mesh(*shapes.cube(n))
    turn = turns(cube)
    sharp = np.abs(turn) > 0.1
    assert sharp.sum() == 12 * n and turn[sharp] == pytest.approx(np.pi / 2) and turn[~sharp] == pytest.approx(0, abs=1e-12)
    apart = split_at_creases(cube)
    assert len(apart.V) == 6 * (n + 1) ** 2 and apart.topology.face_components()[0] == 6
    assert np.array_equal(apart.V[apart.F], cube.V[cube.F])  # face k is face k


def test_from_inside_the_edges_of_a_cube_are_grooves() -> None:
    V, F = shapes.cube()
    turn = turns(Mesh(V, F[:, ::-1]))
    assert turn[np.abs(turn) > 0.1] == pytest.approx(-np.pi / 2)


def test_a_curved_surface_stays_whole_whatever_its_numbers() -> None:
    V, F = shapes.sphere(3)
    sphere = Mesh(*shapes.relabelled(V, F, 5)[:2])
    apart = split_at_creases(sphere)
    assert len(apart.V) == len(sphere.V) and apart.topology.euler == 2
    assert turns(sphere).min() > 0


def test_a_crease_that_ends_amid_a_surface_leaves_its_end_whole() -> None:
    n = 8
    V, F = shapes.grid(n, n)
    V = V * [1, 10, 0]
    # Folded along the middle of the lower half, running out to nothing at the middle.
    V[:, 2] = -2.0 * np.abs(V[:, 0] - 0.5) * np.maximum(0.5 - V[:, 1] / 10, 0.0)
    sheet = Mesh(V, F)
    apart = split_at_creases(sheet)
    assert 0 < len(apart.V) - len(V) <= n / 2
    assert apart.topology.face_components()[0] == 1
