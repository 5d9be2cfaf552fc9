"""The joint's angle: right at every angle and in every pose, and short gaps alone are bridged."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibration.mocap.angle import bridge_gaps, joint_angle
from skinfab.errors import InputError


def finger(
    degrees: np.ndarray, *, turn: float = 0.0, lengths: tuple[float, float] = (40.0, 25.0)
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """MCP, PIP and DIP of a finger bent by these angles, turned about an axis askew and moved."""
    bent = np.radians(degrees)
    zero = np.zeros_like(bent)
    pip = np.stack([lengths[0] + zero, zero, zero], axis=1)
    dip = pip + lengths[1] * np.stack([np.cos(bent), np.sin(bent), zero], axis=1)
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14)
    cross = np.cross(np.eye(3), axis)
    rotation = np.eye(3) + np.sin(turn) * cross + (1 - np.cos(turn)) * cross @ cross
    return tuple(each @ rotation.T + [100.0, -300.0, 900.0] for each in (np.zeros_like(pip), pip, dip))  # type: ignore[return-value]


def test_every_angle() -> None:
    angles = np.linspace(0, 180, 721)
    assert np.allclose(joint_angle(*finger(angles)), angles, atol=1e-6)


@given(st.floats(0, 180), st.floats(-3, 3), st.floats(1, 100), st.floats(1, 100))
def test_every_pose_and_size(degrees: float, turn: float, first: float, second: float) -> None:
    (found,) = joint_angle(*finger(np.array([degrees]), turn=turn, lengths=(first, second)))
    # Coordinates of 900 mm are known to 1e-13 mm; bones are at least 1 mm long.
    assert found == pytest.approx(degrees, abs=1e-9)


def test_what_is_missing_has_no_angle() -> None:
    mcp, pip, dip = finger(np.full(4, 60.0))
    pip[1, 2] = np.nan
    dip[2] = pip[2]
    assert np.isnan(joint_angle(mcp, pip, dip)).tolist() == [False, True, True, False]


def test_gaps_up_to_the_stated_time() -> None:
    time = np.arange(100) / 100
    truth = np.stack([time, 2 * time, np.ones(100)], axis=1)
    gappy = truth.copy()
    for first, last in ((10, 15), (30, 39), (50, 60), (0, 1), (98, 100)):
        gappy[first:last] = np.nan
    filled, bridged = bridge_gaps(time, gappy, max_gap_s=0.1)
    # 5 and 9 frames missing are gaps of 60 and 100 ms from one frame seen to the next; 10 are 110 ms; ends are open.
    assert np.flatnonzero(bridged).tolist() == [*range(10, 15), *range(30, 39)]
    assert np.allclose(filled[bridged], truth[bridged]) and np.isnan(filled[50:60]).all() and np.isnan(filled[[0, 99]]).all()
    nothing, none = bridge_gaps(time, gappy, max_gap_s=0.0)
    assert not none.any() and np.array_equal(np.isnan(nothing), np.isnan(gappy))


def test_a_coordinate_alone_is_no_position() -> None:
    gappy = np.ones((5, 3))
    gappy[2, 1] = np.nan
    assert np.isnan(bridge_gaps(np.arange(5.0), gappy, max_gap_s=0.5)[0][2]).all()


def test_ends_of_this() -> None:
    for seen in (0, 1):
        gappy = np.full((5, 3), np.nan)
        gappy[:seen] = 1
        filled, bridged = bridge_gaps(np.arange(5) / 100, gappy)
        assert not bridged.any() and np.isfinite(filled).sum() == 3 * seen
    for wrong in (-1.0, np.nan):
        with pytest.raises(InputError, match="is none"):
            bridge_gaps(np.arange(5.0), np.ones((5, 3)), max_gap_s=wrong)
