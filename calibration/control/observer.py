"""Where a joint is now, from a reading that is late and has slack, and from the commands that the joint was given.

Within its slack a reading says no more than that the angle lies between those of its falling and of its rising branch. Only
while it moves is the angle known: on the branch of its way. In between, the joint is where the commands must have brought it.
"""

from __future__ import annotations

import math
from collections import deque

from calibration.strain.models import BranchModel

#: A reading moves where its mean over `MOVING_S` differs from that over the same time before by more than this part of its span.
MOVING_PART = 0.02
MOVING_S = 0.05
#: Time constant with which the angle follows a reading that contradicts it, s.
CORRECTION_S = 0.2


class JointObserver:
    """The angle of a joint that is driven by commanded speeds.

    Parameters
    ----------
    model : BranchModel
        Of its sensor.
    lag_s, delay_s : float
        Time constant of the joint's speed; from motion to the frame that shows it.
    period_s : float
        Between steps.
    """

    def __init__(self, model: BranchModel, *, lag_s: float, delay_s: float, period_s: float) -> None:
        self._model = model
        self._kept = math.exp(-period_s / lag_s) if lag_s > 0 else 0.0
        self._lag, self._period = lag_s, period_s
        self._way = Way(model, period_s)
        self._angle: float | None = None
        self._speed = 0.0
        self._delay = round(delay_s / period_s)
        self._past: deque[float] = deque(maxlen=self._delay + max(round(MOVING_S / period_s), 1))
        self._share = 1 - math.exp(-period_s / CORRECTION_S)

    def step(self, signal: float, command: float) -> float:
        """The angle (deg) now: `signal` (dU/U0) has just arrived, and `command` (deg/s) was in force since the last step."""
        low, high, way, ago = self._way.step(signal)
        if self._angle is None:
            self._angle = (low + high) / 2
        self._angle += command * self._period + (self._speed - command) * self._lag * (1 - self._kept)
        self._speed = command + (self._speed - command) * self._kept
        self._past.append(self._angle)
        then = self._past[max(len(self._past) - 1 - self._delay - ago, 0)]
        shown = high if way > 0 else low if way < 0 else min(max(then, low), high)
        error = self._share * (shown - then)
        self._angle += error
        for k in range(len(self._past)):
            self._past[k] += error
        return self._angle


class Way:
    """Which angles a reading allows, and which way it goes."""

    def __init__(self, model: BranchModel, period_s: float) -> None:
        self._model = model
        self._least = MOVING_PART * abs(float(model.curve.ordinates[-1] - model.curve.ordinates[0]))
        self._sign = 1 if model.curve.rising else -1
        self._recent: deque[float] = deque(maxlen=2 * max(round(MOVING_S / period_s), 1))

    def step(self, signal: float) -> tuple[float, float, int, int]:
        """What the reading says, its noise evened out.

        Returns
        -------
        low, high : float, deg
            The least and the greatest angle that it allows.
        way : int
            1: the angle grows, -1: it falls, 0: nobody knows.
        ago : int
            For how many steps before this one that is so.
        """
        self._recent.append(signal)
        recent, half = list(self._recent), len(self._recent) // 2
        if half:
            now = sum(recent[-half:]) / half
            moved = now - sum(recent[:half]) / half
        else:
            now, moved = signal, 0.0
        up, down = float(self._model.rising.angle(now)[0]), float(self._model.falling.angle(now)[0])
        way = 0 if abs(moved) <= self._least else self._sign if moved > 0 else -self._sign
        return min(up, down), max(up, down), way, max(half - 1, 0) // 2
