"""A channel that has frozen: it says one thing to the last digit, while count and clock go on.

A reading that repeats is no fault by itself: behind a coarse converter a joint at rest gives the same one for minutes, and so
does one that turns within its slack. A channel counts as frozen where that cannot be: it showed more noise than its converter's
step before, and shows none now; or both stop in one frame in the midst of motion, which two joints do not. It is good again as
soon as it reads something else. (A robot's reading that does not go where the joint is told to is for `follows`.)
"""

from __future__ import annotations

import math
from collections import deque

#: A noisy channel has frozen where its reading repeats for so long, s, and so many frames, and so many times as long as it ever did.
#: With noise of three steps a reading repeats in one of ten frames: twenty times in a row once in 1e20.
FROZEN_S, FROZEN_FRAMES, FROZEN_TIMES = 0.3, 20, 5
#: It is noisy where it went to and fro, by so many steps of its converter each way (one is a flicker between two) ...
NOISY_STEPS = 2
#: ... in more than this part of so many frames: of white noise in two thirds. A hand's tremor, 10 Hz, turns in a fifth at 100 Hz.
NOISY_PART, NOISY_FRAMES = 0.4, 100
#: In the midst of motion: in each of so many frames a reading changed by so many steps of its converter.
MOTION_FRAMES, MOTION_STEPS = 5, 3


class Repeats:
    """How long a reading has been the same, and what it was like before.

    Examples
    --------
    >>> noisy, still = Repeats(), Repeats()
    >>> for k in range(200):
    ...     noisy.see(k / 100, 1.5 + 0.001 * ((0, 3, 1, 2, 4)[k % 5] if k < 150 else 2))
    ...     still.see(k / 100, 1.5 + 0.001 * (k // 10 if k < 150 else 14))
    >>> noisy.frozen, still.frozen
    (True, False)
    """

    def __init__(self) -> None:
        self._last = math.nan
        self._change = 0.0
        self._step = math.inf
        self._turns: deque[bool] = deque(maxlen=NOISY_FRAMES)
        self._noisy = False
        self._moving = 0
        self._since = 0.0
        self._longest = 0
        self.repeats, self.lasts_s = 0, 0.0

    def see(self, time: float, reading: float) -> None:
        """A new frame's reading; it is not NaN."""
        if math.isnan(self._last):
            self._last, self._since = reading, time
            return
        change, self._last = reading - self._last, reading
        if change == 0:
            self.repeats += 1
            self.lasts_s = time - self._since
            return
        self._step = min(self._step, abs(change))
        least = (NOISY_STEPS - 0.5) * self._step  # half a step less, for steps are not told to the last digit
        self._turns.append(self._change * change < 0 and min(abs(change), abs(self._change)) >= least)
        self._noisy = self._noisy or (len(self._turns) == NOISY_FRAMES and sum(self._turns) > NOISY_PART * NOISY_FRAMES)
        self._moving = self._moving + 1 if not self.repeats and abs(change) >= (MOTION_STEPS - 0.5) * self._step else 0
        self._longest = max(self._longest, self.repeats)
        self._change, self._since, self.repeats, self.lasts_s = change, time, 0, 0.0

    @property
    def long(self) -> bool:
        """For longer than by chance, were it noisy."""
        return self.lasts_s >= FROZEN_S and self.repeats >= FROZEN_FRAMES

    @property
    def frozen(self) -> bool:
        """Does it lack the noise that it had?"""
        return self._noisy and self.long and self.repeats >= FROZEN_TIMES * self._longest

    @property
    def in_motion(self) -> bool:
        """Did it move when it began to repeat?"""
        return self._moving >= MOTION_FRAMES


class Freezes:
    """Which channels of a controller have frozen."""

    def __init__(self) -> None:
        self._human, self._robot = Repeats(), Repeats()

    def step(self, time: float, human: float | None, robot: float | None) -> tuple[str, str]:
        """Why the human's reading must not be used and why the robot's, empty where they may; without a new frame a reading is None."""
        for each, reading in ((self._human, human), (self._robot, robot)):
            if reading is not None:
                each.see(time, reading)
        if self._both:
            return (f"{_repeated(self._human)}, and from the same frame on as the robot's: both are frozen",) * 2
        noisy = "and was noisy before: it is frozen"
        human_told, robot_told = (f"{_repeated(each)}, {noisy}" if each.frozen else "" for each in (self._human, self._robot))
        return human_told, robot_told

    @property
    def _both(self) -> bool:
        human, robot = self._human, self._robot
        return human.long and robot.long and human.repeats == robot.repeats and human.in_motion and robot.in_motion


def _repeated(of: Repeats) -> str:
    return f"read the same to the last digit for {of.lasts_s:.2g} s"
