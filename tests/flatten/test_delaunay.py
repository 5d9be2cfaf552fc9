"""Flipped edges: the surface stays what it was, no weight is negative, and it ends on triangles without area."""

import igl
import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.delaunay import delaunay_corners
from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DELAUNAY_COTANGENT

few = settings(max_examples=25, deadline=None)


def sheared(columns: int = 12, rows: int = 8, by: float = 9.0):
    """A sheet bent one way whose triangles are all obtuse."""
    return shapes.grid(columns, rows, lambda s, t: np.stack([columns * s + by * rows * t, rows * t, np.sin(3 * s)], axis=1))


def edge_weights(corners, V) -> np.ndarray:
    """Half the cotangents' sum over each inner edge of the flipped triangulation, by the vertices it joins."""
    L = corners.stiffness().tocoo()
    inner = (L.row < L.col) & ~(corners.on_border[L.row] & corners.on_border[L.col])
    return -L.data[inner]


@pytest.mark.parametrize("mesh", [sheared(), sheared(20, 5, 3.0), shapes.wavy()], ids=["sheared", "less", "wavy"])
def test_the_matrix_is_libigls_where_no_vertex_runs_out_of_edges(mesh) -> None:
    V, F = mesh
    ours = delaunay_corners(V, F)
    assert (np.sort(ours.F, axis=1) != np.sort(F, axis=1)).any()
    theirs = -igl.intrinsic_delaunay_cotmatrix(V, F)[0].toarray()
    np.testing.assert_allclose(ours.stiffness().toarray(), theirs, atol=1e-7 * np.abs(theirs).max())


@few
@given(st.integers(0, 10_000), st.sampled_from([0.0, 0.1, 1.0]))
def test_no_weight_is_negative_and_no_vertex_is_stripped(seed: int, noise: float) -> None:
    V, F = shapes.random_disk(seed, 80, noise)
    t = delaunay_corners(V, F)
    assert edge_weights(t, V).min() > -1e-6
    # Each edge in two triangles or one, as before; three at least at each inner vertex.
    assert len(t.F) == len(F)
    assert np.bincount(t.F.ravel(), minlength=len(V))[~t.on_border].min() >= 3
    assert (t.F[:, 0] != t.F[:, 1]).all() and (t.F[:, 1] != t.F[:, 2]).all() and (t.F[:, 2] != t.F[:, 0]).all()


@few
@given(st.integers(0, 10_000), st.sampled_from([0.1, 1.0]))
def test_the_surface_stays_what_it_was(seed: int, noise: float) -> None:
    """The angle around each vertex, and the area; triangles keep their side up."""
    V, F = shapes.random_disk(seed, 60, noise)
    before, after = intrinsic(V, F), delaunay_corners(V, F)
    np.testing.assert_allclose(after.angle_sum, before.angle_sum, atol=1e-6)
    p = V[F]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2
    _, b, c = after.length.T
    assert (np.sin(after.angle[:, 0]) * b * c).sum() / 2 == pytest.approx(area, rel=1e-6)


def test_flat_it_is_the_delaunay_triangulation() -> None:
    """No vertex lies inside the circle about a triangle, and every length is the straight line's."""
    V, F = shapes.random_disk(3, 120, 0)
    V = V * [4.0, 1, 0]
    t = delaunay_corners(V, F)
    p = V[t.F][:, :, :2]
    np.testing.assert_allclose(t.length, np.linalg.norm(p[:, [1, 2, 0]] - p[:, [2, 0, 1]], axis=2), rtol=1e-7)
    top = Topology(t.F)
    for f, g in top.EF[~top.is_boundary]:
        other = np.setdiff1d(t.F[g], t.F[f])[0]
        rows = np.column_stack([V[t.F[f]][:, :2] - V[other, :2], ((V[t.F[f]] - V[other]) ** 2).sum(axis=1)])
        assert np.linalg.det(rows) < 1e-9


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_unit_changes_nothing(unit: float) -> None:
    V, F = sheared()
    here, there = delaunay_corners(V, F), delaunay_corners(unit * V, F)
    np.testing.assert_array_equal(here.F, there.F)
    np.testing.assert_allclose(there.length / unit, here.length, rtol=1e-9)


@pytest.mark.parametrize("merge", [(60, 61), (60, 61, 74)], ids=["edge without length", "triangle without size"])
def test_it_ends_on_triangles_without_area(merge) -> None:
    V, F = shapes.wavy()
    V[list(merge)] = V[merge[0]]
    t = delaunay_corners(V, F)
    assert np.isfinite(t.stiffness().data).all() and np.isfinite(t.angle).all()


def test_sharp_weights_stand_where_no_edge_can_go() -> None:
    """A high spike of three triangles: its edges are obtuse from both sides, and stay."""
    a = 2 * np.pi * np.arange(3) / 3
    V = np.vstack([np.column_stack([np.cos(a), np.sin(a), 0 * a]), np.column_stack([3 * np.cos(a), 3 * np.sin(a), 0 * a]), [[0, 0, 0.2]]])
    F = np.array([[0, 1, 6], [1, 2, 6], [2, 0, 6], *([[3 + i, 3 + (i + 1) % 3, i] for i in range(3)])])
    F = np.vstack([F, [[3 + (i + 1) % 3, (i + 1) % 3, i] for i in range(3)]])
    t = delaunay_corners(V, F)
    np.testing.assert_array_equal(t.F[(t.F == 6).any(axis=1)], F[:3])
    assert edge_weights(t, V).min() > -DELAUNAY_COTANGENT
