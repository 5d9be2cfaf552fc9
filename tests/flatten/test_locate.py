"""Point location against brute force and on shared edges."""

import numpy as np

from skinfab.flatten.locate import Locator


def grid(n: int) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + n + 1])])
    return np.column_stack([x.ravel(), y.ravel()]), F


def test_random_points_fall_into_their_triangle() -> None:
    UV, F = grid(12)
    rng = np.random.default_rng(1)
    UV += 0.2 * rng.uniform(-1, 1, UV.shape)
    faces = rng.integers(0, len(F), 2000)
    weights = rng.dirichlet((1, 1, 1), 2000)
    points = np.einsum("nk,nkd->nd", weights, UV[F[faces]])
    found, barycentric = Locator(UV, F).barycentric(points)
    np.testing.assert_array_equal(found, faces)
    np.testing.assert_allclose(barycentric, weights, atol=1e-9)


def test_edges_corners_and_outside() -> None:
    UV, F = grid(3)
    found = Locator(UV, F).faces([[1, 1], [1.5, 1], [1.5, 1.5], [0, 0], [3, 3], [3.001, 1], [-0.001, 0]])
    assert (found[:5] >= 0).all() and (found[5:] == -1).all()


def test_a_triangle_without_area_holds_nothing() -> None:
    UV = np.array([[0.0, 0], [1, 0], [2, 0]])
    assert Locator(UV, np.array([[0, 1, 2]])).faces([[1, 0]]).tolist() == [-1]
