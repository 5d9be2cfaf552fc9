"""A robot's joint follows a human's: what is read at both, what the robot is told, and when it is told to stop.

After "Soft Sensing Skins for Arbitrary Objects", section II.C: the human's reading becomes an angle by the human's curve, the
angle a reading of the robot's sensor by the robot's curve, and a proportional controller drives the robot's reading there.
Its discussion names the hysteresis of the sensors as what limits that; the two other laws answer it.

p         as published.
branches  proportional in the angle, both angles read from the branch of the curve that the joint is on.
full      besides, the human's angle is led on to the present, its speed and acceleration are fed forward through the
          joint's lag, and the robot's angle is carried through delay and slack by the commands it was given.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

from calibration.control.lead import Lead
from calibration.control.observer import JointObserver
from calibration.strain.curve import Curve
from calibration.strain.document import SensorCalibration
from calibration.strain.models import BranchModel, Model
from skinfab.errors import InputError
from skinfab.readout.frame import Frame

Law = Literal["p", "branches", "full"]
LAWS: tuple[Law, ...] = ("p", "branches", "full")

#: No command is faster, deg/s: what a tendon-driven finger can do.
LIMIT_DEG_S = 500.0
#: A frame older than this is stale, s: ten frames at the usual rate.
MAX_AGE_S = 0.1
#: For so long the last safe command goes on without a good frame, s; then the joint is stopped.
HOLD_S = 0.1


@dataclass(frozen=True)
class Input:
    """A calibrated sensor, and which column of the frames it is."""

    calibration: SensorCalibration
    column: int = 0


class Beyond(NamedTuple):
    """What lies outside the calibrated ranges, so that the end of the range was taken instead."""

    human: bool = False  # the human's reading
    target: bool = False  # the angle aimed at, which the robot's curve does not have
    robot: bool = False  # the robot's reading


@dataclass(frozen=True)
class Command:
    """What the joint is told, and why.

    Parameters
    ----------
    speed : float, deg/s
    state : str
        ``run``; ``hold``: the last safe command once more; ``stop``: nothing good has come for too long.
    reason : str
        Why it is not ``run``; else empty.
    target, angle : float, deg
        Of the human's joint and of the robot's as they are believed to be; the last ones while not running.
    beyond : Beyond
        Which of both readings and the target lie outside what the calibrations know.
    clamped : bool
        The law asked for more than the limit.
    """

    speed: float
    state: Literal["run", "hold", "stop"]
    reason: str
    target: float
    angle: float
    beyond: Beyond
    clamped: bool

    @property
    def outside(self) -> bool:
        """Is any of them outside?"""
        return any(self.beyond)


class _Rule(Protocol):
    """A control law: readings (dU/U0) and the last command in, speed, target, angle and what was outside out."""

    def step(self, time: float, human: float, robot: float, command: float) -> tuple[float, float, float, Beyond]: ...


class JointController:
    """Commands for the robot's joint, one for each pair of frames.

    It knows calibrations, frames and the time, and nothing of where they come from.

    Parameters
    ----------
    human, robot : Input
    law : str
        One of `LAWS`.
    gain : float, 1/s
        Speed per degree of error. The published law works on readings: there it is that at the robot curve's mean slope.
    lag_s, delay_s : float
        Of the robot's joint and of both readings; only ``full`` uses them.
    period_s : float
        Between steps.
    limit_deg_s : float
        Of the command.

    Raises
    ------
    InputError
        The gain or the law is none, or a calibration has no branches for a law that needs them.
    """

    def __init__(
        self,
        human: Input,
        robot: Input,
        *,
        law: Law = "full",
        gain: float,
        lag_s: float = 0.1,
        delay_s: float = 0.05,
        period_s: float = 0.01,
        limit_deg_s: float = LIMIT_DEG_S,
    ) -> None:
        if not (math.isfinite(gain) and gain > 0):
            raise InputError(f"a gain of {gain:g} 1/s is none; give a positive one, or let it be chosen from the margin")
        if law not in LAWS:
            raise InputError(f"there is no control law {law!r}; there are {', '.join(LAWS)}")
        self.human, self.robot, self.limit = human, robot, limit_deg_s
        self._rule: _Rule
        if law == "p":
            self._rule = _Published(human.calibration.model, robot.calibration.model, gain)
        elif law == "branches":
            self._rule = _Branches(branches_of(human, "human"), branches_of(robot, "robot"), gain)
        else:
            self._rule = _Full(
                branches_of(human, "human"), branches_of(robot, "robot"), gain, lag_s=lag_s, delay_s=delay_s, period_s=period_s
            )
        self._safe = 0.0
        self._last = Command(0.0, "stop", "no frame yet", math.nan, math.nan, Beyond(), False)
        self._good_at: float | None = None

    def step(self, time: float, human: Frame | None, robot: Frame | None) -> Command:
        """The command from now (`time`, s, by the clock of the frames' `host_time`) until the next step."""
        reason = _unfit(time, human, self.human, "human") or _unfit(time, robot, self.robot, "robot")
        if reason:
            return self._without(time, reason)
        assert human is not None and robot is not None
        readings = [
            (float(frame.values[each.column]) - each.calibration.u0) / each.calibration.u0
            for frame, each in ((human, self.human), (robot, self.robot))
        ]
        wanted, target, angle, beyond = self._rule.step(time, readings[0], readings[1], self._last.speed)
        if not math.isfinite(wanted):
            return self._without(time, "the law gave no number")
        speed = min(max(wanted, -self.limit), self.limit)
        self._safe, self._good_at = speed, time
        self._last = Command(speed, "run", "", target, angle, beyond, speed != wanted)
        return self._last

    def _without(self, time: float, reason: str) -> Command:
        held = self._good_at is not None and 0 <= time - self._good_at <= HOLD_S
        last = self._last
        self._last = Command(
            self._safe if held else 0.0, "hold" if held else "stop", reason, last.target, last.angle, last.beyond, last.clamped
        )
        return self._last


def branches_of(of: Input, whose: str) -> BranchModel:
    """The calibration's model, which must have branches."""
    model = of.calibration.model
    if not isinstance(model, BranchModel):
        raise InputError(
            f"the {whose} sensor's calibration has the model {model.name}, without curves for flexion and extension; make it anew with "
            "skinfab calibrate --model branches, or control with --controller p"
        )
    return model


def require_two_sensors(human: Input, robot: Input, *, names: tuple[str, str], one_board: bool) -> None:
    """Refuse one sensor for both: a robot that follows itself, by its own curve.

    Parameters
    ----------
    human, robot : Input
    names : (str, str)
        Of both calibrations, for the message.
    one_board : bool
        Both are channels of one stream, so that their names tell them apart.

    Raises
    ------
    InputError
        Both are made from the same readings, or from one channel of one board.
    """
    one, other = human.calibration, robot.calibration
    if one.signal == other.signal and (one_board or one.made_from == other.made_from):
        same = f"{names[0]} and {names[1]} are both of the sensor {one.signal!r}"
        if one.made_from == other.made_from:
            same += ", made from the same log"
        raise InputError(f"{same}; the human's sensor and the robot's are two: give each its own calibration")


def _unfit(time: float, frame: Frame | None, of: Input, whose: str) -> str:
    """Why a frame must not be used; empty where it may."""
    if frame is None:
        return f"no frame of the {whose} sensor"
    if of.column >= len(frame.values):
        return f"the {whose} sensor's frame has {len(frame.values)} channels"
    if not abs(time - frame.host_time) <= MAX_AGE_S:
        return f"the {whose} sensor's frame is stale"
    if not (frame.valid[of.column] and math.isfinite(frame.values[of.column])):
        return f"the {whose} sensor's frame is invalid"
    if frame.saturated[of.column]:
        return f"the {whose} sensor is saturated"
    return ""


class _Published:
    """Proportional on dU/U0, by the curves alone."""

    def __init__(self, human: Model, robot: Model, gain: float) -> None:
        self._human, self._robot = human.curve, robot.curve
        self._gain = gain / mean_slope(self._robot)

    def step(self, time: float, human: float, robot: float, command: float) -> tuple[float, float, float, Beyond]:
        target, far = self._human.angle(human)
        aim = min(max(float(target), self._robot.low), self._robot.high)
        angle, out = self._robot.angle(robot)
        speed = self._gain * (float(self._robot.signal(aim)) - robot)
        return speed, aim, float(angle), Beyond(bool(far), aim != float(target), bool(out))


class _Branches:
    """Proportional in the angle, by the branches."""

    def __init__(self, human: BranchModel, robot: BranchModel, gain: float) -> None:
        self._human, self._robot, self._gain = human.tracker(), robot.tracker(), gain
        self._low, self._high = robot.curve.low, robot.curve.high

    def step(self, time: float, human: float, robot: float, command: float) -> tuple[float, float, float, Beyond]:
        target, far = self._human.step(time, human)
        angle, out = self._robot.step(time, robot)
        aim = min(max(target, self._low), self._high)
        return self._gain * (aim - angle), aim, angle, Beyond(bool(far), aim != target, bool(out))


class _Full:
    """The same of angles led on to the present, with the human's speed fed forward."""

    def __init__(self, human: BranchModel, robot: BranchModel, gain: float, *, lag_s: float, delay_s: float, period_s: float) -> None:
        self._human, self._gain, self._lag = human.tracker(), gain, lag_s
        self._lead = Lead(delay_s, period_s)
        self._observer = JointObserver(robot, lag_s=lag_s, delay_s=delay_s, period_s=period_s)
        self._curve = robot.curve

    def step(self, time: float, human: float, robot: float, command: float) -> tuple[float, float, float, Beyond]:
        shown, far = self._human.step(time, human)
        target, speed, acceleration = self._lead.step(shown)
        angle = self._observer.step(robot, command)
        aim = min(max(target, self._curve.low), self._curve.high)
        # At an end of the range there is nothing to go on to.
        ahead = 0.0 if aim != target else speed + self._lag * acceleration
        _, out = self._curve.angle(robot)
        return self._gain * (aim - angle) + ahead, aim, angle, Beyond(bool(far), aim != target, bool(out))


def mean_slope(curve: Curve) -> float:
    """Of a curve that does not turn, over its range, 1/deg."""
    return float(curve.ordinates[-1] - curve.ordinates[0]) / (curve.high - curve.low)
