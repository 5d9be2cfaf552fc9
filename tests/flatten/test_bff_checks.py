"""What a prescribed boundary is checked for: lengths of a polygon, closed as asked, every triangle upright."""

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.bff_checks import require_closed, require_lengths, require_upright

SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]])
V = np.column_stack([SQUARE, np.zeros(5)])
F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
TURNING = np.full(4, np.pi / 2)


@pytest.mark.parametrize("last", [3.0, 3.1, 1000.0])
def test_an_edge_as_long_as_the_others_together_makes_no_polygon(last: float) -> None:
    with pytest.raises(InputError, match=rf"edge 3 has length {last:g} mm in the target lengths, the others together 3 mm"):
        require_lengths(np.array([1.0, 1, 1, last]), "the target lengths")
    require_lengths(np.array([1.0, 1, 1, 2.9]), "the target lengths")


def test_a_curve_is_closed_as_asked_or_refused() -> None:
    require_closed(SQUARE[:4], TURNING, length=np.ones(4))
    require_closed(SQUARE[:4], TURNING, length=np.array([1.0, 1, 1, 0.9]))
    with pytest.raises(RefusedError, match="only with edge 3 43 % off its length"):
        require_closed(SQUARE[:4], TURNING, length=np.array([1.0, 1, 1, 0.7]))
    with pytest.raises(RefusedError, match=r"with these turning angles .* off by 3\.14 rad"):
        require_closed(SQUARE[:4], np.pi * np.array([1.5, -0.5, 0.5, 0.5]))


def test_triangles_upside_down_and_without_area_are_counted_on_the_users_mesh() -> None:
    require_upright(V, F, SQUARE, "inside")
    over = SQUARE.copy()
    over[4] = [0.5, -0.5]
    with pytest.raises(RefusedError, match="1 of 4 triangles come out upside down inside"):
        require_upright(V, F, over, "inside")
    over[4] = [0.5, 0]
    with pytest.raises(RefusedError, match="1 of 3 triangles come out without area inside, first triangle 0"):
        require_upright(V, F, over, "inside", face_of=np.array([0, 0, 1, 2]))


def test_a_triangle_shrunk_to_a_point_is_no_division_by_zero() -> None:
    shrunk = SQUARE.copy()
    shrunk[[1, 4]] = shrunk[0]
    with pytest.raises(RefusedError, match="3 of 4 triangles come out without area inside, first triangle 0"):
        require_upright(V, F, shrunk, "inside")


def test_what_has_no_area_on_the_object_need_have_none() -> None:
    flat = V.copy()
    flat[4] = [0.5, 0, 0]
    require_upright(flat, F, flat[:, :2], "inside")
