"""A simulated robot: it believes what it asked for, and drags the skin behind its moves."""

import numpy as np
import pytest

from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.rig import Platform, Rig
from skinfab.fingertip.optical.simulator import NO_ERRORS, Fingertip

STEADY = Platform(step_mm=0.0, depth_scatter_mm=0.0, drag_mm=0.0)
TIP = Fingertip(errors=NO_ERRORS)


def rig(**terms: float) -> Rig:
    return Rig(HalfPlane(0.0, 0.0), TIP, np.zeros(2), Platform(**{**vars(STEADY), **terms}), seed=2)


def test_moves_err_by_as_much_as_is_said_and_are_not_known() -> None:
    one = rig(step_mm=0.1)
    errors = []
    for _ in range(400):
        before, believed = one.true.copy(), one.at.copy()
        one.move(np.array([0.5, 0.0]))
        errors.append(one.true - before - 0.5 * np.eye(2)[0])
        np.testing.assert_allclose(one.at - believed, [0.5, 0.0])
    assert np.std(errors) == pytest.approx(0.1, rel=0.1)


def test_a_steady_one_shows_the_plate_where_it_is() -> None:
    one = rig()
    one.move(np.array([1.5, 0.0]))
    assert np.array_equal(one.frame(), TIP.image(TIP.pressed(HalfPlane(1.5, 0.0))))


@pytest.mark.parametrize(("by", "dragged"), [((0.0, 1.0), (0.0, -0.3)), ((0.0, -0.1), (0.0, 0.1)), ((0.0, 0.0), (0.0, 0.0))])
def test_skin_is_dragged_behind_a_move_and_no_farther_than_it(by: tuple[float, float], dragged: tuple[float, float]) -> None:
    one = rig(drag_mm=0.3)
    one.move(np.array(by))
    expected = TIP.image(TIP.pressed(HalfPlane(0.0, 0.0), at=np.array(by), shear_mm=dragged))
    assert np.array_equal(one.frame(), expected)


def test_depth_scatters_and_stays_what_a_plate_allows() -> None:
    one = rig(depth_mm=2.9, depth_scatter_mm=0.5)
    assert len({one.frame().tobytes() for _ in range(8)}) > 3


def test_the_same_seed_does_the_same() -> None:
    frames = []
    for _ in range(2):
        one = rig(step_mm=0.1, depth_scatter_mm=0.1, drag_mm=0.2)
        one.move(np.array([0.0, 1.0]))
        frames.append(one.frame())
    assert np.array_equal(*frames)
