"""On a mesh: the same as on the dome it approximates, watertight along edges, and as a search through all triangles says."""

import numpy as np
import pytest
import trimesh

from skinfab.errors import InputError
from skinfab.fingertip.force.contact import locate
from skinfab.fingertip.force.contact_mesh import TipMesh
from skinfab.mesh.model import Mesh


def ball(subdivisions: int, radius: float = 20.0) -> Mesh:
    import trimesh

    made = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return Mesh(made.vertices, made.faces, "ball")


def cross_shape() -> Mesh:
    """A letter U of 12 x 4 x 8 mm: a line along x goes in twice."""
    outline = np.array([(0, 0), (12, 0), (12, 8), (8, 8), (8, 3), (4, 3), (4, 8), (0, 8.0)])
    n = len(outline)
    V = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (0.0, 4.0)])
    top = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    F = [(a + n, b + n, c + n) for a, b, c in top] + [(a, c, b) for a, b, c in top]
    for k in range(n):
        j = (k + 1) % n
        F += [(k, j, j + n), (k, j + n, k + n)]
    return Mesh(V, np.array(F), "U")


def lines(n: int, reach: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    force = rng.standard_normal((n, 3))
    force /= np.linalg.norm(force, axis=1)[:, None]
    return force, np.cross(rng.uniform(-reach, reach, (n, 3)), force)


def test_a_fine_ball_is_a_dome() -> None:
    force, moment = lines(3000, 12)
    dome, mesh = locate(force, moment), locate(force, moment, TipMesh(ball(5)))
    same = ~dome.missed  # the ball goes on below the rim
    assert same.sum() > 1000
    assert np.linalg.norm(dome.point - mesh.point, axis=1)[same].max() < 0.05
    np.testing.assert_allclose(dome.sd_mm[same], mesh.sd_mm[same], rtol=0.1)
    assert not mesh.flags[same].any()


def all_entries(mesh: Mesh, q: np.ndarray, d: np.ndarray) -> list[float]:
    """Depths at which a line goes in, triangle by triangle (Moeller and Trumbore 1997)."""
    a, b, c = (mesh.V[mesh.F[:, k]] for k in range(3))
    across = np.cross(d, c - a)
    det = np.einsum("ij,ij->i", b - a, across)
    u = np.einsum("ij,ij->i", q - a, across) / det
    other = np.cross(q - a, b - a)
    v = other @ d / det
    depth = np.einsum("ij,ij->i", c - a, other) / det
    return sorted(depth[(u >= 0) & (v >= 0) & (u + v <= 1) & (mesh.face_normals @ d < 0)])


def test_the_tree_finds_what_a_search_through_all_triangles_finds() -> None:
    mesh = cross_shape()
    force, moment = lines(2000, 8)
    moment += np.cross([6, 4, 2.0], force)
    found = locate(force, moment, TipMesh(mesh))
    twice = 0
    for k in range(len(force)):
        q = np.cross(force[k], moment[k])
        depths = all_entries(mesh, q, force[k])
        assert found.missed[k] == (not depths) and found.ambiguous[k] == (len(depths) > 1)
        twice += len(depths) > 1
        if depths:
            np.testing.assert_allclose(found.point[k], q + depths[0] * force[k], atol=1e-9)
    assert twice > 30 and found.missed.sum() > 100


def test_the_nearest_point_of_a_line_that_misses() -> None:
    mesh = cross_shape()
    force, moment = lines(500, 30, seed=3)
    found = locate(force, moment, TipMesh(mesh))
    part = np.linspace(0, 1, 201)[:, None]
    ends = mesh.V[mesh.topology.E]
    sampled = (ends[:, :1] * (1 - part) + ends[:, 1:] * part).reshape(-1, 3)
    for k in np.flatnonzero(found.missed):
        off = sampled - np.cross(force[k], moment[k])
        apart = np.linalg.norm(np.cross(off, force[k]), axis=1).min()
        assert apart - 0.05 < found.miss_mm[k] <= apart + 1e-9
    assert found.missed.sum() > 200


def test_no_line_slips_through_an_edge_or_a_corner() -> None:
    mesh = ball(2)
    ends = mesh.V[mesh.topology.E]
    through = np.vstack([mesh.V, ends.mean(axis=1), 0.3 * ends[:, 0] + 0.7 * ends[:, 1]])
    force = -through / np.linalg.norm(through, axis=1)[:, None]
    found = locate(force, np.cross(through, force), TipMesh(mesh))
    assert not found.missed.any() and not found.ambiguous.any()
    np.testing.assert_allclose(found.point, through, atol=1e-9)


def test_triangles_without_area_do_no_harm() -> None:
    mesh = ball(2)
    a, b, c = mesh.F[0]
    split = Mesh(
        np.vstack([mesh.V, mesh.V[[a, b]].mean(axis=0)]),
        np.vstack([mesh.F[1:], [[a, len(mesh.V), c], [len(mesh.V), b, c], [a, b, len(mesh.V)]]]),
    )
    middle = mesh.V[[a, b, c]].mean(axis=0)
    found = locate([-middle], [[0, 0, 0]], TipMesh(split))
    np.testing.assert_allclose(found.point[0], middle, atol=1e-9)
    assert found.flags[0] == 0


def test_what_is_no_fingertip() -> None:
    mesh = ball(1)
    with pytest.raises(InputError, match="3 edges"):
        TipMesh(Mesh(mesh.V, mesh.F[1:], "open"))
    with pytest.raises(InputError, match="inside out"):
        TipMesh(Mesh(mesh.V, mesh.F[:, ::-1], "turned"))
    with pytest.raises(InputError, match="no triangles"):
        TipMesh(Mesh(mesh.V, mesh.F[:0], "empty"))
    with pytest.raises(InputError, match="no numbers"):
        TipMesh(Mesh(mesh.V * np.nan, mesh.F, "nan"))


def test_nothing_touches_what_it_is_mounted_with() -> None:
    """The signs of a sensor that reports the reaction: every line enters a half ball by its flat side, which must not be trusted."""
    whole = ball(3)
    half = trimesh.Trimesh(whole.V, whole.F).slice_plane([0, 0, 0], [0, 0, 1], cap=True)
    tip = TipMesh(Mesh(np.asarray(half.vertices), np.asarray(half.faces), "half"))
    rng = np.random.default_rng(0)
    point = rng.standard_normal((200, 3)) * (1, 1, 0) * 0.2 + (0, 0, 1)
    point *= np.abs(half.vertices).max() / np.linalg.norm(point, axis=1)[:, None]
    right, turned = locate(-point, 0 * point, tip), locate(point, 0 * point, tip)
    assert right.trusted.all() and not right.mounted.any()
    assert turned.mounted.all() and not turned.trusted.any() and "mounted with" in turned.words(0)
    # A ball has no flat side.
    assert not locate(point, 0 * point, TipMesh(whole)).mounted.any()


def test_nothing_there_and_what_is_no_number() -> None:
    found = locate([[0, 0, 0], [np.nan, 0, 1]], [[0, 0, 0], [0, 0, 0]], TipMesh(ball(1)))
    assert found.flags.tolist() == [2, 3] and np.isfinite(found.point).all() and np.isfinite(found.sd_mm).all()
