"""The compiled z-buffer agrees with the plain one of the report, whatever it is given."""

import numpy as np
import pytest
from shapes import sphere, torus

from gui.view3d.raster import project, rasterise
from skinfab.report.raster import rasterise as plain


def drawn(screen, F, shape=(60, 80), closed=False):
    face, depth = np.empty(shape, dtype=np.int32), np.empty(shape, dtype=np.float32)
    count = rasterise(np.ascontiguousarray(screen, dtype=np.float32), np.ascontiguousarray(F, dtype=np.int32), closed, face, depth)
    return face, depth, count


@pytest.mark.parametrize("seed", range(5))
def test_it_agrees_with_the_plain_z_buffer(seed):
    """On a soup of triangles of all sizes and windings, many of them partly or wholly beside the picture."""
    rng = np.random.default_rng(seed)
    middle, size = rng.uniform([-20, -20, 0], [100, 80, 9], (150, 3)), rng.choice([2, 10, 50], (150, 1, 1))
    screen = (middle[:, None] + size * rng.uniform(-1, 1, (150, 3, 3)) * [1, 1, 0.1]).reshape(-1, 3)
    F = np.arange(450).reshape(-1, 3)
    face, depth, _ = drawn(screen, F)
    other, far = plain(screen - [0.5, 0.5, 0], F, shape=face.shape)  # its pixel centres are whole numbers
    assert (face == other).mean() > 0.998  # an edge may run just through a centre
    alike = face == other
    assert np.array_equal(np.isfinite(depth[alike]), np.isfinite(far[alike]))
    np.testing.assert_allclose(depth[alike & (face >= 0)], far[alike & (face >= 0)], atol=0.02)


@pytest.mark.parametrize("shape", [sphere(3), torus()], ids=["sphere", "torus"])
def test_what_is_seen_from_behind_can_be_left_out_of_a_closed_surface(shape):
    V, F = shape
    screen = V * [8, -8, -8] / np.abs(V).max() * 3 + [40, 30, 0]
    all_of_it, some = drawn(screen, F), drawn(screen, F, closed=True)
    assert (all_of_it[0] == some[0]).mean() > 0.999
    assert some[2] < 0.6 * all_of_it[2]


def test_neighbours_leave_no_gap():
    """A fine grid over the whole picture, turned so that edges run through pixel centres in every way."""
    s = np.linspace(-80, 160, 241)
    x, y = (a.ravel() for a in np.meshgrid(s, s))
    screen = np.column_stack([x + 0.3 * y - 10, y - 0.2 * x, 0 * x])
    k = (241 * np.arange(240)[:, None] + np.arange(240)).ravel()
    F = np.concatenate([np.column_stack([k, k + 1, k + 242]), np.column_stack([k, k + 242, k + 241])])
    assert (drawn(screen, F)[0] >= 0).all()


@pytest.mark.parametrize(
    "screen", [[[5, 5, 0], [5, 5, 0], [5, 5, 0]], [[0, 5, 0], [40, 5, 0], [70, 5, 0]], [[-9, -9, 0], [-1, -9, 0], [-9, -1, 0]]]
)
def test_nothing_to_see_is_nothing_drawn(screen):
    face, depth, count = drawn(screen, [[0, 1, 2]])
    assert (face == -1).all() and np.isinf(depth).all() and count == 0


def test_points_are_projected_as_a_matrix_says():
    rng = np.random.default_rng(1)
    V, rows, shift = rng.normal(size=(50, 3)), rng.normal(size=(3, 3)), rng.normal(size=3)
    screen = np.empty((50, 3), dtype=np.float32)
    project(*(a.astype(np.float32) for a in (V, rows, shift)), screen)
    np.testing.assert_allclose(screen, V @ rows.T + shift, atol=1e-5)
