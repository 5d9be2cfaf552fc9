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
from typing import Literal

import numpy as np

from calibration.control.follows import Follows
from calibration.control.frozen import Freezes
from calibration.control.laws import Beyond, Branches, Full, Published, Rule, Wanted
from calibration.strain.document import SensorCalibration
from calibration.strain.models import BranchModel
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
#: After a stop the speed may grow by this, deg/s^2: from rest to the limit in a second. What happened meanwhile nobody knows.
RESUME_DEG_S2 = 500.0
#: A reading further outside the calibrated ones than this, in their spans, was not read off a joint: a broken wire, or a wrong digit.
#: A joint that goes 15 degrees beyond a range of 70, where its sensor is three times as steep as on average, is 0.64 outside (the
#: human's in the paper; the robot's 0.34); an open wire of the robot's, at 0 or 3.3 V, is 2.4 outside at least.
FAR_SPANS = 1.0


@dataclass(frozen=True)
class Input:
    """A calibrated sensor, and which column of the frames it is."""

    calibration: SensorCalibration
    column: int = 0


@dataclass(frozen=True)
class Command:
    """What the joint is told, and why.

    Parameters
    ----------
    speed : float, deg/s
    state : str
        ``run``; ``block``: the joint does not go the way it was told to, and is told no more of that for a while; ``hold``: the last safe
        command once more; ``stop``: nothing good has come for too long.
    reason : str
        Why it is not ``run``; else empty.
    target, angle : float, deg
        Of the human's joint and of the robot's as they are believed to be; the last ones while not running.
    beyond : Beyond
        Which of both readings and the target lie outside what the calibrations know.
    clamped : bool
        The law asked for more than the limit, or for more than is allowed so soon after a stop.
    """

    speed: float
    state: Literal["run", "block", "hold", "stop"]
    reason: str
    target: float
    angle: float
    beyond: Beyond
    clamped: bool

    @property
    def outside(self) -> bool:
        """Is any of them outside?"""
        return any(self.beyond)


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
        self.period_s = period_s
        self._rule: Rule
        if law == "p":
            self._rule = Published(human.calibration.model, robot.calibration.model, gain)
        elif law == "branches":
            self._rule = Branches(branches_of(human, "human"), branches_of(robot, "robot"), gain)
        else:
            times = {"lag_s": lag_s, "delay_s": delay_s, "period_s": period_s, "hole_s": HOLD_S}
            self._rule = Full(branches_of(human, "human"), branches_of(robot, "robot"), gain, **times)
        self._readings = _calibrated(human), _calibrated(robot)
        curve = robot.calibration.model.curve
        self._ends = float(curve.signal(curve.low)), float(curve.signal(curve.high))
        self._seen: list[tuple[float, int] | None] = [None, None]
        span = robot.calibration.high - robot.calibration.low
        self._freezes = Freezes()
        self._follows = Follows(range_deg=span, late_s=lag_s + delay_s, period_s=period_s)
        self._safe = self._barred = 0.0
        self._last = Command(0.0, "stop", "no frame yet", math.nan, math.nan, Beyond(), False)
        self._good_at: float | None = None
        self._resumed_at: float | None = None

    def begin(self) -> None:
        """The joint stands still, wherever the human's is: the speed will grow from 0, as after a stop."""
        self._good_at = -math.inf

    def step(self, time: float, human: Frame | None, robot: Frame | None) -> Command:
        """The command from now (`time`, s, by the clock of the frames' `host_time`) until the next step."""
        frames, inputs = (human, robot), (self.human, self.robot)
        unfit = [
            _unfit(time, frame, of, whose, within)
            for frame, of, whose, within in zip(frames, inputs, ("human", "robot"), self._readings, strict=True)
        ]
        new = [None if unfit[k] else self._new(k, frame, inputs[k].column) for k, frame in enumerate(frames)]
        frozen = self._freezes.step(time, new[0], new[1])
        for k, whose in enumerate(("human", "robot")):
            if frozen[k] and not unfit[k]:
                unfit[k] = f"the {whose}'s channel {inputs[k].calibration.signal} {frozen[k]}; check its wires"
        readings = [
            None if why or frame is None else (float(frame.values[each.column]) - each.calibration.u0) / each.calibration.u0
            for why, frame, each in zip(unfit, frames, inputs, strict=True)
        ]
        # Also without a good frame of one of them: the other's is remembered, and that time went by.
        wanted = self._rule.step(time, readings[0], readings[1], self._last.speed)
        aim = self._last.target if wanted is None else wanted.target
        self._follows.step(self._part(new[1]) if readings[1] is not None else None, aim=aim, command=self._last.speed)
        if wanted is None:
            return self._without(time, next(why for why in unfit if why))
        if not math.isfinite(wanted.speed):
            return self._without(time, "the law gave no number")
        self._last = self._blocked(wanted) if self._follows.shut(wanted.speed) else self._run(time, wanted)
        self._safe, self._good_at = self._last.speed, time
        return self._last

    def _new(self, k: int, frame: Frame | None, column: int) -> float | None:
        """What a frame reads that was not there in the last step."""
        if frame is None or self._seen[k] == (frame.host_time, frame.sequence):
            return None
        self._seen[k] = frame.host_time, frame.sequence
        return float(frame.values[column])

    def _part(self, reading: float | None) -> float | None:
        """The robot's reading: 0 where its calibration begins, 1 where it ends."""
        if reading is None:
            return None
        calibration = self.robot.calibration
        begin, end = self._ends
        return ((reading - calibration.u0) / calibration.u0 - begin) / (end - begin)

    def _blocked(self, wanted: Wanted) -> Command:
        way = "greater" if wanted.speed > 0 else "smaller"
        reason = (
            f"told to go to {way} angles by {self._follows.far:.0f} degrees, the robot's channel {self.robot.calibration.signal} "
            "shows nothing of it: an object or its stop holds the joint, its drive is off or stuck, or its sensor is off"
        )
        self._barred = wanted.speed
        return Command(0.0, "block", reason, wanted.target, wanted.angle, wanted.beyond, True)

    def _run(self, time: float, wanted: Wanted) -> Command:
        # Away from what holds the joint it goes at once.
        tried = self._last.state == "block" and wanted.speed * self._barred > 0
        if self._good_at is not None and (tried or self._last.state == "stop" or not 0 <= time - self._good_at <= HOLD_S + self.period_s):
            self._resumed_at = time
        limit = self.limit
        if self._resumed_at is not None:
            limit = min(limit, RESUME_DEG_S2 * (time - self._resumed_at + self.period_s))
        speed = min(max(wanted.speed, -limit), limit)
        return Command(speed, "run", "", wanted.target, wanted.angle, wanted.beyond, speed != wanted.speed)

    def _without(self, time: float, reason: str) -> Command:
        held = self._good_at is not None and 0 <= time - self._good_at <= HOLD_S
        last = self._last
        self._last = Command(
            self._safe if held else 0.0, "hold" if held else "stop", reason, last.target, last.angle, last.beyond, last.clamped
        )
        return self._last


