"""Fingers in a hand: sums of wrenches, whatever the frames, and the noise they add up to."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skinfab.errors import InputError
from skinfab.fingertip.force.hand import Finger, hand_wrench


def fingers(n: int = 3) -> list[Finger]:
    rng = np.random.default_rng(4)
    return [Finger(Rotation.random(random_state=rng).as_matrix(), 50 * rng.standard_normal(3)) for _ in range(n)]


def test_forces_at_points_come_out_as_one_wrench() -> None:
    rng = np.random.default_rng(1)
    made = fingers()
    force, point = rng.standard_normal((3, 5, 3)), 100 * rng.standard_normal((3, 5, 3))
    read = [
        np.concatenate([f @ k.rotation, np.cross(p - k.position, f) @ k.rotation], axis=1)
        for k, f, p in zip(made, force, point, strict=True)
    ]
    total = hand_wrench(made, np.stack(read))
    assert total[:, :3] == pytest.approx(force.sum(axis=0)) and total[:, 3:] == pytest.approx(np.cross(point, force).sum(axis=0))


def test_what_is_no_finger_is_refused() -> None:
    for bad in (np.diag([1.0, 1.0, -1.0]), 2 * np.eye(3), np.eye(2)):
        with pytest.raises(InputError, match="rotation"):
            Finger(bad, np.zeros(3))
    with pytest.raises(InputError, match="3 fingers need"):
        hand_wrench(fingers(), np.zeros((2, 4, 6)))
