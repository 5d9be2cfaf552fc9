"""Does the joint go where it is told to? What its sensor shows is held against the travel that was commanded.

A joint that an object holds, one at its stop, one whose drive is off and a channel that shows something else than the joint
look alike: told to go far one way, the reading does not go that way. So the joint is not driven further that way for a while,
and may go the other. Nothing is shut for good: which of them it was, and for how long, nobody knows.
"""

from __future__ import annotations

import math
from collections import deque

#: So far one way, in parts of the calibrated range, is far. Slack takes 0.26 of it in the paper's finger and the way between the
#: joint's stop and the range's end, where a curve may be flat, 0.21: twice that is 0.94, as a drive may do half of what it is told.
FAR_PART = 1.0
#: A reading went on where it did by this part of the calibrated readings: a frame's noise is 0.007 of them in the paper's finger ...
WENT_PART = 0.05
#: ... and the mean over this time, s, and so many frames is looked at.
MEAN_S, MEAN_FRAMES = 0.1, 10
#: A way that is shut is tried again after so long, s, and in vain after twice as long each time, but no longer than the second:
#: who has grasped something is not pressed again and again, and a hand that was off is back before one looks for a fault.
SHUT_S, LONGEST_S = 2.0, 8.0
#: After the first of these times it is also tried where the aim went on by this part of the range: a drive that does not move for a
#: small command was told so for long while the human held still.
AIM_PART = 0.15


class Way:
    """One way of a joint.

    Parameters
    ----------
    sign : int
        1: towards greater angles; -1: the other way.
    far : float, deg
        Told to go on by so much in vain, it is shut.
    on : float, deg
        An aim that is further than when it was shut by so much went on.
    period_s : float
        Between steps.
    """

    def __init__(self, sign: int, *, far: float, on: float, period_s: float) -> None:
        self._sign, self._far, self._on, self._period = sign, far, on, period_s
        self.shut = False
        self._wait = SHUT_S
        self._lasts = self._must = 0.0
        self._told = self._shown = math.nan
        self._end = self._aim = 0.0

    def step(self, told: float, shown: float) -> bool:
        """What was told until now, deg, and what is shown, in parts of the calibrated readings; did the joint go this way, as told?"""
        told, shown = self._sign * told, self._sign * shown
        as_told = False
        if shown >= self._shown + WENT_PART:
            as_told, self.shut, self._wait = told > self._told, False, SHUT_S
            self._told = self._shown = math.nan
        if math.isnan(self._told) or told < self._told:
            self._told, self._shown = told, shown
        self._shown = min(self._shown, shown)
        return as_told

    def judge(self, told: float, now: float, aim: float) -> None:
        """Shut it where it was told to go on in vain; by `now` it was told a little more. Or let it be tried again."""
        if self.shut:
            self._lasts += self._period
            goes_on = self._sign * aim > self._aim + self._on
            if self._lasts >= (SHUT_S if goes_on else self._must):
                self.open(told)
        elif self._sign * told - self._told > self._far:
            self.shut, self._end, self._aim = True, self._sign * now, self._sign * aim
            self._lasts, self._must = 0.0, self._wait
            self._wait = min(2 * self._wait, LONGEST_S)

    def open(self, told: float) -> None:
        """Let the joint be told to go this way."""
        self.shut, self._told = False, self._sign * told

    def ends(self, told: float) -> bool:
        """Is it shut, and would this be further than ever? What went back may come again: else noise would drive it back and back."""
        return self.shut and self._sign * told > self._end


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
    >>> for step in range(100):
    ...     follows.step(0.5, aim=60, command=100)
    >>> follows.shut(100), follows.shut(-100)
    (True, False)
    >>> for step in range(30):
    ...     follows.step(0.5 - step / 100, aim=30, command=-100)
    >>> follows.shut(100)
    False
    """

    def __init__(self, *, range_deg: float, late_s: float, period_s: float) -> None:
        self._period, self.far = period_s, FAR_PART * range_deg
        self._mean = max(round(MEAN_S / period_s), MEAN_FRAMES)
        # The mean shows what was half its length ago.
        self._told = deque([0.0], maxlen=math.ceil(late_s / period_s) + 1 + self._mean // 2)
        self._readings: deque[float] = deque(maxlen=self._mean)
        self._up, self._down = (Way(sign, far=self.far, on=AIM_PART * range_deg, period_s=period_s) for sign in (1, -1))

    def step(self, reading: float | None, *, aim: float, command: float) -> None:
        """Another period under a command, deg/s; a new reading in parts of the calibrated ones: 0 at the least angle, 1 at the greatest.

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
                back.open(told)
        for way in (self._up, self._down):
            way.judge(told, self._told[-1], aim)

    def shut(self, speed: float) -> bool:
        """Would a period of this speed, deg/s, lead further where the joint does not go?"""
        way, told = self._up if speed > 0 else self._down, self._told[-1] + speed * self._period
        return speed != 0 and way.ends(told)