def branches_of(of: Input, whose: str) -> BranchModel:
    """The calibration's curves for rising and falling readings, which must be there."""
    branches = of.calibration.branches
    if branches is None:
        raise InputError(
            f"the {whose} sensor's calibration has the model {of.calibration.model.name}, without curves for flexion and extension; make "
            "it anew with skinfab calibrate of a log that goes there and back (--model branches says what is missing), or control with "
            "--controller p"
        )
    return branches


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


def _calibrated(of: Input) -> tuple[float, float]:
    """The least and the greatest reading (dU/U0) that the calibration knows."""
    curve = of.calibration.model.curve
    known = curve.signal(np.linspace(curve.low, curve.high, 101))
    return float(known.min()), float(known.max())


def _unfit(time: float, frame: Frame | None, of: Input, whose: str, within: tuple[float, float]) -> str:
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
    u0, (low, high) = of.calibration.u0, within
    reading = (float(frame.values[of.column]) - u0) / u0
    if not low - FAR_SPANS * (high - low) <= reading <= high + FAR_SPANS * (high - low):
        known = sorted((u0 * (1 + low), u0 * (1 + high)))
        return (
            f"the {whose}'s channel {of.calibration.signal} reads {frame.values[of.column]:.5g}, and was calibrated from {known[0]:.5g} to "
            f"{known[1]:.5g}: a broken wire, or a wrong digit"
        )
    return ""
