"""A frame is what all channels of a stream read at one moment; a recording is many frames of one stream."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Channel:
    """One column of a stream's frames.

    Parameters
    ----------
    name : str
        Unlike all others of the stream.
    unit : str
        ``V``, ``kohm``, ``pF``, ``N``, ``deg``; empty for a pure number.
    kind : str
        What measures: ``strain``, ``contact``, ``angle``, ``force``, ...; empty where nobody said.
    low, high : float
        The range it can read; a value at or beyond an end is saturated. Infinite where nobody said.
    sensor : str
        Id of the sensor in the skin document; empty where it is none of a skin's.
    board, board_input : int
        Multiplexer board from 1 and its input from 0, as in the wiring table; 0 and 0 where there is none.

    Raises
    ------
    InputError
        A name is missing, or the range is none.
    """

    name: str
    unit: str = ""
    kind: str = ""
    low: float = -math.inf
    high: float = math.inf
    sensor: str = ""
    board: int = 0
    board_input: int = 0

    def __post_init__(self) -> None:
        if not self.name:
            raise InputError("a channel has no name; give each one a name of its own")
        if not self.low < self.high:
            raise InputError(f"channel {self.name}: its range of {self.low:g} to {self.high:g} is none; low must be below high")


@dataclass(frozen=True)
class Stream:
    """What a source sends: its channels and how often.

    Parameters
    ----------
    name : str
    channels : tuple of Channel
    rate_hz : float
        Nominal; 0 where nobody said.
    simulated : bool
        Made by a simulator: said in every log and figure made of it.

    Examples
    --------
    >>> stream = Stream("finger", (Channel("S1", "V"), Channel("S2", "V")), 100.0)
    >>> stream.names, stream.index("S2")
    (('S1', 'S2'), 1)
    """

    name: str
    channels: tuple[Channel, ...]
    rate_hz: float = 0.0
    simulated: bool = False

    def __post_init__(self) -> None:
        names = self.names
        if twice := next((n for n in names if names.count(n) > 1), None):
            raise InputError(f"stream {self.name}: two channels are called {twice!r}; give each one a name of its own")
        if not (math.isfinite(self.rate_hz) and self.rate_hz >= 0):
            raise InputError(f"stream {self.name}: a rate of {self.rate_hz:g} Hz is none; give it in frames a second")

    @property
    def names(self) -> tuple[str, ...]:
        """The channels' names, in the order of the columns."""
        return tuple(channel.name for channel in self.channels)

    def index(self, name: str) -> int:
        """Column of a channel.

        Raises
        ------
        InputError
            There is none of this name; those that there are are named.
        """
        try:
            return self.names.index(name)
        except ValueError:
            raise InputError(f"stream {self.name} has no channel {name!r}; it has {', '.join(self.names) or 'none at all'}") from None

    def saturated(self, values: FloatArray) -> BoolArray:
        """Which of the values (..., c) lie at an end of their channel's range or beyond it."""
        low = np.array([channel.low for channel in self.channels])
        high = np.array([channel.high for channel in self.channels])
        with np.errstate(invalid="ignore"):
            out: BoolArray = (values <= low) | (values >= high)
        return out


@dataclass(frozen=True, eq=False)
class Frame:
    """All channels at one moment.

    Parameters
    ----------
    device_time : float, s
        By the device's clock, since it started.
    host_time : float, s
        When it reached this computer, since 1970; it never runs backwards in a stream, whatever is done to the clock.
    sequence : int
        The device's count, carried on where its counter wraps: a step of more than one is frames lost.
    values : (c,) float
        In the channels' units.
    valid : (c,) bool
        False where a channel has nothing to say: its value then means nothing.
    saturated : (c,) bool
        At an end of the channel's range.
    """

    device_time: float
    host_time: float
    sequence: int
    values: FloatArray
    valid: BoolArray
    saturated: BoolArray


@dataclass(frozen=True, eq=False)
class Recording:
    """Many frames of one stream, as arrays.

    Parameters
    ----------
    stream : Stream
    device_time, host_time : (n,) float, s
    sequence : (n,) int
    values : (n, c) float
    valid, saturated : (n, c) bool

    Examples
    --------
    >>> stream = Stream("one", (Channel("U", "V", high=3.3),), 100.0)
    >>> made = Recording.of_values(stream, np.array([[0.5], [np.nan], [3.3]]), device_time=np.arange(3) / 100)
    >>> len(made), made.valid[:, 0].tolist(), made.saturated[:, 0].tolist()
    (3, [True, False, True], [False, False, True])
    """

    stream: Stream
    device_time: FloatArray
    host_time: FloatArray
    sequence: IntArray
    values: FloatArray
    valid: BoolArray
    saturated: BoolArray

    def __post_init__(self) -> None:
        n, c = len(self.device_time), len(self.stream.channels)
        for name, shape in (("host_time", (n,)), ("sequence", (n,)), ("values", (n, c)), ("valid", (n, c)), ("saturated", (n, c))):
            if getattr(self, name).shape != shape:
                raise InputError(f"{name} has the shape {getattr(self, name).shape}; {n} frames of {c} channels need {shape}")

    def __len__(self) -> int:
        return len(self.device_time)

    def __iter__(self) -> Iterator[Frame]:
        for k in range(len(self)):
            yield self.frame(k)

    def frame(self, k: int) -> Frame:
        """The k-th one."""
        return Frame(
            float(self.device_time[k]),
            float(self.host_time[k]),
            int(self.sequence[k]),
            self.values[k],
            self.valid[k],
            self.saturated[k],
        )

    def column(self, name: str) -> FloatArray:
        """Values of a channel, (n,), NaN where they are not valid."""
        k = self.stream.index(name)
        return np.where(self.valid[:, k], self.values[:, k], np.nan)

    @classmethod
    def of_frames(cls, stream: Stream, frames: Iterable[Frame]) -> Recording:
        """Gather frames."""
        each = list(frames)
        c = len(stream.channels)

        return cls(
            stream,
            np.array([f.device_time for f in each], dtype=float),
            np.array([f.host_time for f in each], dtype=float),
            np.array([f.sequence for f in each], dtype=np.int64),
            np.array([f.values for f in each], dtype=float).reshape(-1, c),
            np.array([f.valid for f in each], dtype=bool).reshape(-1, c),
            np.array([f.saturated for f in each], dtype=bool).reshape(-1, c),
        )

    @classmethod
    def of_values(cls, stream: Stream, values: FloatArray, *, device_time: FloatArray, host_time: FloatArray | None = None) -> Recording:
        """Of values alone: what is not finite is not valid, what is at the end of its range is saturated, and nothing was lost."""
        return cls(
            stream,
            device_time,
            device_time if host_time is None else host_time,
            np.arange(len(values), dtype=np.int64),
            values,
            np.isfinite(values),
            stream.saturated(values),
        )
