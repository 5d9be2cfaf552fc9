"""An offset goes; what moves in the time of rest is told."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.motion_simulator import GraspScene, grasp_log
from skinfab.fingertip.force.tare import tared


def test_an_offset_goes() -> None:
    log, _ = grasp_log(seed=1)
    quiet = log.time < 0.9
    assert np.abs(log.force[quiet].mean(axis=0)).max() > 0.02
    assert np.abs(tared(log, seconds=0.5).force[quiet].mean(axis=0)).max() < 0.01


def test_a_touch_in_the_time_of_rest_is_refused() -> None:
    log, _ = grasp_log(seed=1)
    with pytest.raises(InputError, match="something touches"):
        tared(log, seconds=1.5)


def test_too_short_a_rest_is_refused() -> None:
    with pytest.raises(InputError, match="too few"):
        tared(grasp_log(seed=1)[0], seconds=0.01)


def test_many_logs_of_nothing_but_noise_pass() -> None:
    for seed in range(30):
        tared(grasp_log(seed=seed, episodes=1, scene=GraspScene())[0], seconds=0.9)
