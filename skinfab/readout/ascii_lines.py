"""Lines of numbers parted by commas, as a small board prints them: read, and flagged, for nothing tells a wrong digit from a right one.

A line of headings, sent every second, names the channels; of these ``sequence`` and ``time_us``, ``time_ms`` or ``time_s``
are the device's count and clock. Without headings the channels are called ch1, ch2, ..., lines are counted as they come,
and the host's clock is the only one.
"""

from __future__ import annotations

import math
import re

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.framing import Splitter

#: The longest line: as many numbers as a stream may have channels, 15 characters each.
LONGEST_LINE = 16_384
#: So many lines alike, one behind the other, tell how many channels there are where no headings came for so long.
ALIKE, HEADINGS_S = 3, 1.5

#: Digits, not all that Python takes for a number: 1_0 is two numbers whose comma was hurt.
_NUMBER = re.compile(rb"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_NOTHING = (b"", b"nan", b"NaN", b"NAN")
_TIMES = {"time_us": 1e6, "time_ms": 1e3, "time_s": 1.0}
_SEQUENCE = "sequence"


class LineDecoder:
    """Lines become frames.

    Examples
    --------
    >>> decoder = LineDecoder()
    >>> frames = decoder.feed(b"\\nsequence,time_ms,S1,S2\\n7,20,1.5,nan\\n8,30,1.", host_time=9.0)
    >>> decoder.stream.names, frames[0].sequence, frames[0].device_time, frames[0].values, frames[0].valid
    (('S1', 'S2'), 7, 0.02, array([1.5, nan]), array([ True, False]))
    """

    #: No checksum: a wrong digit passes for a right one.
    checked = False
    #: Lines cannot say that they belong to another stream.
    changed: Stream | None = None

    def __init__(self) -> None:
        self._splitter = Splitter(end=b"\n", longest=LONGEST_LINE)
        self._first = True
        self._names: tuple[str, ...] = ()
        self._waiting: list[list[float]] = []
        self._since: float | None = None
        self._lines = 0
        self._start: float | None = None
        self._wrong = 0
        #: What is sent; None until that is known.
        self.stream: Stream | None = None

    @property
    def bad(self) -> int:
        """Lines that were no frame."""
        return self._wrong + self._splitter.overlong

    def reset(self) -> None:
        """The port was gone: the line that had begun will not be ended."""
        self._splitter.reset()
        self._first = True

    def feed(self, data: bytes, *, host_time: float) -> list[Frame]:
        """The frames that these bytes complete."""
        out = []
        for line in self._splitter.feed(data):
            # What comes first is the end of a line that had begun: cut off in the middle of a number, it would not show.
            # Headings that begin with one of our own words are whole.
            if self._first and not data.startswith(b"\n") and line.split(b",")[0].decode("latin-1") not in (_SEQUENCE, *_TIMES):
                self._first = False
                continue
            self._first = False
            out += self._line(line.strip(b"\r \t"), host_time)
        if b"\n" in data:
            self._first = False
        return out

    def _line(self, line: bytes, host_time: float) -> list[Frame]:
        if not line or line.startswith(b"#"):
            return []
        cells = [cell.strip() for cell in line.split(b",")]
        numbers = _numbers(cells)
        if numbers is None:
            if not self._headings(cells):
                self._wrong += 1
            return []
        if self.stream is None:
            return self._guess(numbers, host_time)
        if len(numbers) != len(self._names):
            self._wrong += 1
            return []
        return self._frames([numbers], host_time)

    def _headings(self, cells: list[bytes]) -> bool:
        """Is this the line of headings? Taken over where there was none before."""
        try:
            names = tuple(cell.decode("ascii") for cell in cells)
        except UnicodeDecodeError:
            return False
        if self.stream is not None:
            return names == self._names
        if not all(re.fullmatch(r"[A-Za-z][\w .()/%-]*", name) for name in names) or sum(name in _TIMES for name in names) > 1:
            return False
        return self._take(names)

    def _take(self, names: tuple[str, ...]) -> bool:
        channels = [name for name in names if name != _SEQUENCE and name not in _TIMES]
        try:
            stream = Stream("serial lines", tuple(Channel(name) for name in channels))
        except InputError:
            return False
        if not channels or names.count(_SEQUENCE) > 1:
            return False
        self._names, self.stream = names, stream
        return True

    def _guess(self, numbers: list[float], host_time: float) -> list[Frame]:
        if self._waiting and len(self._waiting[-1]) != len(numbers):
            self._waiting.clear()
            self._since = None
        self._since = host_time if self._since is None else self._since
        self._waiting = [*self._waiting, numbers][-ALIKE:]
        if len(self._waiting) < ALIKE or host_time - self._since < HEADINGS_S:
            return []
        self._take(tuple(f"ch{k + 1}" for k in range(len(numbers))))
        lines, self._waiting = self._waiting, []
        return self._frames(lines, host_time)

    def _frames(self, lines: list[list[float]], host_time: float) -> list[Frame]:
        stream = self.stream
        assert stream is not None
        out = []
        for numbers in lines:
            if self._start is None:
                self._start = host_time
            sequence, device_time = self._lines, host_time - self._start
            values = []
            for name, number in zip(self._names, numbers, strict=True):
                if name == _SEQUENCE:
                    sequence = int(number) if 0 <= number < 2**53 else -1
                elif name in _TIMES:
                    device_time = number / _TIMES[name]
                else:
                    values.append(number)
            if sequence < 0 or not math.isfinite(device_time):
                self._wrong += 1
                continue
            self._lines += 1
            array = np.array(values)
            out.append(Frame(device_time, host_time, sequence, array, np.isfinite(array), stream.saturated(array)))
        return out


def _numbers(cells: list[bytes]) -> list[float] | None:
    """The cells' numbers, NaN where one is empty; None where one is no number, or all are empty."""
    out = []
    for cell in cells:
        if cell in _NOTHING:
            out.append(math.nan)
        elif _NUMBER.fullmatch(cell):
            out.append(float(cell))
        else:
            return None
    return out if any(cell not in _NOTHING for cell in cells) else None
