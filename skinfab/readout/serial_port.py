"""A serial port as a source of frames: read by a thread of its own, so that no frame waits for what is done with the last."""

from __future__ import annotations

import termios
import threading
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from skinfab.errors import InputError
from skinfab.readout.decode import AnyDecoder, Decoder
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.sequence import InOrder
from skinfab.readout.source import Counts, HostClock, StaleError

#: Enough for 32 channels at 400 Hz or 6 at 1.9 kHz; a board with USB of its own does not care.
BAUD = 921_600
#: How long a port may take to say what its channels are; a device says so every second.
DESCRIBED_S = 5.0
#: A port that is gone is looked for this often.
LOOK_AGAIN_S = 0.1
#: Frames that may wait to be read: more than a minute at 100 Hz. Then the oldest are dropped and counted as lost.
WAITING = 8192

_POLL_S = 0.5


@dataclass(frozen=True)
class Outage:
    """A time without the port.

    Parameters
    ----------
    began, ended : float, s since 1970
        By the clock of the frames' `host_time`; `ended` is None while it is not back.
    """

    began: float
    ended: float | None = None


class SerialPort:
    """Frames from a device on a serial port, or from a pseudo-terminal.

    Packets and lines of numbers are told apart by themselves. A port that is unplugged is opened again as soon as it is
    back; meanwhile `read` waits. `Counts.frames` are those that came in order, `Counts.lost` those that are missing by
    the device's count or were not fetched in time (`WAITING`), `Counts.reopened` how often the port was gone or the device
    began its count anew.

    Parameters
    ----------
    port : str or Path
        ``/dev/ttyACM0``; better ``/dev/serial/by-id/...``, which stays the same when it is plugged in again.
    baud : int
    described_s : float, s
        How long `open` waits for the stream's description.

    Examples
    --------
    >>> import numpy as np
    >>> from skinfab.readout.frame import Channel, Recording
    >>> from skinfab.readout.pty_server import PtyServer
    >>> made = Recording.of_values(Stream("one", (Channel("U"),), 200.0), np.arange(3.0)[:, None], device_time=np.arange(3) / 200)
    >>> with PtyServer(made.stream, made) as device, SerialPort(device.path) as port:
    ...     [float(port.read(1.0).values[0]) for _ in range(3)]
    [0.0, 1.0, 2.0]
    """

    def __init__(self, port: str | Path, *, baud: int = BAUD, described_s: float = DESCRIBED_S) -> None:
        self.port, self.baud = str(port), baud
        self._described_s = described_s
        self._thread: threading.Thread | None = None
        self._news = threading.Condition()
        self._hold = threading.Lock()  # while it is told to stop reading, the device must not be closed
        self._start_over()

    def _start_over(self) -> None:
        self._clock = HostClock()
        self._decoder: Decoder = AnyDecoder()
        self._order = InOrder()
        self._waiting: deque[Frame] = deque()
        self._newest: Frame | None = None
        self._fault: BaseException | None = None
        self._closing = threading.Event()
        self._bytes = self._frames = self._overrun = self._unchecked = 0
        self._outages: list[Outage] = []

    @property
    def stream(self) -> Stream:
        """What the port sends; known once it is open."""
        stream = self._decoder.stream
        if stream is None:
            raise InputError(f"{self.port} is not open; what it sends is known afterwards")
        return stream

    @property
    def counts(self) -> Counts:
        """What became of the frames since the port was opened."""
        with self._news:
            return Counts(
                frames=self._frames - self._overrun,
                lost=self._order.lost + self._overrun,
                bad=self._decoder.bad,
                late=self._order.late,
                unchecked=self._unchecked,
                reopened=sum(each.ended is not None for each in self._outages) + self._order.restarts,
            )

    @property
    def outages(self) -> tuple[Outage, ...]:
        """When the port was gone, in order; the last may last still."""
        with self._news:
            return tuple(self._outages)

    @property
    def fault(self) -> str:
        """Why the last line that was no frame was none, a sentence; empty where there was none, or packets come."""
        return self._decoder.fault

    @property
    def doubt(self) -> str:
        """Why what is read may mean something else, a sentence; else empty."""
        return self._decoder.doubt

    def open(self) -> Self:
        """Open the port and wait until it has said what its channels are.

        Raises
        ------
        InputError
            There is no such port, it may not be opened, or what it sends cannot be understood.
        """
        if self._thread is not None:
            raise InputError(f"{self.port} is open already")
        self._start_over()
        try:
            device = _opened(self.port, self.baud)
        except (OSError, termios.error, ValueError) as fault:
            raise InputError(_why_not(self.port, fault)) from fault
        self._device = device
        self._thread = threading.Thread(target=self._run, name=f"reader of {self.port}", daemon=True)
        self._thread.start()
        with self._news:
            known = self._news.wait_for(lambda: self._decoder.stream is not None or self._fault is not None, self._described_s)
        if not known or self._fault is not None:
            fault_, received, seen = self._fault, self._bytes, self.fault
            self.close()
            if fault_ is not None:
                raise fault_
            raise InputError(_nothing_understood(self.port, received, self._described_s, self.baud, seen))
        return self

    def close(self) -> None:
        """Let the port go; frames that were not read are gone."""
        if self._thread is None:
            return
        self._closing.set()
        with self._hold:
            if self._device.is_open:
                self._device.cancel_read()
        self._thread.join()
        self._thread = None
        self._device.close()
        with self._news:
            self._waiting.clear()
            self._news.notify_all()

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame in order; None after `timeout` seconds without one, or where the port was closed.

        Raises
        ------
        InputError
            The port has begun to send another stream.
        """
        with self._news:
            self._news.wait_for(lambda: bool(self._waiting) or self._fault is not None or self._thread is None, timeout)
            if self._waiting:
                return self._waiting.popleft()
            if self._fault is not None:
                raise self._fault
            return None

    def read_latest(self, max_age: float) -> Frame:
        """The newest frame there is, the same one again where no newer one came; those before it are passed over.

        Raises
        ------
        StaleError
            It is older than `max_age` seconds, or there is none.
        InputError
            The port has begun to send another stream.
        """
        with self._news:
            if self._fault is not None:
                raise self._fault
            self._waiting.clear()
            newest = self._newest
        if newest is None:
            raise StaleError(f"{self.port} has sent no frame yet; look at the device")
        age = self._clock.now() - newest.host_time
        if age > max_age:
            raise StaleError(f"the newest frame of {self.port} is {age:.3g} s old, and {max_age:g} s are allowed; look at the device")
        return newest

    def __iter__(self) -> Iterator[Frame]:
        while (frame := self.read()) is not None:
            yield frame

    def __enter__(self) -> Self:
        return self if self._thread is not None else self.open()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    # What follows runs in the reader's thread.

    def _run(self) -> None:
        try:
            while not self._closing.is_set():
                try:
                    data = self._device.read(1)
                    data += self._device.read(self._device.in_waiting)
                except (OSError, termios.error, TypeError):
                    # pyserial's way to say that the port is gone, a TypeError where it went between two calls.
                    if not self._find_again():
                        return
                    continue
                if data:
                    self._take(bytes(data))
        except BaseException as fault:  # a thread has nobody else to tell
            with self._news:
                self._fault = fault
                self._news.notify_all()

    def _find_again(self) -> bool:
        """Wait for the port that is gone; False where it is to be closed."""
        with self._hold:
            self._device.close()
        with self._news:
            self._outages.append(Outage(self._clock.now()))
            self._decoder.reset()
            self._order.reopened()
        while not self._closing.wait(LOOK_AGAIN_S):
            try:
                self._device = _opened(self.port, self.baud)
            except (OSError, termios.error):
                continue
            with self._news:
                self._outages[-1] = replace(self._outages[-1], ended=self._clock.now())
            return True
        return False

    def _take(self, data: bytes) -> None:
        now = self._clock.now()
        with self._news:
            self._bytes += len(data)
            for frame in self._decoder.feed(data, host_time=now):
                place = self._order.place(frame.sequence)
                if place is None:
                    continue
                self._frames += 1
                self._unchecked += not self._decoder.checked
                self._newest = frame if place == frame.sequence else replace(frame, sequence=place)
                self._waiting.append(self._newest)
                if len(self._waiting) > WAITING:
                    self._waiting.popleft()
                    self._overrun += 1
            if (other := self._decoder.changed) is not None and self._fault is None:
                self._fault = InputError(
                    f"{self.port} now sends another stream than when it was opened, {other.name} with {len(other.channels)} channels; "
                    "open it again"
                )
            self._news.notify_all()


def _opened(port: str, baud: int) -> Any:
    import serial

    # Locked: two programs that read one port take each other's bytes.
    return serial.Serial(port, baud, timeout=_POLL_S, exclusive=True)


def _why_not(port: str, fault: BaseException) -> str:
    import errno

    number = getattr(fault, "errno", None)
    if number == errno.ENOENT:
        from serial.tools import list_ports

        there = ", ".join(sorted(each.device for each in list_ports.comports())) or "none at all"
        return f"there is no port {port}; there are: {there}"
    if number == errno.EACCES:
        return f"{port} may not be opened by this user; join its group (on Debian: sudo adduser $USER dialout) and log in again"
    if number in (errno.EAGAIN, errno.EBUSY):
        return f"{port} is being read by another program; close that one first"
    return f"{port} is no serial port that can be opened ({fault}); give one such as /dev/ttyACM0"


def _nothing_understood(port: str, received: int, waited_s: float, baud: int, seen: str) -> str:
    if not received:
        return f"{port} has sent nothing for {waited_s:g} s; look at the device, its supply and its cable"
    return (
        f"{port} has sent {received} bytes in {waited_s:g} s and no description of a stream{f' ({seen})' if seen else ''}; is it {baud} "
        "baud, and does the firmware send what docs/readout.md asks for?"
    )
