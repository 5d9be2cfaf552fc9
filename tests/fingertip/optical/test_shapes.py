"""The seed's shapes, and what traces of them come to."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.follower import Trace
from skinfab.fingertip.optical.shapes import Shape, reconstruct, shapes

ALL = pytest.mark.parametrize("shape", shapes(), ids=lambda each: each.name)


def trace(shape: Shape, *, noise: float = 0.0, closed: bool = True, turn: int = 0) -> Trace:
    C = shape.plate.outline()
    P = np.vstack([a + (b - a) * np.linspace(0, 1, 40, endpoint=False)[:, None] for a, b in zip(C, np.roll(C, -1, axis=0), strict=True)])
    P = np.roll(P, turn, axis=0) + noise * np.random.default_rng(0).standard_normal(P.shape)
    return Trace(P, P, len(P), closed, 0)


@ALL
@pytest.mark.parametrize("lines", [False, True])
@pytest.mark.parametrize("turn", [0, 17, 90])
def test_a_trace_of_the_true_edge_gives_the_true_sides(shape: Shape, lines: bool, turn: int) -> None:
    made = reconstruct(trace(shape, turn=turn), shape, lines=lines)
    np.testing.assert_allclose(made.sides_mm, shape.sides_mm, atol=0.05)
    assert made.area_mm2 == pytest.approx(shape.plate.area, rel=1e-3) and made.off_mm < 0.05 and made.right


def test_the_shapes_have_the_sides_of_the_table() -> None:
    for shape in shapes()[:2]:
        C = shape.plate.outline()
        np.testing.assert_allclose(np.linalg.norm(np.roll(C, -1, axis=0) - C, axis=1), shape.sides_mm, atol=1e-9)
        assert len(shape.published_mm) == len(shape.sides_mm)


def test_corners_that_are_felt_rounded_cost_the_hull_and_not_the_lines() -> None:
    for shape in shapes()[:2]:
        corners = shape.plate.outline()
        whole = trace(shape).edge
        P = whole[np.linalg.norm(whole[:, None] - corners, axis=2).min(axis=1) > 6]
        round_ = Trace(P, P, len(P), True, 0)
        lines, hull = (reconstruct(round_, shape, lines=each) for each in (True, False))
        np.testing.assert_allclose(lines.sides_mm, shape.sides_mm, atol=0.05)
        assert np.abs(hull.sides_mm - shape.sides_mm).max() > 2


def test_noise_widens_a_hull() -> None:
    for shape in shapes():
        made = reconstruct(trace(shape, noise=0.5), shape, lines=True)
        assert made.area_mm2 > shape.plate.area
        np.testing.assert_allclose(made.sides_mm, shape.sides_mm, atol=2.5)


def test_what_is_not_closed_or_round_something_else_is_not_right() -> None:
    circle = shapes()[-1]
    assert not reconstruct(trace(circle, closed=False), circle, lines=True).right
    whole = trace(circle)
    small = Trace(whole.path / 2, whole.edge / 2, 10, True, 0)
    assert not reconstruct(small, circle, lines=True).right


def test_a_trace_of_too_few_points_says_so() -> None:
    with pytest.raises(InputError, match="lost at once"):
        reconstruct(Trace(np.zeros((2, 2)), np.zeros((2, 2)), 9, False, 0), shapes()[0], lines=True)
