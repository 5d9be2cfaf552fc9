"""Decisions as readings come, one every few readings; a log and a port go through the same code.

The motor's frequency is followed in the readings of the last 0.18 s. Lost frames leave a gap in their place, so that what comes after them
keeps its phase; readings that are missing or saturated are left out of the fit.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.frozen import without_frozen
from skinfab.fingertip.nail.histogram_model import HistogramModel
from skinfab.fingertip.nail.labels import six_channels
from skinfab.fingertip.nail.pace import Pace, pace_of
from skinfab.fingertip.nail.phasors import FIND_SHORTEST, SHORTEST, find_drive, turns
from skinfab.fingertip.nail.places import places_of, times_of
from skinfab.fingertip.nail.reader import Decision, Reader
from skinfab.fingertip.nail.regress import Continuous, Regression
from skinfab.fingertip.nail.units import CHANNELS, channel_columns
from skinfab.readout.frame import Frame, Recording, Stream

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: The motor's frequency is found in so many readings, and again after so many.
_FOLLOWED, _AGAIN = 256, 64
#: Where nothing stands out of the newest readings any more, it may be that the phase jumped in them, as where trials were put together
#: to one log: it is off only if so many readings later it still is.
_LOOK_TWICE = 16
_LOOKED_AT = (FIND_SHORTEST, FIND_SHORTEST // 2, _LOOK_TWICE)
#: Most readings of a window.
_LONGEST = 16384
#: A log's rate may differ so much from the model's: a phasor's channels answer by frequency, not by rate, but a window's length is told
#: in readings.
_RATE = 0.05


@dataclass(frozen=True)
class Told:
    """A decision and when it was made.

    Parameters
    ----------
    time_s : float
        Device time of the window's last reading.
    decision : Decision or None
        None where the window could not be decided, or the motor did not turn.
    drive_hz : float
    left_out : float
        Part of the window's readings that are missing or saturated.
    turning : bool, optional
        Did the motor turn? None before there were readings enough to tell.
    reason : str, optional
        Why the window could not be decided.
    """

    time_s: float
    decision: Decision | None
    drive_hz: float
    left_out: float
    turning: bool | None = None
    reason: str = ""


class _Published:
    """The published machine, read as `Reader` is."""

    def __init__(self, model: HistogramModel) -> None:
        self._model = model

    def decide(self, window: FloatArray, *, drive_hz: float | None = None) -> Decision:
        """Decide on a window of the length it was trained for; it knows no frequency and no probability."""
        if (still := ~np.isfinite(window).all(axis=0)).any():
            names = ", ".join(np.array(CHANNELS)[still])
            raise InputError(f"channel {names} stands still, and the published method needs all six; mend it, or train --method improved")
        name = self._model.names[int(self._model.decide(window[None])[0])]
        return Decision(name, math.nan, name != "none", False, Continuous())


class NailWatch:
    """Decides on what a stream sends.

    Parameters
    ----------
    model : NailModel or HistogramModel
    stream : Stream
    samples : int
        Readings of a window; of the published model always those it was trained for.
    every : int
        A decision after so many readings.
    regression : Regression, optional
    rate_hz : float, optional
        Readings a second, where the stream does not say.

    Raises
    ------
    InputError
        As `channel_columns`; the stream's rate is not the model's, or the window is too short or too long.

    Attributes
    ----------
    lost : int
        Frames that were missing by the device's count.
    turning : bool, optional
        Does the motor turn? None before there are readings enough to tell.
    """

    def __init__(
        self,
        model: NailModel | HistogramModel,
        stream: Stream,
        *,
        samples: int,
        every: int,
        regression: Regression | None = None,
        rate_hz: float | None = None,
    ) -> None:
        rate = rate_hz or stream.rate_hz
        if not rate:
            raise InputError(f"stream {stream.name} does not say how many frames come a second; let the device say so")
        if abs(rate - model.rate_hz) > _RATE * model.rate_hz:
            raise InputError(
                f"stream {stream.name} has {rate:.4g} readings a second and the model learned from {model.rate_hz:.4g}; train one anew"
            )
        self._published = isinstance(model, HistogramModel)
        self.samples = model.samples if isinstance(model, HistogramModel) else samples
        if not SHORTEST <= self.samples <= _LONGEST:
            raise InputError(f"a window of {self.samples} readings is none; give {SHORTEST} to {_LONGEST}")
        self.every, self.lost = max(every, 1), 0
        self._rate = rate
        chosen = channel_columns(stream)
        if self._published and (gone := [name for name, (k, _) in zip(CHANNELS, chosen, strict=True) if k < 0]):
            raise InputError(
                f"stream {stream.name} has no {', '.join(gone)}, and the published method needs all six channels; train --method improved"
            )
        self._columns, self._scales = [k for k, _ in chosen], [scale for _, scale in chosen]
        self._reader: _Published | Reader
        if isinstance(model, HistogramModel):
            self._reader = _Published(model)
        else:  # by the stream's own rate, by which its motor is found: another one turns a long window's ends against each other
            self._reader = Reader(model, self.samples, regression=regression, rate_hz=rate)
        self.drive_hz = math.nan if isinstance(model, HistogramModel) else model.drive_hz
        # Twice as long as needed, written twice: so the newest readings always lie in one piece.
        self._size = max(self.samples, _FOLLOWED)
        self._rows = np.full((2 * self._size, 6), np.nan)
        self._count, self._since, self._again, self._doubted = 0, 0, _AGAIN, False
        # A histogram does not mind what lies between its readings, but needs all channels of each.
        self._whole: deque[FloatArray] = deque(maxlen=self.samples)
        self._sequence: int | None = None
        self.turning: bool | None = None

    def step(self, frame: Frame) -> Told | None:
        """Take a frame; a decision where it is time for one."""
        usable = frame.valid if self._published else frame.valid & ~frame.saturated
        values = np.where(usable, frame.values, np.nan)
        return self.take(
            np.array([scale * values[k] if k >= 0 else math.nan for k, scale in zip(self._columns, self._scales, strict=True)]),
            frame.sequence,
            frame.device_time,
        )

    def take(self, row: FloatArray, sequence: int, time_s: float) -> Told | None:
        """Take a reading of the six channels, NaN where there is none, with its place in the device's count."""
        if self._sequence is not None:
            gap = sequence - self._sequence - 1
            if gap < 0:  # the device began anew, so that phases before it mean nothing
                self._count, self._since, self._again, self._doubted = 0, 0, _AGAIN, False
                self._whole.clear()
                self.turning = None
                gap = 0
            self.lost += gap
            for _ in range(min(gap, self._size)):
                self._put(math.nan)
        self._sequence = sequence
        self._put(row)
        gathered = len(self._whole) if self._published else self._count
        if gathered < self.samples or self._since < self.every:
            return None
        self._since = 0
        return self._decided(time_s)

    def _put(self, row: FloatArray | float) -> None:
        at = self._count % self._size
        self._rows[at] = self._rows[at + self._size] = row
        self._count += 1
        if not self._published:
            self._since += 1
        elif isinstance(row, np.ndarray) and math.isfinite(row.sum()):
            self._whole.append(row)
            self._since += 1
        if self._count >= self._again:
            self._follow()

    def _newest(self, count: int) -> FloatArray:
        end = (self._count - 1) % self._size + 1 + self._size
        return self._rows[end - count : end]

    def _follow(self) -> None:
        self._again = self._count + _AGAIN
        newest = self._newest(min(self._count, _FOLLOWED))
        if min(np.isfinite(each).any(axis=1).mean() for each in (newest, newest[-FIND_SHORTEST:])) < 0.5:
            return  # mostly a gap: what was known before is better
        found = float(find_drive(newest[None], self._rate)[0])
        # The newest readings alone say that it was switched off just now.
        turning = math.isfinite(found) and any(bool(turns(newest[None, -n:], self._rate, found)[0]) for n in _LOOKED_AT)
        if self.turning and not turning and not self._doubted:
            self._doubted, self._again = True, self._count + _LOOK_TWICE
            return
        self._doubted, self.turning = False, turning
        if self.turning and self._count >= _FOLLOWED and not self._published:
            self.drive_hz = found

    def _decided(self, time_s: float) -> Told:
        window = self._newest(self.samples)
        used = [k for k, column in enumerate(self._columns) if column >= 0]
        left_out = float(np.isnan(window[:, used]).mean())
        if self.turning is False:
            return Told(time_s, None, math.nan, left_out, False)
        if self._published:
            window = np.array(self._whole)
        try:
            decision = self._reader.decide(without_frozen(window), drive_hz=self.drive_hz)
        except InputError as fault:  # too little in this window; the next one may do
            return Told(time_s, None, self.drive_hz, left_out, self.turning, str(fault))
        return Told(time_s, decision, self.drive_hz, left_out, self.turning)


