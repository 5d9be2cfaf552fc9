"""Told and shown: which ways are shut, and what opens them."""

from collections.abc import Iterable

import numpy as np
import pytest

from calibration.control.controller import LAWS, Input, JointController
from calibration.control.follows import FAR_PART, Follows
from calibration.control.protocols import follow, random, uniform
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, ROBOT

RANGE = 70.0


def made() -> Follows:
    return Follows(range_deg=RANGE, late_s=0.05, period_s=0.01)


def drive(follows: Follows, readings: Iterable[float], speed: float, *, aim: float = 40.0) -> list[bool]:
    """Whether the way of the speed is shut, step by step; where it is, the joint is told 0."""
    shut = []
    for reading in readings:
        shut.append(follows.shut(speed))
        follows.step(reading, aim=aim, command=0.0 if shut[-1] else speed)
    return shut


@pytest.mark.parametrize("speed", [30.0, -30.0, 300.0])
def test_in_vain_it_is_shut_after_so_far(speed: float) -> None:
    shut = drive(made(), [0.5] * 400, speed)
    far = shut.index(True) * 0.01 * abs(speed)
    # What is told while the reading is on its way, 0.05 s, and half of what the mean is of, 0.05 s, comes on top.
    assert FAR_PART * RANGE < far <= FAR_PART * RANGE + 0.12 * abs(speed) and all(shut[shut.index(True) :])


def test_noise_is_no_motion() -> None:
    noise = 0.5 + 0.02 * np.random.default_rng(0).standard_normal(3000)
    shut = drive(made(), noise.tolist(), 30.0)
    assert shut.index(True) < 200 and all(shut[200:])


def test_a_joint_that_goes_is_never_shut() -> None:
    """Half as fast as told, after slack of 18 degrees."""
    readings = np.maximum(np.arange(400) * 0.01 * 0.5 * 30 - 18, 0) / RANGE
    assert not any(drive(made(), readings.tolist(), 30.0))


def test_the_other_way_is_open_and_opens_this_one_when_the_joint_goes() -> None:
    follows = made()
    assert drive(follows, [0.5] * 400, 30.0)[-1] and not follows.shut(-30.0)
    assert not any(drive(follows, (0.5 - 0.004 * np.arange(100)).tolist(), -30.0)) and not follows.shut(30.0)
    # What was told back in vain may come again, and no more.
    follows = made()
    drive(follows, [0.5] * 400, 30.0)
    drive(follows, [0.5] * 50, -30.0)
    assert drive(follows, [0.5] * 100, 30.0).index(True) == pytest.approx(50, abs=1)


def test_what_the_reading_does_against_the_command_opens_nothing() -> None:
    """A channel that drifts up while the joint is told to go down."""
    follows = made()
    drive(follows, [0.5] * 400, -30.0)
    assert all(drive(follows, (0.5 + 0.002 * np.arange(200)).tolist(), -30.0))
    assert not all(drive(follows, (0.9 - 0.002 * np.arange(200)).tolist(), -30.0))


def test_an_aim_that_goes_on_is_tried_once() -> None:
    follows = made()
    assert drive(follows, [0.5] * 400, 30.0, aim=60.0)[-1]
    assert drive(follows, [0.5] * 100, 30.0, aim=69.0)[1]
    again = drive(follows, [0.5] * 400, 30.0, aim=72.0)
    assert not any(again[1:170]) and again[-1]
    assert all(drive(follows, [0.5] * 400, 30.0, aim=95.0)[1:])


def test_both_ways_in_vain_is_stuck_until_the_reading_goes_on() -> None:
    follows = made()
    drive(follows, [0.5] * 400, 30.0)
    assert not follows.stuck
    drive(follows, [0.5] * 400, -30.0)
    assert follows.stuck
    drive(follows, [0.54] * 50, 0.0)
    assert follows.stuck
    drive(follows, [0.58] * 50, 0.0)
    assert not follows.stuck


def test_without_new_frames_nothing_is_judged() -> None:
    follows = made()
    for _ in range(1000):
        follows.step(None, aim=40.0, command=100.0)
    assert not follows.shut(100.0)


@pytest.mark.parametrize("law", LAWS)
def test_the_protocols_run_through(law: str) -> None:
    """Slack, the robot's stop, flat ends of its curve, the fastest cycles: never in the way."""
    inputs = [Input(calibrated(sensor, "poly" if law == "p" else "branches")) for sensor in (HUMAN, ROBOT)]
    gain = 5.1 if law == "p" else 3.99
    for motion in (uniform(), uniform(period_s=2.0), random(0), random(1)):
        run = follow(motion, JointController(*inputs, law=law, gain=gain), seed=0)
        assert {command.state for command in run.commands} == {"run"}
