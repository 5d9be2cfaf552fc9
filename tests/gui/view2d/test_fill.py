"""Every pixel shows the triangle its centre lies in."""

import numpy as np

from gui.view2d.fill import fill
from skinfab.flatten.locate import Locator


def test_as_an_exact_point_location_has_it():
    rng = np.random.default_rng(4)
    x, y = np.meshgrid(np.arange(9.0), np.arange(8.0))
    points = np.column_stack([x.ravel(), y.ravel()]) * 9.3 - 7 + rng.uniform(-2.5, 2.5, (72, 2))
    a = (np.arange(7)[:, None] * 9 + np.arange(8)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + 10]), np.column_stack([a + 9, a, a + 10])])
    F[::3] = F[::3, ::-1]  # wound either way
    face = np.zeros((50, 60), dtype=np.int32)
    fill(points, F.astype(np.int32), face)
    column, row = np.meshgrid(np.arange(60) + 0.5, np.arange(50) + 0.5)
    exact = Locator(points, F).faces(np.column_stack([column.ravel(), row.ravel()])).reshape(50, 60)
    assert (face >= 0).sum() > 2000 and np.array_equal(face, exact)


def test_what_lies_beside_the_picture_is_left_out():
    face = np.zeros((4, 4), dtype=np.int32)
    fill(np.array([[-9.0, -9], [-5, -9], [-9, -5], [90, 1], [90, 2], [91, 1]]), np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32), face)
    assert (face == -1).all()
