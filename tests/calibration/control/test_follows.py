"""Told and shown: which ways are shut, and what opens them."""

from collections.abc import Iterable

import numpy as np
import pytest

from calibration.control.controller import LAWS, Input, JointController
from calibration.control.follows import FAR_PART, LONGEST_S, SHUT_S, Follows
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


@pytest.mark.parametrize("speed", [70.0, -70.0, 350.0])
def test_in_vain_it_is_shut_after_so_far(speed: float) -> None:
    shut = drive(made(), [0.5] * 250, speed)
    first = shut.index(True)
    # What is told while the reading is on its way, 0.05 s, and half of what the mean is of, 0.05 s, comes on top.
    assert FAR_PART * RANGE < first * 0.01 * abs(speed) <= FAR_PART * RANGE + 0.13 * abs(speed)
    assert all(shut[first : first + 100 * round(SHUT_S)])


def test_noise_is_no_motion() -> None:
    noise = 0.5 + 0.02 * np.random.default_rng(0).standard_normal(3000)
    assert 200 < drive(made(), noise.tolist(), 30.0).index(True) < 280


def test_few_frames_a_second_are_judged_by_no_fewer() -> None:
    """Of 30 frames a second 0.1 s has three, whose mean shakes by more than half of what counts as going on."""
    follows = Follows(range_deg=RANGE, late_s=0.05, period_s=1 / 30)
    noise = 0.5 + 0.02 * np.random.default_rng(0).standard_normal(300)
    assert drive(follows, noise.tolist(), 30.0).index(True) < 90


def test_it_is_tried_again_ever_less_often() -> None:
    """Up to half a minute: 2 s, 4 s, 8 s and 8 s apart, and 1 s of trying each time."""
    shut = np.array(drive(made(), [0.5] * 4000, RANGE))
    starts, ends = (np.flatnonzero(np.diff(shut.astype(int)) == step) for step in (1, -1))
    lasts = (ends - starts[: len(ends)]) / 100
    assert lasts[:4] == pytest.approx([SHUT_S, 2 * SHUT_S, LONGEST_S, LONGEST_S], abs=0.02)
    # When it has gone, the wait begins anew.
    follows = made()
    drive(follows, [0.5] * 1000, RANGE)
    drive(follows, (0.5 + 0.01 * np.arange(50)).tolist(), RANGE)
    shut = np.array(drive(follows, [0.99] * 500, RANGE))
    starts, ends = (np.flatnonzero(np.diff(shut.astype(int)) == step) for step in (1, -1))
    assert (ends[0] - starts[0]) / 100 == pytest.approx(SHUT_S, abs=0.02)


def test_a_joint_that_goes_is_never_shut() -> None:
    """Half as fast as told, after slack of 18 degrees."""
    readings = np.maximum(np.arange(400) * 0.01 * 0.5 * 30 - 18, 0) / RANGE
    assert not any(drive(made(), readings.tolist(), 30.0))


def test_an_aim_that_goes_on_is_tried_but_not_at_once() -> None:
    """A dead band: shut while the human rested, 8 s from the next trial when that one bends on."""
    shut = drive(made(), [0.5] * 2000, RANGE)
    (third,) = [k for k in range(1, 2000) if shut[k] and not shut[k - 1]][2:3]
    follows = made()
    drive(follows, [0.5] * third, RANGE)
    assert all(drive(follows, [0.5] * 100, RANGE, aim=52.0))
    assert all(drive(follows, [0.5] * 300, RANGE, aim=49.0))
    assert not any(drive(follows, [0.5] * 90, RANGE, aim=52.0)[1:])


def test_the_other_way_is_open_and_opens_this_one_when_the_joint_goes() -> None:
    follows = made()
    assert drive(follows, [0.5] * 120, RANGE)[-1] and not follows.shut(-RANGE)
    assert not any(drive(follows, (0.5 - 0.004 * np.arange(50)).tolist(), -RANGE)) and not follows.shut(RANGE)
    # What was told back in vain may come again, and no more.
    follows = made()
    drive(follows, [0.5] * 120, RANGE)
    drive(follows, [0.5] * 50, -RANGE)
    assert drive(follows, [0.5] * 100, RANGE).index(True) == pytest.approx(50, abs=1)


def test_what_the_reading_does_against_the_command_opens_nothing() -> None:
    """A channel that drifts up while the joint is told to go down."""
    follows = made()
    drive(follows, [0.5] * 120, -RANGE)
    assert all(drive(follows, (0.5 + 0.002 * np.arange(150)).tolist(), -RANGE))
    assert not all(drive(follows, (0.8 - 0.002 * np.arange(50)).tolist(), -RANGE))


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
