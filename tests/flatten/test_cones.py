"""Cones: Gauss-Bonnet, the corners of polyhedra found, and angles that the flat layout really has."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.cones import ConeField, cone_scale, place_cones
from skinfab.flatten.distortion import measure
from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.seams.cones import cut_through, flatten_with_cones
from skinfab.seams.cut import open_pieces


@pytest.mark.parametrize(("closed", "euler"), [(shapes.sphere, 2), (shapes.torus, 0), (shapes.cube, 2)])
@pytest.mark.parametrize("count", [1, 3, 8])
def test_curvature_of_closed_surfaces_sums_to_2_pi_euler(closed, euler: int, count: int) -> None:
    V, F = closed()
    cones = np.random.default_rng(count).choice(len(V), count, replace=False)
    u, curvature = cone_scale(V, F, cones)
    assert curvature.sum() == pytest.approx(2 * np.pi * euler, abs=1e-9)
    assert (u[cones] == 0).all()


def test_scale_flattens_everything_but_the_cones() -> None:
    """What the linear theory says is left: curvature K + L u is zero off the cones, and with the boundary's sums to 2 pi."""
    V, F = shapes.cap(8)
    cones = np.array([0, 20])
    u, curvature = cone_scale(V, F, cones)
    topology = Topology(F)
    loop = topology.boundary_loops[0]
    corners = intrinsic(V, F)
    bare = np.full(len(V), 2 * np.pi)
    bare[loop] = np.pi
    left = bare - corners.angle_sum + corners.stiffness() @ u
    off = np.setdiff1d(np.arange(len(V)), np.r_[cones, loop])
    np.testing.assert_allclose(left[off], 0, atol=1e-12)
    np.testing.assert_allclose(left[cones], curvature, atol=1e-12)
    assert curvature.sum() + left[loop].sum() == pytest.approx(2 * np.pi, abs=1e-9)
    assert (u[loop] == 0).all()


@pytest.mark.parametrize("surface", [lambda: shapes.cap(12, 2.0), shapes.sphere], ids=["open", "closed"])
def test_flat_layout_has_the_cone_angles(surface) -> None:
    """Laid flat along the cut, the corners about each cone add up to 2 pi less its curvature, in however many places it lies."""
    V, F = surface()
    mesh = Mesh(V, F)
    cones = place_cones(V, F, count=8)
    u, curvature = cone_scale(V, F, cones)
    (piece,) = open_pieces(mesh, cut_through(mesh, cones))
    uv = flatten_disk(V[piece.vertices], piece.F, scale=u[piece.vertices])
    flat = intrinsic(np.column_stack([uv, np.zeros(len(uv))]), piece.F).angle
    angle = np.bincount(piece.vertices[piece.F].ravel(), flat.ravel(), len(V))
    assert np.bincount(piece.vertices)[cones].max() > 1
    np.testing.assert_allclose(angle[cones], 2 * np.pi - curvature, atol=1e-9)


@pytest.mark.parametrize("n", [1, 4])
@pytest.mark.parametrize("count", [8, None])
def test_cubes_cones_are_its_corners(n: int, count: int | None) -> None:
    V, F = shapes.cube(n)
    cones = place_cones(V, F, count=count)
    assert sorted(cones.tolist()) == np.flatnonzero(np.isin(V, [0, 1]).all(axis=1)).tolist()
    _, curvature = cone_scale(V, F, cones)
    np.testing.assert_allclose(curvature, np.pi / 2, atol=1e-9)


def test_dodecahedrons_cones_are_its_corners() -> None:
    mesh = shapes.object_mesh("dodecahedron")
    cones = place_cones(mesh.V, mesh.F, count=20)
    assert sorted(cones.tolist()) == list(range(20)) == list(range(len(mesh.V)))
    np.testing.assert_allclose(cone_scale(mesh.V, mesh.F, cones)[1], np.pi / 5, atol=1e-6)


def test_more_cones_leave_less_scale() -> None:
    V, F = shapes.sphere(3)
    worst = [np.abs(cone_scale(V, F, place_cones(V, F, count=k))[0]).max() for k in (2, 8, 32)]
    assert worst[2] < worst[1] < worst[0]


