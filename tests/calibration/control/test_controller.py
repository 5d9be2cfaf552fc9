"""The controller by itself: what it does with good frames, and what with frames that are not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from calibration.control.controller import HOLD_S, LAWS, MAX_AGE_S, Input, JointController, Law
from calibration.strain.curve import Curve
from calibration.strain.document import SensorCalibration
from calibration.strain.models import BranchModel, CurveModel, Model
from skinfab.errors import InputError
from skinfab.readout.frame import Frame

LINE = Curve(10.0, 80.0, np.array([0.0, 0.7]))  # 0.01 per degree


def sensor(model: Model | None = None) -> Input:
    slack = 0.05  # 5 degrees
    rising, falling = (Curve(10.0, 80.0, LINE.ordinates + sign * slack) for sign in (-1, 1))
    model = model or BranchModel(LINE, rising, falling, 0.01)
    return Input(SensorCalibration(model, "U", "A", 2.0, 10, 80, {}, "", {}))


def frame(time: float, angle: float, *, valid: bool = True, saturated: bool = False) -> Frame:
    values = np.array([2.0 * (1 + 0.01 * (angle - 10))])
    return Frame(time, time, 0, values, np.array([valid]), np.array([saturated]))


def controller(law: Law = "p", **options: float) -> JointController:
    return JointController(sensor(), sensor(), law=law, **{"gain": 4.0, **options})


def test_the_published_law() -> None:
    """Speed is the gain times the difference of readings over the mean slope: of degrees, where the curve is straight."""
    command = controller().step(0.0, frame(0.0, 50), frame(0.0, 40))
    assert command.speed == pytest.approx(40.0) and command.state == "run"
    assert (command.target, command.angle) == pytest.approx((50, 40)) and not command.outside and not command.clamped
    bent = Curve(10.0, 80.0, np.array([0.0, 0.0, 0.7]))
    one = JointController(sensor(), sensor(CurveModel(bent)), law="p", gain=4.0).step(0.0, frame(0, 80), frame(0, 10))
    assert one.speed == pytest.approx(4 * 70)  # from end to end the mean slope is the slope


def test_a_falling_sensor_drives_the_right_way() -> None:
    falling = Input(SensorCalibration(CurveModel(Curve(10.0, 80.0, np.array([0.0, -0.4]))), "U", "A", 2.0, 10, 80, {}, "", {}))
    resting = Frame(0, 0, 0, np.array([2.0]), np.array([True]), np.array([False]))
    assert JointController(sensor(), falling, law="p", gain=1.0).step(0, frame(0, 50), resting).speed == pytest.approx(40)


@pytest.mark.parametrize("law", LAWS)
def test_beyond_the_range_the_end_is_the_target_and_it_is_said(law: Law) -> None:
    one = controller(law)
    for k in range(100):
        command = one.step(k / 100, frame(k / 100, 95), frame(k / 100, 70))
    assert command.target == pytest.approx(80, abs=1e-6) and command.outside and math.isfinite(command.speed)
    assert command.beyond.human and not command.beyond.robot
    assert not controller(law).step(0.0, frame(0, 45), frame(0, 45)).outside


def test_the_command_is_clamped() -> None:
    command = controller(limit_deg_s=30.0).step(0.0, frame(0, 80), frame(0, 10))
    assert command.speed == 30.0 and command.clamped
    assert controller(limit_deg_s=30.0).step(0.0, frame(0, 10), frame(0, 80)).speed == -30.0


BAD = {
    "no frame": lambda t: None,
    "stale": lambda t: frame(t - 1.01 * MAX_AGE_S, 50),
    "from the future": lambda t: frame(t + 1.01 * MAX_AGE_S, 50),
    "invalid": lambda t: frame(t, 50, valid=False),
    "not a number": lambda t: frame(t, math.nan),
    "saturated": lambda t: frame(t, 50, saturated=True),
    "too narrow": lambda t: replace(frame(t, 50), values=np.array([])),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("fault", BAD)
@pytest.mark.parametrize("whose", [0, 1])
def test_without_a_good_frame_the_last_command_is_held_and_then_the_joint_stops(law: Law, fault: str, whose: int) -> None:
    one = controller(law)
    for k in range(20):
        last = one.step(k / 100, frame(k / 100, 50), frame(k / 100, 40))
    assert last.state == "run" and last.speed != 0
    states = []
    for k in range(20, 50):
        time = k / 100
        frames = [frame(time, 50), frame(time, 40)]
        frames[whose] = BAD[fault](time)
        command = one.step(time, frames[0], frames[1])
        assert command.reason and ("human", "robot")[whose] in command.reason
        assert command.speed == (last.speed if command.state == "hold" else 0.0)
        states.append(command.state)
    held = round(HOLD_S * 100)
    assert states == ["hold"] * held + ["stop"] * (30 - held)
    assert one.step(0.5, frame(0.5, 50), frame(0.5, 40)).state == "run"


def test_it_begins_stopped() -> None:
    command = controller().step(0.0, None, frame(0, 40))
    assert command.state == "stop" and command.speed == 0 and "human" in command.reason


def test_a_frame_of_the_allowed_age_is_used() -> None:
    assert controller().step(1.0, frame(1.0 - 0.99 * MAX_AGE_S, 50), frame(1.0, 40)).state == "run"


def test_two_columns_of_one_board() -> None:
    human, robot = sensor(), replace(sensor(), column=1)
    both = Frame(0, 0, 0, np.array([2.8, 2.6]), np.array([True, True]), np.array([False, False]))
    assert JointController(human, robot, law="p", gain=1.0).step(0.0, both, both).speed == pytest.approx(10.0)


@pytest.mark.parametrize("law", ["branches", "full"])
def test_a_law_with_branches_needs_them(law: Law) -> None:
    with pytest.raises(InputError, match=r"robot sensor's calibration has the model poly.*--model branches"):
        JointController(sensor(), sensor(CurveModel(LINE)), law=law, gain=1.0)


@pytest.mark.parametrize("gain", [0.0, -1.0, math.nan, math.inf])
def test_a_gain_that_is_none(gain: float) -> None:
    with pytest.raises(InputError, match="is none"):
        controller(gain=gain)


def test_a_law_that_is_none() -> None:
    with pytest.raises(InputError, match="no control law 'pid'; there are p, branches, full"):
        controller("pid")  # type: ignore[arg-type]
