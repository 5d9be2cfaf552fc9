"""Shortest ways against closed forms and an exact method: straight on a plane, round a cone or cylinder unrolled, great circles."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.mesh.geodesic import geodesic
from skinfab.mesh.model import Mesh

CENTRE = (1 / 3, 1 / 3, 1 / 3)


def grid(nx: int, ny: int, place) -> Mesh:
    """A grid of 2 nx ny triangles, its corners jittered inside, put into space by `place`(u, v) for u, v from 0 to 1."""
    u, v = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1))
    rng = np.random.default_rng(2)
    inner = np.zeros(u.shape, dtype=bool)
    inner[1:-1, 1:-1] = True
    u, v = u + inner * rng.uniform(-0.25, 0.25, u.shape) / nx, v + inner * rng.uniform(-0.25, 0.25, u.shape) / ny
    a = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + nx + 2]), np.column_stack([a, a + nx + 2, a + nx + 1])])
    return Mesh(np.asarray(place(u.ravel(), v.ravel())).T.copy(), F)


def sphere(n: int) -> Mesh:
    """An octahedron refined and blown up to radius 10."""
    V = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    F = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(n):
        pairs = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
        edges, which = np.unique(pairs, axis=0, return_inverse=True)
        m = len(V) + which.reshape(3, -1).T
        V = np.vstack([V, V[edges].mean(axis=1)])
        V /= np.linalg.norm(V, axis=1)[:, None]
        F = np.concatenate(
            [np.column_stack(c) for c in [(F[:, 0], m[:, 0], m[:, 2]), (F[:, 1], m[:, 1], m[:, 0]), (F[:, 2], m[:, 2], m[:, 1]), m.T]]
        )
    return Mesh(10 * V, F)


def points(mesh: Mesh, count: int) -> list[tuple[int, np.ndarray]]:
    rng = np.random.default_rng(7)
    return [(int(rng.integers(len(mesh.F))), rng.dirichlet([1, 1, 1])) for _ in range(count)]


def place(mesh: Mesh, point) -> np.ndarray:
    return point[1] @ mesh.V[mesh.F[point[0]]]


def test_straight_on_a_plane():
    mesh = grid(40, 30, lambda u, v: (100 * u, 60 * v, 0 * u))
    for one, two in zip(points(mesh, 12), points(mesh, 24)[12:], strict=True):
        apart = np.linalg.norm(place(mesh, one) - place(mesh, two))
        assert apart * (1 - 1e-12) <= geodesic(mesh, one, two).length <= apart * (1 + 1e-3) + 1e-9


def test_straight_on_an_unrolled_cylinder():
    mesh = grid(80, 20, lambda u, v: (20 * np.cos(3 * u), 20 * np.sin(3 * u), 50 * v))
    unrolled = grid(80, 20, lambda u, v: (60 * u, 50 * v, 0 * u))
    for one, two in zip(points(mesh, 8), points(mesh, 16)[8:], strict=True):
        apart = np.linalg.norm(place(unrolled, one) - place(unrolled, two))
        assert geodesic(mesh, one, two).length == pytest.approx(apart, rel=2e-3, abs=1e-3)


def test_great_circles_on_a_sphere():
    mesh = sphere(5)
    for one, two in zip(points(mesh, 8), points(mesh, 16)[8:], strict=True):
        a, b = (p / np.linalg.norm(p) for p in (place(mesh, one), place(mesh, two)))
        way = geodesic(mesh, one, two)
        assert way.length == pytest.approx(10 * np.arccos(a @ b), rel=3e-3)
        away = way.points @ np.cross(a, b) / np.linalg.norm(np.cross(a, b))
        if a @ b > -0.9:  # near the far side many ways are equally short
            assert np.abs(away).max() < 0.4


def test_beside_an_exact_method():
    import igl

    mesh = sphere(4)
    V = mesh.V * (1.0, 0.6, 1.5)
    mesh = Mesh(V + 0.8 * np.sin(V[:, [1, 2, 0]]), mesh.F)
    rng = np.random.default_rng(3)
    for one, two in rng.integers(len(mesh.V), size=(10, 2)):
        start, end = ((int(f), (mesh.F[f] == v).astype(float)) for v in (one, two) for f in [np.flatnonzero((mesh.F == v).any(axis=1))[0]])
        none = np.zeros(0, dtype=np.int64)
        exact = float(igl.exact_geodesic(mesh.V, mesh.F, np.array([one]), none, np.array([two]), none)[0])
        assert exact * (1 - 1e-9) <= geodesic(mesh, start, end).length <= exact * (1 + 2e-3)


def test_round_a_hole_and_within_a_face():
    mesh = grid(30, 30, lambda u, v: (60 * u, 60 * v, 0 * u))
    centre = mesh.V[mesh.F].mean(axis=1)
    mesh = Mesh(mesh.V, mesh.F[~((np.abs(centre[:, 0] - 30) < 2) & (centre[:, 1] > 10))])  # a wall with a gap below
    one, two = (int(np.argmin(np.linalg.norm(mesh.V[mesh.F].mean(axis=1) - at, axis=1))) for at in ((20, 40, 0), (40, 40, 0)))
    way = geodesic(mesh, (one, CENTRE), (two, CENTRE))
    assert way.points[:, 1].min() < 12 and 58 < way.length < 66
    inside = geodesic(mesh, (5, (1, 0, 0)), (5, (0, 1, 0)))
    assert len(inside.points) == 2 and inside.length == pytest.approx(np.linalg.norm(mesh.V[mesh.F[5, 0]] - mesh.V[mesh.F[5, 1]]))


def test_what_cannot_be_measured_is_said():
    mesh = grid(2, 2, lambda u, v: (u, v, 0 * u))
    apart = Mesh(np.vstack([mesh.V, mesh.V + 5]), np.vstack([mesh.F, mesh.F + len(mesh.V)]))
    with pytest.raises(InputError, match="not connected"):
        geodesic(apart, (0, CENTRE), (len(mesh.F), CENTRE))
    with pytest.raises(InputError, match="no face 99"):
        geodesic(mesh, (99, CENTRE), (0, CENTRE))
    with pytest.raises(InputError, match="sum 1"):
        geodesic(mesh, (0, (1, 1, 1)), (1, CENTRE))
