"""Places for labels: free, near, within the picture, taken once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.report.labels import Room, dense


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_labels_keep_clear_of_points_of_each_other_and_of_the_rim(seed: int) -> None:
    rng = np.random.default_rng(seed)
    room, points = Room(200, 120), rng.uniform(0, 1, (12, 2)) * (200, 120)
    room.take(points, radius=3)
    boxes: list[tuple[np.ndarray, np.ndarray]] = []
    for _ in range(8):
        size = rng.uniform(5, 30, 2)
        at = room.place((size[0], size[1]), near=rng.uniform(0, 100, 2))
        if at is None:
            continue
        low, high = at - size / 2, at + size / 2
        assert (low >= 0).all() and (high <= (200, 120)).all()
        outside = np.maximum(np.maximum(low - points, points - high), 0)
        assert (outside.max(axis=1) >= 1).all()  # 3 less a cell
        assert all((low >= h).any() or (high <= other).any() for other, h in boxes)
        boxes.append((low, high))
    assert boxes


def test_nearest_free_place_is_taken_once() -> None:
    room = Room(100, 100)
    assert room.place((10, 10), near=(50, 50)) == pytest.approx((50, 50), abs=2)
    x, y = room.place((10, 10), near=(50, 50)) or (0.0, 0.0)
    assert 10 <= max(abs(x - 50), abs(y - 50)) <= 16


def test_no_room_is_said() -> None:
    room = Room(40, 40)
    assert room.place((60, 10), near=(0, 0)) is None
    room.fill(np.ones((40, 40), dtype=bool))
    assert room.place((4, 4), near=(0, 0)) is None


def test_what_a_picture_marks_is_taken() -> None:
    room, marked = Room(40, 40), np.zeros((40, 40), dtype=bool)
    marked[:, :30] = True
    room.fill(marked)
    x, _ = room.place((6, 6), near=(0, 20)) or (0.0, 0.0)
    assert x >= 33


def test_dense_points_of_a_closed_line() -> None:
    square = np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])
    points = dense(square, closed=True)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.max() <= 2 and steps.sum() == pytest.approx(40) and (points[0] == points[-1]).all()
