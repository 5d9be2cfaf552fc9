"""The piece frame: a rigid turn into the first quadrant, the long side along x."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.orient import orient


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.integers(3, 30))
def test_rigid_in_the_corner_and_long_along_x(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    UV = rng.standard_normal((count, 2)) @ rng.standard_normal((2, 2)) + 40
    laid = orient(UV)
    before, after = (UV - UV[0]) @ [1, 1j], (laid - laid[0]) @ [1, 1j]
    turn = after[1] / before[1]
    assert abs(turn) - 1 < 1e-9
    np.testing.assert_allclose(after, before * turn, atol=1e-9)  # turned and shifted, never mirrored
    np.testing.assert_allclose(laid.min(axis=0), 0, atol=1e-12)
    w, h = laid.max(axis=0)
    assert w >= h - 1e-9
    for a in np.linspace(0, np.pi / 2, 60):  # no other turn has a smaller enclosing rectangle
        c, s = np.cos(a), np.sin(a)
        assert np.prod(np.ptp(UV @ np.array([[c, -s], [s, c]]), axis=0)) >= w * h * (1 - 1e-9)


def test_points_on_a_line_are_only_shifted() -> None:
    np.testing.assert_array_equal(orient(np.array([[1.0, 2], [3, 4], [2, 3]])), [[0, 0], [2, 2], [1, 1]])


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000))
def test_points_inside_make_no_difference(seed: int) -> None:
    rng = np.random.default_rng(seed)
    border = rng.standard_normal((40, 2)) @ rng.standard_normal((2, 2)) * 10.0 ** rng.integers(-6, 7) + rng.standard_normal(2)
    weight = rng.dirichlet(np.ones(40), size=3000)
    laid = orient(np.vstack([border, weight @ border]))
    np.testing.assert_allclose(laid[:40], orient(border), rtol=0, atol=1e-12 * np.abs(border).max())
    assert (laid[40:] > -1e-12 * np.abs(border).max()).all()
