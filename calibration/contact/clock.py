"""One clock for a whole recording: a device that starts anew in the middle of it goes on where it was, and a stray time is none.

A frame that comes late has a time before the last one's; so have all of them after the clock was set back. They are told apart by
whether they go on: what runs on behind the last time for as long as a contact lasts through a hole is a clock set back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]

#: A contact lasts through a hole in the readings of up to this, s, or so many steps of a slow stream: its fingers do not hurry.
HOLE_S, HOLE_STEPS = 1.0, 10


def longest_hole(rate_hz: float) -> float:
    """How long nothing may be read, s, before what was known is known no more.

    Examples
    --------
    >>> longest_hole(100.0), longest_hole(4.0)
    (1.0, 2.5)
    """
    return max(HOLE_S, HOLE_STEPS / rate_hz)


def rate_of(recording: Recording) -> float:
    """Frames a second: as the stream says, or else by the median of their distances.

    Raises
    ------
    InputError
        The time stands still.
    """
    if recording.stream.rate_hz:
        return recording.stream.rate_hz
    steps = np.diff(recording.device_time)
    if not (steps > 0).any():
        raise InputError("the time stands still in all frames; give a log with a column of times")
    return float(1 / np.median(steps[steps > 0]))


@dataclass(frozen=True)
class SetBack:
    """A clock that was set back.

    Parameters
    ----------
    frame : int
        The first one that counts after it, from 0.
    read, taken : float, s
        What the clock said there, and the time that it is taken for.
    """

    frame: int
    read: float
    taken: float

    def __str__(self) -> str:
        return (
            f"the clock is set back before frame {self.frame + 1:,}, which says {self.read:.2f} s: from there on "
            f"{self.taken - self.read:.2f} s are added to its times, and contacts before it end there"
        )


class Clock:
    """Times that only grow; a frame whose time says nothing gets none (NaN).

    Parameters
    ----------
    rate_hz : float

    Examples
    --------
    >>> clock = Clock(1.0)  # a contact lasts through ten steps
    >>> clock.of(np.array([47.0, 48.0, 48.0, 49.0, 45.0, 50.0])).tolist()  # a frame that came twice, and one that came late
    [47.0, 48.0, nan, 49.0, nan, 50.0]
    >>> clock.of(np.arange(12.0))[-3:].tolist(), str(clock.set_back[0])[:39]  # the device began anew
    ([nan, 61.0, 62.0], 'the clock is set back before frame 17, ')
    """

    def __init__(self, rate_hz: float) -> None:
        self._step, self._hole = 1 / rate_hz, longest_hole(rate_hz)
        self._last, self._shift, self._frames = -math.inf, 0.0, 0
        self._behind: tuple[float, float] | None = None  # the first and last time of those behind the last one that counts
        #: Where it was set back.
        self.set_back: list[SetBack] = []

    def of(self, time: FloatArray) -> FloatArray:
        """The times (n,) of the next frames, s."""
        if len(time) > 1:  # most recordings do nothing but grow
            moved: FloatArray = time + self._shift
            if self._behind is None and moved[0] > self._last and (np.diff(moved) > 0).all():
                self._last, self._frames = float(moved[-1]), self._frames + len(time)
                return moved
        return np.array([self._next(each) for each in time.tolist()])

    def _next(self, read: float) -> float:
        self._frames += 1
        now = read + self._shift
        if now > self._last:
            self._last, self._behind = now, None
            return now
        if math.isfinite(read):
            first, before = self._behind or (read, -math.inf)
            first = first if read > before else read
            self._behind = (first, read)
            if now < self._last and read - first >= self._hole:
                self._last += read - first + self._step
                self._shift, self._behind = self._last - read, None
                self.set_back.append(SetBack(self._frames - 1, read, self._last))
                return self._last
        return math.nan


def on_one_clock(recording: Recording) -> tuple[FloatArray, tuple[SetBack, ...]]:
    """The times of a recording that only grow, (n,), NaN where one says nothing; and where the clock was set back."""
    clock = Clock(rate_of(recording))
    return clock.of(recording.device_time), tuple(clock.set_back)
