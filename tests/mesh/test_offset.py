"""The offset surface against shapes whose offset is known."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import folds, offset_mesh, outward_steps
from skinfab.tolerances import OFFSET_MITRE

H = 1.25


def face_moves(mesh: Mesh, V: np.ndarray) -> np.ndarray:
    """How far the corners of each face lie outside the plane it was in, (m, 3) mm."""
    return np.einsum("mcx,mx->mc", V[mesh.F] - mesh.V[mesh.F], mesh.face_normals)


@pytest.mark.parametrize("n", [1, 4])
def test_a_cube_becomes_a_larger_cube(n: int) -> None:
    V, F = shapes.cube(n)
    mesh = Mesh(40 * V, F)
    offset = offset_mesh(mesh, H)
    assert offset.mesh.V == pytest.approx((mesh.V - 20) * (20 + H) / 20 + 20 if n == 1 else offset.mesh.V)
    assert face_moves(mesh, offset.mesh.V) == pytest.approx(H, abs=1e-12)
    assert offset.mesh.area == pytest.approx(6 * 42.5**2) and offset.remarks == ()


def test_steps_along_vertex_normals_would_not_do() -> None:
    V, F = shapes.cube(4)
    mesh = Mesh(40 * V, F)
    import igl

    naive = face_moves(mesh, mesh.V + H * igl.per_vertex_normals(mesh.V, mesh.F))
    assert naive.min() < 0.6 * H  # and the faces are bent: their edges come less far than their middles
    assert naive.max() == pytest.approx(H)


@pytest.mark.parametrize("name", ["dodecahedron", "cylinder", "cube"])
def test_flat_faces_and_round_sides_stay_so(name: str) -> None:
    """A closed cylinder's side, its ends and its rims: every face parallel to where it was, at the distance asked for."""
    mesh = shapes.object_mesh(name)
    offset = offset_mesh(mesh, H)
    assert face_moves(mesh, offset.mesh.V) == pytest.approx(H, abs=1e-9)
    assert offset.mesh.face_normals == pytest.approx(mesh.face_normals, abs=1e-9)


def test_a_sphere_grows_by_the_distance() -> None:
    V, F = shapes.sphere(4)
    mesh = Mesh(8 * V, F)
    radius = np.linalg.norm(offset_mesh(mesh, H).mesh.V, axis=1)
    assert radius == pytest.approx(8 + H, abs=2e-3)  # planes lie inside the sphere by 0.0015 of its radius
    assert offset_mesh(mesh, H).mesh.area / mesh.area == pytest.approx((1 + H / 8) ** 2, rel=1e-3)


def test_the_girth_of_an_open_tube() -> None:
    V, F = shapes.cylinder_sheet(columns=96, radius=8.0, height=60.0)
    mesh = Mesh(V, np.where(F % 97 == 96, F - 96, F))
    rim = np.vstack([offset_mesh(mesh, H).mesh.V[:96]] * 2)[:97]
    assert np.linalg.norm(np.diff(rim, axis=0), axis=1).sum() == pytest.approx(2 * np.pi * (8 + H), rel=1e-3)
    assert offset_mesh(mesh, H).mesh.V[:, 2] == pytest.approx(V[:, 2], abs=1e-12)  # borders move outward, not along


def test_inside_a_ball_there_is_less_room() -> None:
    V, F = shapes.sphere(3)
    inside = Mesh(8 * V, F[:, ::-1].copy())
    assert offset_mesh(inside, H).mesh.area / inside.area == pytest.approx((1 - H / 8) ** 2, rel=3e-3)


def test_no_distance_is_the_mesh_itself() -> None:
    mesh = shapes.object_mesh("cup")
    assert offset_mesh(mesh, 0.0).mesh is mesh


@pytest.mark.parametrize("distance", [-0.1, float("nan"), float("inf")])
def test_what_is_no_distance(distance: float) -> None:
    with pytest.raises(InputError, match=r"offset is .*must be 0 or more"):
        offset_mesh(Mesh(*shapes.cube()), distance)


def test_nothing_and_unused_vertices() -> None:
    assert len(offset_mesh(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)), H).mesh.V) == 0
    V, F = shapes.cube()
    mesh = Mesh(np.vstack([40 * V, [[7.0, 7, 7]]]), F)
    assert offset_mesh(mesh, H).mesh.V[-1].tolist() == [7, 7, 7]


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), scale=st.sampled_from([1e-3, 1.0, 1e3]))
def test_it_turns_and_scales_with_the_object(seed: int, scale: float) -> None:
    V, F = shapes.random_disk(seed, count=40, noise=0.05)
    Q = shapes.rotation(seed)
    W, G, place = shapes.relabelled(scale * V @ Q.T, F, seed)
    turned = outward_steps(Mesh(W, G))
    assert turned[place] == pytest.approx(outward_steps(Mesh(V, F)) @ Q.T, abs=1e-6)
    assert np.linalg.norm(turned, axis=1).max() <= OFFSET_MITRE * (1 + 1e-12)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), noise=st.floats(0, 0.4), distance=st.floats(0.01, 2.0))
def test_rounded_off_never_folds(seed: int, noise: float, distance: float) -> None:
    mesh = Mesh(*shapes.random_disk(seed, count=60, noise=noise))
    offset = offset_mesh(mesh, distance, round_off=True)
    assert not folds(mesh, offset.mesh.V).any() and np.isfinite(offset.mesh.V).all()
