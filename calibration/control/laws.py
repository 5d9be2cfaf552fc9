"""The control laws: readings of both sensors in, a speed out; and what they remember, which knows how much time went by."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from calibration.control.lead import Lead
from calibration.control.observer import JointObserver
from calibration.control.pace import Pace
from calibration.strain.curve import Curve
from calibration.strain.models import BranchModel, Model


class Beyond(NamedTuple):
    """What lies outside the calibrated ranges, so that the end of the range was taken instead."""

    human: bool = False  # the human's reading
    target: bool = False  # the angle aimed at, which the robot's curve does not have
    robot: bool = False  # the robot's reading


class Wanted(NamedTuple):
    """What a law asks for: speed (deg/s), target and angle (deg), and what was outside."""

    speed: float
    target: float
    angle: float
    beyond: Beyond


class Rule(Protocol):
    """A control law."""

    def step(self, time: float, human: float | None, robot: float | None, command: float) -> Wanted | None:
        """What is wanted now.

        Parameters
        ----------
        time : float, s
        human, robot : float or None
            Readings (dU/U0); None where there is no good one. What the other shows is remembered all the same.
        command : float, deg/s
            In force since the last step.

        Returns
        -------
        wanted : Wanted or None
            None without both readings.
        """
        ...


class Published:
    """Proportional on dU/U0, by the curves alone."""

    def __init__(self, human: Model, robot: Model, gain: float) -> None:
        self._human, self._robot = human.curve, robot.curve
        self._gain = gain / mean_slope(self._robot)

    def step(self, time: float, human: float | None, robot: float | None, command: float) -> Wanted | None:
        """As `Rule.step`."""
        if human is None or robot is None:
            return None
        target, far = self._human.angle_of(human)
        aim = min(max(target, self._robot.low), self._robot.high)
        angle, out = self._robot.angle_of(robot)
        speed = self._gain * (float(self._robot.signal(aim)) - robot)
        return Wanted(speed, aim, angle, Beyond(far, aim != target, out))


class Branches:
    """Proportional in the angle, by the branches."""

    def __init__(self, human: Model, robot: BranchModel, gain: float) -> None:
        self._human, self._robot, self._gain = human.tracker(), robot.tracker(), gain
        self._low, self._high = robot.curve.low, robot.curve.high

    def step(self, time: float, human: float | None, robot: float | None, command: float) -> Wanted | None:
        """As `Rule.step`. Slack does not know time: which branch a reading is on holds over a hole."""
        of_human = None if human is None else self._human.step(time, human)
        of_robot = None if robot is None else self._robot.step(time, robot)
        if of_human is None or of_robot is None:
            return None
        (target, far), (angle, out) = of_human, of_robot
        aim = min(max(target, self._low), self._high)
        return Wanted(self._gain * (aim - angle), aim, angle, Beyond(far, aim != target, out))


class Full:
    """The same of angles led on to the present, with the human's speed fed forward.

    Over a hole of up to `hole_s` both go on in steps of the period: the human's angle counts as having gone straight, and the
    robot's goes on by its commands. After a longer one the human's speed is not known: it begins anew at rest. The robot's angle
    goes on by its commands, but lies where the reading allows.
    """

    def __init__(
        self, human: Model, robot: BranchModel, gain: float, *, lag_s: float, delay_s: float, period_s: float, hole_s: float
    ) -> None:
        self._human, self._gain, self._lag = human.tracker(), gain, lag_s
        self._lead, self._shown = Lead(delay_s, period_s), Pace(period_s, hole_s)
        self._observer, self._driven = (
            JointObserver(robot, lag_s=lag_s, delay_s=delay_s, period_s=period_s, hole_s=hole_s),
            Pace(period_s, hole_s),
        )
        self._curve = robot.curve

    def step(self, time: float, human: float | None, robot: float | None, command: float) -> Wanted | None:
        """As `Rule.step`."""
        angle = self._observed(time, robot, command)
        if human is None:
            return None
        shown, far = self._human.step(time, human)
        if (steps := self._shown.steps(time)) is None:
            self._lead.restart()
        target, speed, acceleration = self._lead.step(shown, steps=1 if steps is None else steps)
        if robot is None or angle is None:
            return None
        aim = min(max(target, self._curve.low), self._curve.high)
        # At an end of the range there is nothing to go on to.
        ahead = 0.0 if aim != target else speed + self._lag * acceleration
        _, out = self._curve.angle_of(robot)
        return Wanted(self._gain * (aim - angle) + ahead, aim, angle, Beyond(far, aim != target, out))

    def _observed(self, time: float, robot: float | None, command: float) -> float | None:
        if (steps := self._driven.steps(time)) is None:
            self._observer.restart()
        return self._observer.step(robot, command, steps=1 if steps is None else steps)


def mean_slope(curve: Curve) -> float:
    """Of a curve that does not turn, over its range, 1/deg."""
    return float(curve.ordinates[-1] - curve.ordinates[0]) / (curve.high - curve.low)
