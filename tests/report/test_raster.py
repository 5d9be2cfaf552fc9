"""The z-buffer against a test of every pixel against every triangle."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import skinfab.report.raster as raster
from skinfab.report.raster import is_visible, rasterise


def brute_force(points: np.ndarray, F: np.ndarray, rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Nearest depth of each pixel, and whether it is well inside the triangles' union (not within rounding of an edge)."""
    depth, sure = np.full((rows, columns), np.inf), np.ones((rows, columns), dtype=bool)
    i, j = np.mgrid[:rows, :columns]
    for a, b, c in points[F]:
        double = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(double) < 1e-3:
            sure[:] = False
            continue
        w = [
            ((q[0] - p[0]) * (i - p[1]) - (q[1] - p[1]) * (j - p[0])) / double  #
            for p, q in ((b, c), (c, a), (a, b))
        ]
        least = np.minimum.reduce(w)
        sure &= np.abs(least) > 1e-6
        z = w[0] * a[2] + w[1] * b[2] + w[2] * c[2]
        depth = np.where((least >= 0) & (z < depth), z, depth)
    return depth, sure


@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
@settings(max_examples=80, deadline=None)
def test_against_every_pixel_and_every_triangle(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.uniform(-6, 26, (3 * count, 3))
    F = np.arange(3 * count).reshape(-1, 3)
    face, depth = rasterise(points, F, shape=(15, 20))
    wanted, sure = brute_force(points, F, 15, 20)
    np.testing.assert_allclose(depth[sure], wanted[sure], atol=1e-6)
    assert ((face >= 0) == np.isfinite(depth)).all()


def test_neighbours_leave_no_gap_even_on_pixel_centres() -> None:
    x, y = np.meshgrid(np.arange(0, 41, 2.0), np.arange(0, 31, 2.0))
    points = np.c_[x.ravel(), y.ravel(), np.zeros(x.size)]
    k = (np.arange(15)[:, None] * 21 + np.arange(20)).ravel()
    F = np.vstack([np.c_[k, k + 1, k + 22], np.c_[k, k + 22, k + 21]])
    face, _ = rasterise(points, F, shape=(31, 41))
    assert (face >= 0).all()


def test_batches_do_not_change_the_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    points = np.random.default_rng(1).uniform(0, 60, (300, 3))
    F = np.random.default_rng(2).integers(0, 300, (200, 3))
    whole = rasterise(points, F, shape=(60, 60))
    monkeypatch.setattr(raster, "_BATCH", 500)
    for a, b in zip(whole, rasterise(points, F, shape=(60, 60)), strict=True):
        np.testing.assert_array_equal(a, b)


def test_no_triangles_and_triangles_outside() -> None:
    none = np.empty((0, 3), dtype=np.int64)
    assert (rasterise(np.zeros((1, 3)), none, shape=(4, 5))[0] == -1).all()
    far = np.array([[100.0, 100, 0], [120, 100, 0], [100, 120, 0]])
    assert (rasterise(far, np.array([[0, 1, 2]]), shape=(4, 5))[0] == -1).all()


def test_a_sliver_on_edge_stays_within_its_own_depths() -> None:
    points = np.array([[2.0, 0.0, 5.0], [2.0, 9.0, 6.0], [2.0 + 1e-12, 4.0, 1e6]])
    _, depth = rasterise(points, np.array([[0, 1, 2]]), shape=(10, 5))
    drawn = depth[np.isfinite(depth)]
    assert drawn.size and drawn.min() >= 5.0 and drawn.max() <= 1e6


def test_points_behind_are_hidden() -> None:
    depth = np.full((4, 4), 10.0)
    points = np.array([[1.0, 2, 9.0], [1, 1, 10.4], [2, 2, 11.0], [9, 9, 0.0]])
    assert is_visible(points, depth, slack=0.5).tolist() == [True, True, False, False]
    depth[2, 1] = np.inf  # beside the object
    assert not is_visible(points[:1], depth, slack=0.5).any()
