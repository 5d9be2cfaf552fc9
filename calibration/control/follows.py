"""Does the joint go where it is told to? What its sensor shows is held against the travel that was commanded.

A joint that an object holds, one at its stop, one whose drive is stuck and a channel that shows something else than the joint
look alike: told to go far one way, the reading does not go that way. So the joint is not driven further that way, and may go
the other. Told far both ways in vain, it is stopped.
"""

from __future__ import annotations

import math
from collections import deque

#: So far one way, in parts of the calibrated range, is far. Slack takes 0.26 of it in the paper's finger and the way between the
#: joint's stop and the range's end, where a curve may be flat, 0.21: 0.47; and a drive may do less than it is told.
FAR_PART = 0.75
#: A reading went on where it did by this part of the calibrated readings: a frame's noise is 0.007 of them in the paper's finger ...
WENT_PART = 0.05
#: ... and the mean over this time, s, is looked at.
MEAN_S = 0.1
#: Where the human's angle goes on by this part of the range, the joint is tried that way once more: it may have been a drive that
#: does not move for a small command, or an object that lets go. Once, for who bends to and fro would drive a stuck one for ever.
TRIED_PART = 0.15


class Way:
    """One way of a joint.

    Parameters
    ----------
    sign : int
        1: towards greater angles; -1: the other way.
    far, tried : float, deg
        Told to go on by `far` in vain it is shut, and tried again when the aim goes on by `tried`.
    """

    def __init__(self, sign: int, *, far: float, tried: float) -> None:
        self._sign, self._far, self._tried = sign, far, tried
        self.shut, self._again = False, True
        self._told = self._shown = math.nan
        self._aim = self._end = 0.0

    def step(self, told: float, shown: float) -> bool:
        """What was told until now, deg, and what is shown, in parts of the calibrated readings; did the joint go this way, as told?"""
        told, shown = self._sign * told, self._sign * shown
        as_told = False
        if shown >= self._shown + WENT_PART:
            as_told, self.shut, self._again = told > self._told, False, True
            self._told = self._shown = math.nan
        if math.isnan(self._told) or told < self._told:
            self._told, self._shown = told, shown
        self._shown = min(self._shown, shown)
        return as_told

    def judge(self, told: float, now: float, aim: float) -> None:
        """Shut it where it was told to go on in vain; by `now` it was told a little more."""
        if not self.shut and self._sign * told - self._told > self._far:
            self.shut, self._aim, self._end = True, self._sign * aim, self._sign * now

    def ends(self, told: float) -> bool:
        """Is it shut, and would this be further than ever? What went back may come again: else noise would drive it back and back."""
        return self.shut and self._sign * told > self._end

    def may_try(self, aim: float) -> bool:
        """Is the aim further this way by now, for the first time since the joint went?"""
        return self.shut and self._again and self._sign * aim > self._aim + self._tried

    def open(self, told: float, *, again: bool) -> None:
        """Let the joint be told to go this way; may it be tried once more after that?"""
        self.shut, self._again, self._told = False, again, self._sign * told


class Follows:
    """Which ways a controller's joint must not be told to go.

    Parameters
    ----------
    range_deg : float
        That the robot's sensor is calibrated for.
    late_s : float
        From a command to the frame that shows it.
    period_s : float
        Between steps.

    Examples
    --------
    A joint of 70 degrees, told to go up by a degree a step, which shows nothing of it; then down, and it does go down:

    >>> follows = Follows(range_deg=70, late_s=0, period_s=0.01)
    >>> for step in range(70):
    ...     follows.step(0.5, aim=60, command=100)
    >>> follows.shut(100), follows.shut(-100)
    (True, False)
    >>> for step in range(30):
    ...     follows.step(0.5 - step / 100, aim=30, command=-100)
    >>> follows.shut(100), follows.stuck
    (False, False)
    """

    def __init__(self, *, range_deg: float, late_s: float, period_s: float) -> None:
        self._period, self.far = period_s, FAR_PART * range_deg
        self._mean = max(round(MEAN_S / period_s), 1)
        # The mean shows what was half its length ago.
        self._told = deque([0.0], maxlen=math.ceil(late_s / period_s) + 1 + self._mean // 2)
        self._readings: deque[float] = deque(maxlen=self._mean)
        self._up, self._down = (Way(sign, far=self.far, tried=TRIED_PART * range_deg) for sign in (1, -1))

    @property
    def stuck(self) -> bool:
        """Told both ways in vain: the joint must be stopped, until its reading goes on."""
        return self._up.shut and self._down.shut

    def step(self, reading: float | None, *, aim: float, command: float) -> None:
        """Another period under a command, deg/s; a new reading in parts of the calibrated ones, 0 at the least angle and 1 at the greatest.

        `aim` is the angle that is aimed at, deg.
        """
        self._told.append(self._told[-1] + command * self._period)
        if reading is not None:
            self._readings.append(reading)
        if len(self._readings) < self._mean:
            return
        told, shown = self._told[0], sum(self._readings) / self._mean
        for way, back in ((self._up, self._down), (self._down, self._up)):
            if way.step(told, shown) and back.shut:
                back.open(told, again=True)
        for way in (self._up, self._down):
            way.judge(told, self._told[-1], aim)
            if way.may_try(aim) and not self.stuck:
                way.open(told, again=False)

    def shut(self, speed: float) -> bool:
        """Would a period of this speed, deg/s, lead further where the joint does not go?"""
        way, told = self._up if speed > 0 else self._down, self._told[-1] + speed * self._period
        return speed != 0 and way.ends(told)
