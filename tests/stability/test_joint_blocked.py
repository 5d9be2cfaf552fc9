"""Where a joint is held, blocked or read falsely: it is pushed for ever, unless that is noticed, and must be free again at once."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from joint import blocked, driven, told_deg

from calibration.control.controller import LAWS, Input, Law
from calibration.finger.simulated import HUMAN, RATE_HZ, ROBOT


@pytest.mark.parametrize("noise", [1.0, 0.0])
def test_a_joint_that_does_not_move_is_pushed_for_ever(branches: tuple[Input, Input], credulous: Callable[[], None], noise: float) -> None:
    """At 50 degrees, while the human's goes to 70 and stays there: the error stays, and so does the command."""
    sensors = (HUMAN, replace(ROBOT, noise=noise * ROBOT.noise))
    stays = {"human": lambda time: 45 + 25 * np.sin(min(time, 0.5 * np.pi)), "wall": lambda time: 50.0}
    _, commands = blocked(branches, sensors=sensors, seconds=20, law="p", **stays)
    assert told_deg(commands, 0) < 320
    assert "robot_V shows nothing of it" in next(command for command in commands if command.state == "block").reason
    credulous()
    _, commands = blocked(branches, sensors=sensors, seconds=20, law="p", **stays)
    assert told_deg(commands, 0) > 900 and commands[-1].state == "run"


@pytest.mark.parametrize("noise", [1.0, 0.0])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("top", "wall"), [(70.0, 50.0), (90.0, 95.0)], ids=["grasp", "stop"])
def test_who_held_something_can_let_it_go(branches: tuple[Input, Input], law: Law, noise: float, top: float, wall: float) -> None:
    """A grasp at 50 degrees, and a human beyond the range for ten seconds: blocked that way, and at once free the other way."""
    sensors = tuple(replace(sensor, noise=noise * sensor.noise) for sensor in (HUMAN, ROBOT))

    def human(time: float) -> float:
        return 45 + (top - 45) * min(time, 1.0) if time < 11 else max(top - 30 * (time - 11), 20.0)

    went, commands = blocked(branches, human=human, wall=lambda time: wall, seconds=18, sensors=sensors, law=law)
    assert "stop" not in {command.state for command in commands}
    assert went[1090] > wall - 20 and abs(went[-200:].mean() - 20) < 14
    assert {command.state for command in commands[-400:]} == {"run"}


@pytest.mark.parametrize("law", LAWS)
def test_a_hand_lets_go_as_fast_as_if_nothing_had_been_held(
    branches: tuple[Input, Input], law: Law, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The human opens by 400 deg/s after squeezing for 14 s: when the joint is 10 degrees off the object."""

    def late() -> int:
        went, _ = blocked(
            branches,
            human=lambda t: 45 + 35 * min(t, 1) if t < 15 else max(80 - 400 * (t - 15), 20),
            wall=lambda t: 50,
            seconds=17,
            law=law,
        )
        return int(np.flatnonzero(went[1500:] < 40)[0])

    held = late()
    monkeypatch.setattr("calibration.control.follows.FAR_PART", np.inf)
    assert held <= late() + 6


@pytest.mark.parametrize("law", LAWS)
def test_a_hand_that_was_off_is_back_by_itself(branches: tuple[Input, Input], law: Law) -> None:
    """Its drive is off from 2 to 6 s (an emergency stop), and works half as fast as told before and after; the human goes to and fro."""

    def off(time: float, command: float) -> float:
        return 0.0 if 2 < time < 6 else 0.5 * command

    went, commands = blocked(branches, human=lambda t: 45 + 25 * np.sin(t), wall=lambda t: 95.0, seconds=24, law=law, drive=off)
    assert "block" in {command.state for command in commands[200:800]}
    time = np.arange(1600, 2400) / RATE_HZ
    assert {command.state for command in commands[1600:]} == {"run"} and abs(went[1600:] - 45 - 25 * np.sin(time)).mean() < 15


def test_a_frozen_reading_of_the_robots_alone(branches: tuple[Input, Input], credulous: Callable[[], None]) -> None:
    """Without noise of its own it might be a joint at rest, were that not told to go further than slack is wide."""
    last = [np.nan]

    def freeze(time: float, human: float, robot: float) -> tuple[float, float]:
        last[0] = last[0] if time >= 3.0 else robot
        return human, last[0]

    silent = (HUMAN, replace(ROBOT, noise=0.0))
    _, _, commands = driven(branches, freeze, sensors=silent, until=4.5)
    assert "block" in {command.state for command in commands} and told_deg(commands, 300) < 160
    credulous()
    _, went, commands = driven(branches, freeze, sensors=silent, until=4.5)
    assert told_deg(commands, 300) > 200 and not 1 < went[300:].min() < went[300:].max() < 94


def test_a_wire_that_hums_shows_no_joint(branches: tuple[Input, Input], credulous: Callable[[], None]) -> None:
    """A robot's channel that hangs in the air, in the midst of its range: 50 Hz, which no joint makes, and never the same."""

    def hum(time: float, human: float, robot: float) -> tuple[float, float]:
        return human, 2.08 + 0.02 * np.sin(997 * time) if time >= 1.0 else robot

    _, _, commands = driven(branches, hum, sensors=(HUMAN, ROBOT), until=4.5)
    assert {"block"} <= {command.state for command in commands} and told_deg(commands, 100) < 160
    credulous()
    _, _, commands = driven(branches, hum, sensors=(HUMAN, ROBOT), until=4.5)
    assert told_deg(commands, 100) > 200
