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
    hole_s : float
        After longer without a reading the angle is put where the next one allows, at once.
    """

    def __init__(self, model: BranchModel, *, lag_s: float, delay_s: float, period_s: float, hole_s: float) -> None:
        self._model = model
        self._kept = math.exp(-period_s / lag_s) if lag_s > 0 else 0.0
        self._lag, self._period = lag_s, period_s
        self._way = Way(model, period_s)
        self._angle: float | None = None
        self._speed = 0.0
        self._delay = round(delay_s / period_s)
        self._past: deque[float] = deque(maxlen=self._delay + max(round(MOVING_S / period_s), 1))
        self._correction = period_s / CORRECTION_S
        self._most = round(hole_s / period_s)
        self._before = math.nan
        self._missing = 0

    def restart(self) -> None:
        """Nobody knows what happened since the last step: begin anew."""
        self._angle, self._speed, self._missing = None, 0.0, 0
        self._past.clear()
        self._way.clear()

    def step(self, signal: float | None, command: float, *, steps: int = 1) -> float | None:
        """The angle now.

        Parameters
        ----------
        signal : float or None
            The reading (dU/U0) that has just arrived; None where there is no good one.
        command : float, deg/s
            In force since the last step.
        steps : int
            Periods since then.

        Returns
        -------
        angle : float or None, deg
            None before the first reading.
        """
        if self._angle is not None:
            for _ in range(steps):
                self._go_on(command)
        self._missing += steps
        if signal is None or (steps == 0 and self._angle is not None):
            return self._angle
        went, self._missing = self._missing, 0
        if self._angle is None or went > self._most + 1:
            return self._placed(signal)
        for k in range(1, went + 1):
            low, high, way, ago = self._way.step(self._before + (signal - self._before) * k / went)
        self._before = signal
        then = self._past[max(len(self._past) - 1 - self._delay - ago, 0)]
        shown = high if way > 0 else low if way < 0 else min(max(then, low), high)
        return self._moved((1 - math.exp(-went * self._correction)) * (shown - then))

    def _go_on(self, command: float) -> None:
        assert self._angle is not None
        self._angle += command * self._period + (self._speed - command) * self._lag * (1 - self._kept)
        self._speed = command + (self._speed - command) * self._kept
        self._past.append(self._angle)

    def _placed(self, signal: float) -> float:
        """The first reading, or the first one for long: the angle is where it allows, in its middle where nothing is known."""
        self._way.clear()
        low, high, _, _ = self._way.step(signal)
        self._before = signal
        if self._angle is None:
            self._angle = (low + high) / 2
            self._past.append(self._angle)
        return self._moved(min(max(self._angle, low), high) - self._angle)

    def _moved(self, error: float) -> float:
        assert self._angle is not None
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

    def clear(self) -> None:
        """What came before is too long ago."""
        self._recent.clear()

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
        up, down = self._model.rising.angle_of(now)[0], self._model.falling.angle_of(now)[0]
        way = 0 if abs(moved) <= self._least else self._sign if moved > 0 else -self._sign
        return min(up, down), max(up, down), way, max(half - 1, 0) // 2
