"""Lines of numbers, as a small board prints them: read, and flagged, for nothing tells a wrong digit from a right one.

Numbers are parted by commas; by semicolons or tabs a decimal comma is understood too. A line of headings, sent every second,
names the channels; of these ``sequence`` and ``time_us``, ``time_ms`` or ``time_s`` are the device's count and clock. Without
headings the channels are called ch1, ch2, ..., lines are counted as they come, and the host's clock is the only one: lines
that came in one go are taken to be evenly spread over the time since those before.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.framing import Splitter

#: The longest line: as many numbers as a stream may have channels, 15 characters each.
LONGEST_LINE = 16_384
#: So many lines alike, one behind the other, tell how many channels there are where no headings came for so long.
ALIKE, HEADINGS_S = 3, 1.5

#: Digits, not all that Python takes for a number: 1_0 is two numbers whose comma was hurt.
_NUMBER = re.compile(rb"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?")
#: What parts the cells of a line: the first of these that is in it.
_MARKS = (b";", b"\t", b",")
#: So much of a line that was not understood is shown.
_SHOWN = 60
_NOTHING = (b"", b"nan", b"NaN", b"NAN")
_TIMES = {"time_us": 1e6, "time_ms": 1e3, "time_s": 1.0}
_SEQUENCE = "sequence"


@dataclass(frozen=True)
class _Line:
    """Numbers, when they were read (s since 1970), when they came as far as that is known, and what parted them."""

    numbers: list[float]
    host_time: float
    came: float
    mark: bytes


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
        self._mark = b""
        self._waiting: list[_Line] = []
        self._before: float | None = None
        self._since: float | None = None
        self._lines = 0
        self._guessed = False
        self._start: float | None = None
        self._wrong = 0
        #: What was not understood of the last line that was no frame, a sentence; empty where there was none.
        self.fault = ""
        self._commas = _Commas()
        #: What is sent; None until that is known.
        self.stream: Stream | None = None

    @property
    def doubt(self) -> str:
        """Why what is read may mean something else, a sentence; empty where nothing speaks for that."""
        if not (self._guessed and self._commas.decimal):
            return ""
        channels = len(self._names)
        numbers = "one number with a decimal comma" if channels == 2 else f"{channels // 2} numbers with decimal commas"
        return (
            f"{self._commas.example!r} is read as {channels} channels, and may be {numbers}; let the board print "
            f"points, or send a line of headings: with {channels} names it is {channels} channels"
        )

    @property
    def bad(self) -> int:
        """Lines that were no frame."""
        return self._wrong + self._splitter.overlong

    def reset(self) -> None:
        """The port was gone: the line that had begun will not be ended."""
        self._splitter.reset()
        self._first, self._before = True, None

    def feed(self, data: bytes, *, host_time: float) -> list[Frame]:
        """The frames that these bytes complete."""
        out = []
        lines = self._splitter.feed(data)
        for k, line in enumerate(lines):
            # What comes first is the end of a line that had begun: cut off in the middle of a number, it would not show.
            # Headings that begin with one of our own words are whole.
            if self._first and not data.startswith(b"\n") and re.split(rb"[;\t,]", line)[0].decode("latin-1") not in (_SEQUENCE, *_TIMES):
                self._first = False
                continue
            self._first = False
            if self._before is not None:
                came = self._before + (host_time - self._before) * (k + 1) / len(lines)
            else:  # of what waited in the port, only the last line's time is known
                came = host_time if k == len(lines) - 1 else math.nan
            out += self._line(line.strip(b"\r \t"), host_time, came)
        if b"\n" in data:
            self._first, self._before = False, host_time
        return out

    def _line(self, line: bytes, host_time: float, came: float) -> list[Frame]:
        if not line or line.startswith(b"#"):
            return []
        mark = self._mark or next((mark for mark in _MARKS if mark in line), b",")
        cells = [cell.strip() for cell in line.split(mark)]
        numbers = _numbers(cells)
        if numbers is None:
            own = next((mark for mark in _MARKS if mark in line), mark)
            if self.stream is not None and own != mark and (apart := _numbers([cell.strip() for cell in line.split(own)])):
                self._too_many(line, len(apart), own)
            elif not self._headings(cells, mark):
                self._not_understood(line, "is no line of numbers parted by commas, semicolons or tabs, and none of headings")
            return []
        if mark == b"," and (self.stream is None or self._guessed):
            self._commas.see(cells)
        if self.stream is None:
            return self._guess(_Line(numbers, host_time, came, mark))
        if len(numbers) != len(self._names):
            self._too_many(line, len(numbers), mark)
            return []
        return self._frames([_Line(numbers, host_time, came, mark)])

    def _too_many(self, line: bytes, numbers: int, mark: bytes) -> None:
        """Numbers and names are not as many, or not parted alike."""
        named = len(self._names)
        hint = "; are these decimal commas? Print points, or part the numbers by semicolons" if mark == b"," else ""
        if any(" " in name for name in self._names) or mark != self._mark:
            hint = f" ({', '.join(repr(name) for name in self._names)}); part the names as the numbers"
        self._not_understood(line, f"has {numbers} numbers where {named} {'is' if named == 1 else 'are'} named{hint}")

    def _not_understood(self, line: bytes, why: str) -> None:
        self._wrong += 1
        shown = line[:_SHOWN].decode("latin-1")
        if shown.replace("\t", " ").isprintable():  # else it is noise, or was never meant for people
            self.fault = f"the line {shown!r} {why}"

    def _headings(self, cells: list[bytes], mark: bytes) -> bool:
        """Is this the line of headings? Taken over where there was none before."""
        try:
            names = tuple(cell.decode("ascii") for cell in cells)
        except UnicodeDecodeError:
            return False
        if self.stream is not None:
            return names == self._names
        if not all(re.fullmatch(r"[A-Za-z][\w .()/%-]*", name) for name in names) or sum(name in _TIMES for name in names) > 1:
            return False
        return self._take(names, mark)

    def _take(self, names: tuple[str, ...], mark: bytes) -> bool:
        channels = [name for name in names if name != _SEQUENCE and name not in _TIMES]
        try:
            stream = Stream("serial lines", tuple(Channel(name) for name in channels))
        except InputError:
            return False
        if not channels or names.count(_SEQUENCE) > 1:
            return False
        self._names, self.stream, self._mark = names, stream, mark
        return True

    def _guess(self, line: _Line) -> list[Frame]:
        if self._waiting and (len(self._waiting[-1].numbers), self._waiting[-1].mark) != (len(line.numbers), line.mark):
            self._waiting.clear()
            self._since = None
        self._since = line.host_time if self._since is None else self._since
        self._waiting = [*self._waiting, line][-ALIKE:]
        if len(self._waiting) < ALIKE or line.host_time - self._since < HEADINGS_S:
            return []
        self._guessed = True
        self._take(tuple(f"ch{k + 1}" for k in range(len(line.numbers))), line.mark)
        lines, self._waiting = self._waiting, []
        return self._frames(lines)

    def _frames(self, lines: list[_Line]) -> list[Frame]:
        stream = self.stream
        assert stream is not None
        clocked = any(name in _TIMES for name in self._names)
        out = []
        for line in lines:
            if not clocked and math.isnan(line.came):
                continue
            if self._start is None:
                self._start = line.came
            sequence, device_time = self._lines, line.came - self._start
            values = []
            for name, number in zip(self._names, line.numbers, strict=True):
                if name == _SEQUENCE:
                    sequence = int(number) if 0 <= number < 2**53 else -1
                elif name in _TIMES:
                    device_time = number / _TIMES[name]
                else:
                    values.append(number)
            if sequence < 0 or not math.isfinite(device_time):
                self._wrong += 1
                self.fault = "a line has no number where its headings name the device's count or clock"
                continue
            self._lines += 1
            array = np.array(values)
            out.append(Frame(device_time, line.host_time, sequence, array, np.isfinite(array), stream.saturated(array)))
        return out


class _Commas:
    """Are a line's cells perhaps halves of numbers? 1,050 and 1,125: a whole number, and digits that are always as many."""

    def __init__(self) -> None:
        self._digits: list[int] | None = None
        self._never = self._zero = False
        self.example = ""

    @property
    def decimal(self) -> bool:
        """No whole number is printed with a zero before it."""
        return self._zero and not self._never

    def see(self, cells: list[bytes]) -> None:
        """The cells of a line."""
        whole, parts = cells[::2], cells[1::2]
        digits = [len(part) for part in parts]
        halves = len(whole) == len(parts) and all(a.lstrip(b"+-").isdigit() and b.isdigit() for a, b in zip(whole, parts, strict=True))
        if not halves or self._digits not in (None, digits):
            self._never = True
            return
        self._digits = digits
        if not self._zero and any(len(part) > 1 and part.startswith(b"0") for part in parts):
            self._zero, self.example = True, b",".join(cells).decode("ascii")


def _numbers(cells: list[bytes]) -> list[float] | None:
    """The cells' numbers, NaN where one is empty; None where one is no number, or all are empty."""
    out = []
    for cell in cells:
        if cell in _NOTHING:
            out.append(math.nan)
        elif _NUMBER.fullmatch(cell):
            out.append(float(cell.replace(b",", b".")))
        else:
            return None
    return out if any(cell not in _NOTHING for cell in cells) else None
