"""Recordings of one stream, one after the other without an end: what simulators of whole trials are live sources by."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.readout.paced import PacedFrames


def endless(stream: Stream, make: Callable[[], Iterable[Recording]]) -> PacedFrames:
    """A source that gives recordings in their order, at the stream's rate; their times and counts go on from one to the next.

    Parameters
    ----------
    stream : Stream
        With a rate.
    make : callable
        Called when the source is opened: the recordings, as many as wanted. Each one's channels must be the stream's.

    Raises
    ------
    InputError
        The stream has no rate; while reading: a recording has other channels.

    Examples
    --------
    >>> import itertools, numpy as np
    >>> from skinfab.readout.frame import Channel
    >>> made = Recording.of_values(Stream("one", (Channel("U"),), 1000.0), np.array([[1.0], [2.0]]), device_time=np.arange(2) / 1000)
    >>> with endless(made.stream, lambda: itertools.repeat(made)) as source:
    ...     [(frame.device_time, frame.sequence, float(frame.values[0])) for frame, _ in zip(source, range(3))]
    [(0.0, 0, 1.0), (0.001, 1, 2.0), (0.002, 2, 1.0)]
    """
    return PacedFrames(stream, lambda: _joined(stream, make()))


def _joined(stream: Stream, recordings: Iterable[Recording]) -> Iterator[Frame]:
    given = 0
    for recording in recordings:
        if recording.stream.names != stream.names:
            raise InputError(f"stream {stream.name} goes on with other channels, {', '.join(recording.stream.names)}; give it its own")
        for frame in recording:
            yield replace(frame, device_time=given / stream.rate_hz, sequence=given)
            given += 1
