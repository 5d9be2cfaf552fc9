"""A recording as a source: what was recorded comes again, at its own pace, faster, slower, or as fast as it is read."""

from __future__ import annotations

import math

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording
from skinfab.readout.paced import PacedFrames
from skinfab.readout.source import Counts


class Replay(PacedFrames):
    """Frames of a recording, each when it is due.

    In time, a frame's host time is the moment at which it was due now, so that whatever asks for its age takes it for live;
    as fast as possible, frames are given as they were recorded, bit for bit.

    Parameters
    ----------
    recording : Recording
    speed : float, optional
        1: as it was recorded, by the device's time; 2: twice as fast. As fast as frames are read where it is left out.

    Attributes
    ----------
    duration_s : float
        How long it takes at its speed.

    Raises
    ------
    InputError
        The speed is none, or the recording has no times to go by.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel, Stream
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
        # Where the device's clock stepped back, frames come at once until it is where it was.
        since = np.maximum.accumulate(recording.device_time - recording.device_time[:1]) if speed else np.zeros(len(recording))
        due = since / (speed or 1.0)
        super().__init__(
            recording.stream, lambda: recording, in_time=speed is not None, due=lambda k: float(due[k]) if k < len(due) else 0.0
        )
        self._recording = recording
        self.duration_s = float(due[-1]) if len(due) else 0.0

    @property
    def counts(self) -> Counts:
        """What was given so far, and what is missing in between by the frames' own count."""
        steps = np.diff(self._recording.sequence[: self._given])
        return Counts(frames=self._given, lost=int((steps[steps > 1] - 1).sum()))

    def _stamped(self, frame: Frame) -> Frame:
        return super()._stamped(frame) if self._in_time else frame
