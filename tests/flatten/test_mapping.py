"""Both ways between object and flat piece: the same point to 1e-9 mm, whole crowds of them in a moment."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.mapping import FlatMap
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece


def halves(rings: int = 12) -> tuple[Mesh, list[Piece]]:
    """A cap of 30 mm radius in two pieces: its first faces and the others."""
    V, F = shapes.cap(rings, 1.2)
    mesh = Mesh(30 * V, F)
    inner = mesh.V[F].mean(axis=1)[:, 1] > 0
    pieces = []
    for faces in (np.flatnonzero(inner), np.flatnonzero(~inner)):
        vertices, local = np.unique(F[faces], return_inverse=True)
        local = local.reshape(-1, 3).astype(np.int64)
        pieces.append(Piece(f"P{len(pieces) + 1}", faces, vertices, local, flatten_disk(mesh.V[vertices], local)))
    return mesh, pieces


def crowd(piece: Piece, count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(7)
    return piece.faces[rng.integers(0, len(piece.faces), count)], rng.dirichlet((1, 1, 1), count)


@pytest.mark.parametrize("which", [0, 1])
def test_there_and_back(which: int) -> None:
    mesh, pieces = halves()
    both_ways = FlatMap(mesh, pieces[which])
    faces, weights = crowd(pieces[which], 5000)
    xyz = np.einsum("nk,nkd->nd", weights, mesh.V[mesh.F[faces]])
    uv = both_ways.to_flat(faces, weights)
    back = both_ways.to_object(uv)
    np.testing.assert_array_equal(back.face, faces)
    np.testing.assert_allclose(back.barycentric, weights, atol=1e-9)
    np.testing.assert_allclose(back.xyz, xyz, atol=1e-9)
    np.testing.assert_allclose(both_ways.to_flat(back.face, back.barycentric), uv, atol=1e-9)
    near, away = both_ways.nearest(xyz)
    np.testing.assert_allclose(near, uv, atol=1e-9)
    assert away.max() < 1e-9


def test_corners_are_the_vertices() -> None:
    mesh, (piece, _) = halves()
    corner = np.tile(np.eye(3), (len(piece.faces), 1))
    uv = FlatMap(mesh, piece).to_flat(np.repeat(piece.faces, 3), corner)
    np.testing.assert_array_equal(uv, piece.UV[piece.F.ravel()])


def test_points_above_the_surface_find_their_foot() -> None:
    """Lifted along a face's normal by less than the curvature allows, a point comes back to where it was lifted from."""
    mesh, (piece, _) = halves()
    faces, weights = crowd(piece, 300)
    foot = np.einsum("nk,nkd->nd", weights, mesh.V[mesh.F[faces]])
    both_ways = FlatMap(mesh, piece)
    uv, away = both_ways.nearest(foot + 3 * mesh.face_normals[faces])
    np.testing.assert_allclose(uv, both_ways.to_flat(faces, weights), atol=1e-9)
    np.testing.assert_allclose(away, 3, atol=1e-9)


def test_beside_the_piece_is_nowhere() -> None:
    mesh, (piece, _) = halves()
    beside = FlatMap(mesh, piece).to_object([piece.UV.max(axis=0) + 1, piece.UV[piece.F[0]].mean(axis=0)])
    assert beside.face.tolist() == [-1, piece.faces[0]]
    assert np.isnan(beside.xyz[0]).all() and np.isnan(beside.barycentric[0]).all() and np.isfinite(beside.xyz[1]).all()


def test_a_face_without_area_still_has_its_points() -> None:
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]]), np.array([[0, 1, 2]]))
    piece = Piece("P1", np.arange(1), np.arange(3), mesh.F, mesh.V[:, :2])
    uv, away = FlatMap(mesh, piece).nearest([[2.0, 0, 4]])
    np.testing.assert_allclose(uv, [[2, 0]], atol=1e-12)
    assert away == pytest.approx(4)


def test_no_points_are_no_trouble() -> None:
    mesh, (piece, _) = halves()
    both_ways = FlatMap(mesh, piece)
    assert both_ways.to_flat([], np.zeros((0, 3))).shape == (0, 2)
    assert both_ways.to_object(np.zeros((0, 2))).xyz.shape == (0, 3)
    assert both_ways.nearest(np.zeros((0, 3)))[0].shape == (0, 2)


def test_what_is_not_on_the_piece_is_named() -> None:
    mesh, (piece, other) = halves()
    both_ways = FlatMap(mesh, piece)
    third = np.full((1, 3), 1 / 3)
    with pytest.raises(InputError, match=f"point 0: face {other.faces[0]} is not on piece P1"):
        both_ways.to_flat(other.faces[:1], third)
    for face in (-1, len(mesh.F)):
        with pytest.raises(InputError, match=f"face {face} is not on piece P1"):
            both_ways.to_flat([face], third)
    with pytest.raises(InputError, match="three barycentric weights"):
        both_ways.to_flat(piece.faces[:2], third)
    with pytest.raises(InputError, match="point 1 has a coordinate"):
        both_ways.nearest([[0, 0, 0], [np.nan, 0, 0]])


def test_a_hundred_thousand_points_there_and_back() -> None:
    mesh, (piece, _) = halves(60)
    both_ways = FlatMap(mesh, piece)
    faces, weights = crowd(piece, 100_000)
    back = both_ways.to_object(both_ways.to_flat(faces, weights))
    at = np.einsum("ik,ikj->ij", weights, mesh.V[mesh.F[faces]])
    np.testing.assert_allclose(back.xyz, at, atol=1e-9)


@pytest.mark.parametrize("weights", [[1.0, 1.0, 1.0], [np.nan, 0.5, 0.5], [0.0, 0.0, 0.0]])
def test_weights_that_are_none_are_refused(weights: list[float]) -> None:
    mesh, (piece, _) = halves()
    with pytest.raises(InputError, match="point 0: barycentric weights sum to 1"):
        FlatMap(mesh, piece).to_flat(piece.faces[:1], [weights])
