"""What every source of frames can do, be it a serial port, a log or a simulator, and what it counts meanwhile."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Stream


class StaleError(InputError):
    """The newest frame is older than was asked for, or there is none."""


@dataclass(frozen=True)
class Counts:
    """What became of a stream so far.

    Parameters
    ----------
    frames : int
        Delivered.
    lost : int
        Missing by the device's own count.
    bad : int
        Packets that were no frame: wrong checksum, wrong length, garbage.
    late : int
        Frames that came out of order or a second time, and were dropped.
    unchecked : int
        Delivered frames without a checksum: each could be wrong in silence.
    reopened : int
        How often the port was gone and came back.
    """

    frames: int = 0
    lost: int = 0
    bad: int = 0
    late: int = 0
    unchecked: int = 0
    reopened: int = 0


class Source(Protocol):
    """Frames of one stream: ``with source: for frame in source: ...``, or `read` one at a time.

    A source is opened by `open` or by ``with``, and may be opened again once it is closed.
    """

    @property
    def stream(self) -> Stream: ...

    @property
    def counts(self) -> Counts: ...

    def open(self) -> Self: ...

    def close(self) -> None: ...

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame in order; None after `timeout` seconds without one (None: wait), or where the stream has ended."""
        ...

    def read_latest(self, max_age: float) -> Frame:
        """The newest frame there is; those before it are passed over.

        Raises
        ------
        StaleError
            It is older than `max_age` seconds, or there is none.
        """
        ...

    def __iter__(self) -> Iterator[Frame]: ...

    def __enter__(self) -> Self: ...

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None: ...


class HostClock:
    """Seconds since 1970 that never step: the wall clock is asked once, the monotonic one from then on.

    Examples
    --------
    >>> clock = HostClock()
    >>> first = clock.now()
    >>> clock.now() >= first
    True
    """

    def __init__(self) -> None:
        self._zero = time.time() - time.monotonic()

    def now(self) -> float:
        """This moment."""
        return self.at(time.monotonic())

    def at(self, monotonic: float) -> float:
        """A moment of `time.monotonic`."""
        return self._zero + monotonic


class Unwrapped:
    """A counter of `bits` bits carried on beyond its end.

    Examples
    --------
    >>> count = Unwrapped(bits=8)
    >>> [count.of(k) for k in (254, 255, 0, 1, 255)]
    [254, 255, 256, 257, 255]
    """

    def __init__(self, *, bits: int) -> None:
        self._size = 1 << bits
        self._last: int | None = None

    def of(self, counter: int) -> int:
        """The whole count: of all that fit, the one nearest to the last."""
        if self._last is None:
            self._last = counter
        else:
            step = (counter - self._last) % self._size
            self._last += step - self._size if step > self._size // 2 else step
        return self._last
