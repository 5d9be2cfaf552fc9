"""A recording as a source: what was recorded comes again, at its own pace, faster, slower, or as fast as it is read."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from types import TracebackType
from typing import Self

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.readout.source import Counts, HostClock, StaleError


class Replay:
    """Frames of a recording, each when it is due.

    In time, a frame's host time is the moment at which it was due now, so that whatever asks for its age takes it for live;
    as fast as possible, frames are given as they were recorded, bit for bit.

    Parameters
    ----------
    recording : Recording
    speed : float, optional
        1: as it was recorded, by the device's time; 2: twice as fast. As fast as frames are read where it is left out.

    Raises
    ------
    InputError
        The speed is none, or the recording has no times to go by.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> made = Recording.of_values(Stream("one", (Channel("U"),), 100.0), np.arange(3.0)[:, None], device_time=np.arange(3) / 100)
    >>> with Replay(made) as source:
    ...     [(frame.host_time, float(frame.values[0])) for frame in source]
    [(0.0, 0.0), (0.01, 1.0), (0.02, 2.0)]
    """

    def __init__(self, recording: Recording, *, speed: float | None = None) -> None:
        if speed is not None and not (math.isfinite(speed) and speed > 0):
            raise InputError(f"a speed of {speed:g} is none; give 1 for the recorded one, 2 for twice as fast")
        if speed is not None and not np.isfinite(recording.device_time).all():
            raise InputError("some frames have no device time, so there is no pace at which to replay them; replay as fast as possible")
        self._recording, self._speed = recording, speed
        # Where the device's clock stepped back, frames come at once until it is where it was.
        since = np.maximum.accumulate(recording.device_time - recording.device_time[:1]) if speed else np.zeros(len(recording))
        self._due = since / (speed or 1.0)
        self._next = len(recording)  # closed: nothing is to come
        self._given = 0
        self._newest: Frame | None = None

    @property
    def stream(self) -> Stream:
        """As it was recorded."""
        return self._recording.stream

    @property
    def counts(self) -> Counts:
        """What was given so far, and what is missing in between by the frames' own count."""
        steps = np.diff(self._recording.sequence[: self._given])
        return Counts(frames=self._given, lost=int((steps[steps > 1] - 1).sum()))

    @property
    def duration_s(self) -> float:
        """How long it takes at its speed."""
        return float(self._due[-1]) if len(self._due) else 0.0

    def open(self) -> Self:
        """Begin from the start."""
        self._next = self._given = 0
        self._newest = None
        self._clock = HostClock()
        self._begun = time.monotonic()
        self._begun_host = self._clock.now()
        return self

    def close(self) -> None:
        """Give no more."""
        self._next = len(self._recording)

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame once it is due; None where `timeout` seconds are over before, or where there are no more."""
        if self._next >= len(self._recording):
            return None
        early = self._early()
        if timeout is not None and early > timeout:
            time.sleep(max(timeout, 0.0))
            return None
        if early > 0:
            time.sleep(early)
        return self._give()

    def read_latest(self, max_age: float) -> Frame:
        """The newest frame that is due; those before it are passed over. As fast as possible, simply the next one.

        Raises
        ------
        StaleError
            It was due more than `max_age` seconds ago, or there is none.
        """
        while self._next < len(self._recording) and self._early() <= 0:
            self._give()
            if self._speed is None:
                break
        if self._newest is None:
            raise StaleError(f"{self.stream.name} has given no frame yet; open it, and wait for one")
        age = self._clock.now() - self._begun_host - float(self._due[self._given - 1]) if self._speed else 0.0
        if age > max_age:
            raise StaleError(f"the newest frame of {self.stream.name} is {age:.3g} s old, and {max_age:g} s are allowed")
        return self._newest

    def _early(self) -> float:
        return self._begun + float(self._due[self._next]) - time.monotonic() if self._speed else 0.0

    def _give(self) -> Frame:
        frame = self._recording.frame(self._next)
        if self._speed:
            frame = replace(frame, host_time=self._begun_host + float(self._due[self._next]))
        self._next += 1
        self._given += 1
        self._newest = frame
        return frame

    def __iter__(self) -> Iterator[Frame]:
        while (frame := self.read()) is not None:
            yield frame

    def __enter__(self) -> Self:
        return self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
