"""How many sensors go where."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.placement.share import default_number, share


@pytest.mark.parametrize(("area", "faces", "number"), [(9600, 6, 6), (29800, 12, 12), (45600, 3, 11), (500, 1, 4), (200_000, 1, 50)])
def test_the_default_follows_faces_and_area(area: float, faces: int, number: int) -> None:
    assert default_number(area, faces) == number


@given(st.lists(st.tuples(st.floats(1, 1e5), st.integers(0, 40)), min_size=0, max_size=12), st.integers(0, 60))
def test_all_is_shared_one_each_first_and_no_cap_broken(parts: list[tuple[float, int]], most: int) -> None:
    areas, caps = np.array([a for a, _ in parts]), np.array([c for _, c in parts], dtype=int)
    counts = share(areas, most=most, caps=caps)
    assert (counts <= caps).all() and counts.sum() == min(most, caps.sum())
    if (counts > 1).any():
        assert (counts[caps > 0] > 0).all()


def test_by_area() -> None:
    assert share([300, 100], most=8).tolist() == [6, 2]
    assert share([100, 100, 100], most=2).tolist() == [1, 1, 0]
    assert share([], most=3).tolist() == []
