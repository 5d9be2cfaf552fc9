"""Frames that are made as they are asked for, with a port's manners: what every simulator is a source by."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from types import TracebackType
from typing import Self

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.source import Counts, HostClock, StaleError


class PacedFrames:
    """Any frames as a source, each given at its time.

    Parameters
    ----------
    stream : Stream
        With a rate, unless `in_time` is false or `due` is given.
    make : callable
        Called by `open`; what it returns is asked for a frame whenever it is time for one. Their host times are replaced by
        the moments at which they were given.
    in_time : bool
        False: as fast as they are read.
    due : callable, optional
        When the k-th frame is due, s from the opening on; by the stream's rate where it is left out.

    Examples
    --------
    >>> import numpy as np
    >>> from skinfab.readout.frame import Channel, Recording
    >>> made = Recording.of_values(Stream("one", (Channel("U"),), 100.0), np.arange(3.0)[:, None], device_time=np.arange(3) / 100)
    >>> with PacedFrames(made.stream, lambda: made, in_time=False) as source:
    ...     [float(frame.values[0]) for frame in source]
    [0.0, 1.0, 2.0]
    """

    def __init__(
        self, stream: Stream, make: Callable[[], Iterable[Frame]], *, in_time: bool = True, due: Callable[[int], float] | None = None
    ) -> None:
        if in_time and due is None and not stream.rate_hz > 0:
            raise InputError(f"stream {stream.name} has no rate, so its frames have no time at which to come; give it one")
        self.stream = stream
        self._make, self._in_time = make, in_time
        self._due = due or (lambda k: k / stream.rate_hz)
        self._frames: Iterator[Frame] | None = None
        self._newest: Frame | None = None
        self._given = 0

    @property
    def counts(self) -> Counts:
        """How many frames were given; none is ever lost."""
        return Counts(frames=self._given)

    def open(self) -> Self:
        """Begin from the start."""
        self._frames = iter(self._make())
        self._clock = HostClock()
        self._begun = time.monotonic()
        self._newest, self._given = None, 0
        return self

    def close(self) -> None:
        """Give no more."""
        self._frames = None

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame, once it is time for it; None where `timeout` seconds are over before, or where there are no more."""
        if self._frames is None:
            return None
        early = self._next_at() - time.monotonic()
        if timeout is not None and early > timeout:
            time.sleep(max(timeout, 0.0))
            return None
        if early > 0:
            time.sleep(early)
        return self._give()

    def read_latest(self, max_age: float) -> Frame:
        """The newest frame whose time has come; those before it are passed over.

        Raises
        ------
        StaleError
            It is older than `max_age` seconds, or there is none.
        """
        while self._frames is not None and self._next_at() <= time.monotonic():
            if self._give() is None or not self._in_time:
                break
        if self._newest is None:
            raise StaleError(f"{self.stream.name} has given no frame yet; open it, and wait for one")
        age = self._clock.now() - self._came
        if age > max_age:
            raise StaleError(f"the newest frame of {self.stream.name} is {age:.3g} s old, and {max_age:g} s are allowed")
        return self._newest

    def _next_at(self) -> float:
        return self._begun + self._due(self._given) if self._in_time else 0.0

    def _give(self) -> Frame | None:
        assert self._frames is not None
        frame = next(self._frames, None)
        if frame is None:
            self._frames = None
            return None
        # Behind its time (the reader was busy), a frame still came when it was due: its age is what it is.
        self._came = self._clock.at(self._next_at()) if self._in_time else self._clock.now()
        self._given += 1
        self._newest = self._stamped(frame)
        return self._newest

    def _stamped(self, frame: Frame) -> Frame:
        return replace(frame, host_time=self._came)

    def __iter__(self) -> Iterator[Frame]:
        while (frame := self.read()) is not None:
            yield frame

    def __enter__(self) -> Self:
        return self if self._frames is not None else self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
