"""A pseudo-terminal that sends frames as a device would: simulators are read through the very path that real ports are read."""

from __future__ import annotations

import fcntl
import os
import select
import struct
import tempfile
import termios
import threading
import time
import tty
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Self

from skinfab.readout.faults import Faults, Wire
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.packets import FRAME_32, Layout

#: How often the stream is described: every second, or where there is no rate, every so many frames.
DESCRIBE_S, DESCRIBE_FRAMES = 1.0, 100
#: Whoever opens a port first throws away what is in it: until that is done nothing is sent, s.
SETTLE_S = 0.05
#: What was sent last may take so long to be read before the port goes, s.
_DRAIN_S = 2.0
_POLL_S = 0.002
_EMPTY_POLLS = 25
#: Where nothing may be lost, it is looked this often whether the reader is still there, s; one that is gone may take so long to
#: come back.
_LOOK_S, _GONE_S = 0.5, 1.0


class PtyServer:
    """Serves frames in a thread of its own, and stops by itself when there are no more, or when it is closed.

    As a board with USB of its own does, it begins when the port is first opened. From then on it sends whether or not
    somebody reads: what does not fit into the port's buffer is lost, and counted in `unsent`.

    Parameters
    ----------
    stream : Stream
    frames : iterable of Frame
        May be endless. Asked for when it is time to send the next one.
    rate_hz : float, optional
        Frames a second; those of the stream where it is left out. 0: as fast as they are read, and none is lost; a reader
        that leaves then ends it.
    kind : int
        Of the packets: `skinfab.readout.packets.FRAME_32` or `FRAME_64`.
    ascii_lines : bool
        Lines of numbers, with headings, instead of packets.
    faults : Faults

    Attributes
    ----------
    path : Path
        A link to the pseudo-terminal; it stays the same when the port goes and comes back.
    sent, unsent : int
        Frames.
    left : bool
        The reader closed the port before it had all, and did not come back.
    """

    def __init__(
        self,
        stream: Stream,
        frames: Iterable[Frame],
        *,
        rate_hz: float | None = None,
        kind: int = FRAME_32,
        ascii_lines: bool = False,
        faults: Faults | None = None,
    ) -> None:
        self._layout, self._frames, self._kind = Layout(stream), frames, kind
        self._rate = stream.rate_hz if rate_hz is None else rate_hz
        self._ascii = ascii_lines
        self._faults = faults or Faults()
        self._wire = Wire(self._faults)
        self._folder = tempfile.TemporaryDirectory(prefix="skinfab-port-")
        self.path = Path(self._folder.name) / "port"
        self.sent = self.unsent = 0
        self.left = False
        self._look_at = 0.0
        self._stop = threading.Event()
        self._fault: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="pseudo-terminal", daemon=True)

    def start(self) -> Self:
        """Make the port and begin to send."""
        self._plug_in()
        # While the other end is closed, the terminal is hung up: that is how it shows that nobody has opened it.
        os.close(self._other_end)
        self._thread.start()
        return self

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until there is nothing more to send; was that so in time?"""
        self._thread.join(timeout)
        return not self._thread.is_alive()

    def stop(self) -> None:
        """Send no more, and let the port go. What made the frames fail is raised here."""
        self._stop.set()
        self._thread.join()
        self._folder.cleanup()
        if self._fault is not None:
            raise self._fault

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.stop()

    def _plug_in(self) -> None:
        self._master, self._other_end = os.openpty()
        tty.setraw(self._other_end)
        os.set_blocking(self._master, False)
        self.path.symlink_to(os.ttyname(self._other_end))

    def _pull_out(self) -> None:
        self.path.unlink(missing_ok=True)
        os.close(self._master)
        os.close(self._other_end)

    def _run(self) -> None:
        try:
            self._wait_for_reader()
            for packet, is_frame in self._due():
                went = self._send(self._wire.carry(packet) if is_frame else self._wire.hurt(packet))
                if is_frame:
                    self.sent, self.unsent = self.sent + went, self.unsent + (not went)
            if not self.left:
                self._drain()
        except BaseException as fault:  # told by stop, in the thread that can be told
            self._fault = fault
        finally:
            self._pull_out()

    def _wait_for_reader(self) -> None:
        self._open_by(None)
        # From here on it is kept open by us too, so that a reader may go and come back.
        self._other_end = os.open(os.readlink(self.path), os.O_RDWR | os.O_NOCTTY)
        self._stop.wait(SETTLE_S)

    def _open_by(self, until: float | None) -> bool:
        """Wait for somebody to have the port open; False where nobody came in time (of `time.monotonic`), or it is to stop."""
        poll = select.poll()
        poll.register(self._master, 0)
        while poll.poll(0):
            if self._stop.wait(_POLL_S) or (until is not None and time.monotonic() >= until):
                return False
        return True

    def _look(self) -> None:
        """Is the reader still there? Only while our own hold is let go does the terminal show it."""
        if time.monotonic() < self._look_at:
            return
        os.close(self._other_end)
        there = self._open_by(time.monotonic() + _GONE_S)
        self._other_end = os.open(os.readlink(self.path), os.O_RDWR | os.O_NOCTTY)
        self.left = not there and not self._stop.is_set()
        self._look_at = time.monotonic() + _LOOK_S

    def _due(self) -> Iterator[tuple[bytes, bool]]:
        """Packets when it is time for them, and whether each one is a frame."""
        described = -1.0
        for k, frame in enumerate(self._timed()):
            if not self._rate:
                self._look()
                if self.left:
                    return
            if k in self._faults.unplugged:
                self._unplug(self._faults.unplugged[k])
                described = -1.0
            now = time.monotonic()
            if described < 0 or now - described >= DESCRIBE_S or (not self._rate and k % DESCRIBE_FRAMES == 0):
                described = now
                yield self._description(), False
            yield self._packet(frame), True

    def _unplug(self, for_s: float) -> None:
        """Where nothing may be lost, what is on its way is read first, and the reader, who throws away what it finds, is waited for."""
        if not self._rate:
            self._drain()
        self._pull_out()
        self._stop.wait(for_s)
        self._plug_in()
        if not self._rate:
            os.close(self._other_end)
            self._wait_for_reader()

    def _timed(self) -> Iterator[Frame]:
        """The frames, each at its time; none is asked for before that."""
        each = iter(self._frames)
        start = time.monotonic()
        k = 0
        while not self._stop.is_set():
            # Reckoned from the start, so that what the machine is late once is made up for.
            if self._rate and (early := start + k / self._rate - time.monotonic()) > 0 and self._stop.wait(early):
                return
            frame = next(each, None)
            if frame is None:
                return
            yield frame
            k += 1

    def _description(self) -> bytes:
        if not self._ascii:
            return self._layout.description
        return ("sequence,time_us," + ",".join(self._layout.stream.names) + "\n").encode()

    def _packet(self, frame: Frame) -> bytes:
        if not self._ascii:
            return self._layout.frame_packet(frame, kind=self._kind)
        values = (f"{value:.9g}" if valid else "" for value, valid in zip(frame.values.tolist(), frame.valid.tolist(), strict=True))
        return f"{frame.sequence},{frame.device_time * 1e6:.0f},{','.join(values)}\n".encode()

    def _send(self, data: bytes) -> bool:
        """Send it; False where there was no room for all of it."""
        view = memoryview(data)
        while view:
            try:
                view = view[os.write(self._master, view) :]
            except BlockingIOError:
                if self._rate or self._stop.is_set():
                    return False
                self._look()
                if self.left:
                    return False
                select.select([], [self._master], [], _POLL_S)
        return True

    def _drain(self) -> None:
        """Bytes that nobody has read yet go with the port: leave some time for that."""
        until, empty = time.monotonic() + _DRAIN_S, 0
        # Between our end and theirs the kernel passes bytes on in its own time: once empty is not yet all read.
        while time.monotonic() < until and empty < _EMPTY_POLLS and not self._stop.wait(_POLL_S):
            waiting = struct.unpack("i", fcntl.ioctl(self._other_end, termios.FIONREAD, b"\0" * 4))[0]
            empty = 0 if waiting else empty + 1