def decide_log(
    model: NailModel | HistogramModel,
    recording: Recording,
    *,
    samples: int,
    every: int,
    regression: Regression | None = None,
    pace: Pace | None = None,
) -> tuple[list[Told], int]:
    """Decisions on a log, and how many frames were missing in it.

    Parameters
    ----------
    model, recording, samples, every, regression
        As of `NailWatch`.
    pace : Pace, optional
        From `pace_of`; found where it is left out.

    Raises
    ------
    InputError
        As `NailWatch` and `pace_of`.
    """
    pace = pace or pace_of(recording)
    watch = NailWatch(model, recording.stream, samples=samples, every=every, regression=regression, rate_hz=pace.rate_hz)
    values, saturated = six_channels(recording)
    if not isinstance(model, HistogramModel):
        values = np.where(saturated, np.nan, values)
    places = places_of(recording, pace)
    rows = zip(values, places.tolist(), times_of(recording, places, pace).tolist(), strict=True)
    told = [made for row, sequence, at in rows if (made := watch.take(row, sequence, at)) is not None]
    known = next((k for k, each in enumerate(told) if each.turning is not None), 0)
    if told and told[known].turning is False:  # nor did it turn before that could be told
        told[:known] = [replace(each, decision=None, drive_hz=math.nan, turning=False) for each in told[:known]]
    return told, watch.lost
