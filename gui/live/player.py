"""A log as a source that can be paused, sped up and sought in; frames come through the same replay as on the command line."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import fields, replace
from time import sleep
from types import TracebackType
from typing import Any, Self

import numpy as np

from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.readout.replay import Replay
from skinfab.readout.source import Counts

#: While it stands still it is looked this often whether it goes on, s.
_WAIT_S = 0.05


class Player:
    """A recording that plays from any of its frames on.

    Unlike a replay it has not ended at its end: it stands there until it is sought back.

    Parameters
    ----------
    recording : Recording
    speed : float
        1: as it was recorded.

    Raises
    ------
    InputError
        The speed is none, or the recording has no times to go by.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> made = Recording.of_values(Stream("one", (Channel("U"),), 100.0), np.arange(5.0)[:, None], device_time=np.arange(5) / 100)
    >>> with Player(made, speed=100.0) as player:
    ...     player.seek(0.03)
    ...     first = player.read(1.0)
    >>> float(first.values[0]), player.jumped(), player.jumped()
    (3.0, 3, None)
    """

    def __init__(self, recording: Recording, *, speed: float = 1.0) -> None:
        self.recording = recording
        self._at, self._jump, self._replay = 0, -1, Replay(recording, speed=speed)
        # As the replay has it: where the clock was set back, seconds into the log stand still until it is where it was.
        self._since = np.maximum.accumulate(recording.device_time - recording.device_time[:1])
        self._speed, self._paused, self._open = speed, False, False
        self._lock = threading.Lock()

    @property
    def stream(self) -> Stream:
        """The recording's."""
        return self.recording.stream

    @property
    def counts(self) -> Counts:
        """Up to where it is: what comes before was given, or passed over."""
        steps = np.diff(self.recording.sequence[: self._at])
        return Counts(frames=self._at, lost=int((steps[steps > 1] - 1).sum()))

    @property
    def duration_s(self) -> float:
        """Of the whole log, at its own pace."""
        return float(self._since[-1]) if len(self._since) else 0.0

    @property
    def position_s(self) -> float:
        """How far into the log it is."""
        k = min(self._at, len(self._since) - 1)
        return float(self._since[k]) if k >= 0 else 0.0

    @property
    def at_end(self) -> bool:
        """All was given."""
        return self._at >= len(self.recording)

    @property
    def pace(self) -> float:
        """Times as fast as it was recorded."""
        return self._speed

    @property
    def paused(self) -> bool:
        """It stands still."""
        return self._paused

    def pause(self, paused: bool) -> None:
        """Stand still, or go on; at the end: from the start."""
        with self._lock:
            self._paused = paused
            if not paused and self.at_end:
                self._at, self._jump = 0, 0
            self._begin()

    def speed(self, speed: float) -> None:
        """Go on at another speed."""
        with self._lock:
            self._speed = speed
            self._begin()

    def seek(self, seconds: float) -> None:
        """Go on from the first frame that is so far into the log."""
        with self._lock:
            self._at = self._jump = int(np.searchsorted(self._since, seconds - 1e-9))
            self._begin()

    def jumped(self) -> int | None:
        """The frame that was sought since this was last asked; None where none was."""
        with self._lock:
            to, self._jump = self._jump, -1
        return to if to >= 0 else None

    def open(self) -> Self:
        """Begin from where it is."""
        with self._lock:
            self._open = True
            self._begin()
        return self

    def close(self) -> None:
        """Give no more."""
        with self._lock:
            self._open = False

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame once it is due; None after `timeout` seconds, at a pause or at the end.

        A seek meanwhile counts from the next call on: wait for a short time only.
        """
        with self._lock:
            replay, at = self._replay, self._at
        if self._paused or self.at_end or not self._open:
            sleep(_WAIT_S if timeout is None else min(timeout, _WAIT_S))
            return None
        frame = replay.read(timeout)
        with self._lock:
            if frame is None or replay is not self._replay:
                return None  # sought meanwhile: that frame was of before
            self._at = at + 1
        return frame

    def read_latest(self, max_age: float) -> Frame:
        """See `Source.read_latest`."""
        return self._replay.read_latest(max_age)

    def __iter__(self) -> Iterator[Frame]:
        while not self.at_end:
            if (frame := self.read(0.05)) is not None:
                yield frame

    def __enter__(self) -> Self:
        return self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def _begin(self) -> None:
        """Replay the rest from now on. The replay before is let go, not closed: the other thread may be in the midst of it."""
        if self._open:
            self._replay = Replay(part(self.recording, self._at, len(self.recording)), speed=self._speed).open()


def part(recording: Recording, start: int, stop: int) -> Recording:
    """Frames from `start` up to `stop`; views."""
    arrays: dict[str, Any] = {f.name: getattr(recording, f.name)[start:stop] for f in fields(recording) if f.name != "stream"}
    return replace(recording, **arrays)