@pytest.mark.parametrize(
    "surface", [shapes.sphere(3), shapes.torus(), shapes.cap(8, 2.8), shapes.cube(4)], ids=["sphere", "torus", "cap", "cube"]
)
def test_cones_added_one_by_one_give_the_factors_of_all_at_once(surface) -> None:
    V, F = surface
    field = ConeField(V, F, Topology(F))
    given = len(field.cones)
    for added in range(1, 8 - given + 1):
        field.add(field.worst)
        assert (field.factorisations, field.solves) == (1, 1 + added)
    assert len(set(field.cones)) == 8
    np.testing.assert_allclose(field.u, cone_scale(V, F, np.array(field.cones))[0], atol=1e-11)


def test_the_mean_d_told_beforehand_is_the_layouts() -> None:
    for mesh in (Mesh(*shapes.torus()), Mesh(*shapes.cap(24, 2.0))):
        field = ConeField(mesh.V, mesh.F, mesh.topology)
        while len(field.cones) < 6:
            field.add(field.worst)
        _, piece, uv, _ = flatten_with_cones(mesh, cones=np.array(field.cones))
        assert field.mean_d - 4 == pytest.approx(measure(mesh.V[piece.vertices], piece.F, uv).mean - 4, rel=0.05)


def test_factors_beyond_all_numbers_are_only_bad() -> None:
    """A pipe of 1 by 600 with one open end, its curvature at the other: e^u runs past what a number holds."""
    around, along = 12, 1200
    a = 2 * np.pi * np.arange(around) / around
    V = np.array([[np.cos(t), np.sin(t), z / 2] for z in range(along + 1) for t in a] + [[0.0, 0, -0.5]])
    F = [[z * around + i, z * around + (i + 1) % around, z * around + i + around] for z in range(along) for i in range(around)]
    F += [
        [z * around + (i + 1) % around, z * around + (i + 1) % around + around, z * around + i + around]
        for z in range(along)
        for i in range(around)
    ]
    F += [[len(V) - 1, (i + 1) % around, i] for i in range(around)]
    faces = np.array(F)
    field = ConeField(V, faces, Topology(faces))
    assert np.abs(field.u).max() > 500 and np.isfinite(field.mean_d) and field.mean_d > 1e100
    cones = place_cones(V, faces)
    assert 0 < len(cones) <= 12 and np.abs(cone_scale(V, faces, cones)[0]).max() < 2


@pytest.mark.parametrize("level", [1, 2, 3, 4])
def test_a_sphere_gets_few_cones_however_fine(level: int) -> None:
    """Twelve and a few, as a football has corners; 64 without a price."""
    V, F = shapes.sphere(level)
    cones = place_cones(V, F)
    assert 12 <= len(cones) <= 22 and len(set(cones.tolist())) == len(cones)
    field = ConeField(V, F, Topology(F))
    for cone in cones[1:]:
        field.add(int(cone))
    assert field.mean_d < 4.05
    assert len(place_cones(V, F, count=36)) == 36  # more are to be had


def test_the_number_taken_is_the_cheapest_of_all() -> None:
    for V, F in (shapes.sphere(2), shapes.torus(), shapes.cap(8, 2.8)):
        field = ConeField(V, F, Topology(F))
        first = len(field.cones)
        cost = [field.mean_d + 0.004 * len(field.cones)]
        while len(field.cones) < 64:
            field.add(field.worst)
            cost.append(field.mean_d + 0.004 * len(field.cones))
        assert len(place_cones(V, F)) == first + int(np.argmin(cost))


def test_flat_surfaces_get_no_cone() -> None:
    V, F = shapes.cylinder_sheet()
    assert len(place_cones(V, F)) == 0 and len(place_cones(V, F, count=5)) == 0


@pytest.mark.parametrize("count", [0, -3])
def test_no_cones_cannot_be_placed(count: int) -> None:
    with pytest.raises(InputError, match=f"{count} cones cannot be placed; give at least 1"):
        place_cones(*shapes.sphere(), count=count)


def test_closed_without_cones_is_refused() -> None:
    V, F = shapes.sphere()
    with pytest.raises(InputError, match="closed mesh needs at least one cone"):
        cone_scale(V, F, np.zeros(0, dtype=np.int64))
