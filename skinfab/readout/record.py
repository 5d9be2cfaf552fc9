"""Recording while it happens: every frame is handed to the system at once, and whatever ends it, what was recorded stays."""

from __future__ import annotations

import os
import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from skinfab.errors import InputError
from skinfab.files import explain_os_error, require_place
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.logs.csv_log import csv_head, csv_line
from skinfab.readout.recording_file import SUFFIX, append, write_header
from skinfab.readout.source import Source

#: What a recording may be: packets with checksums, or lines that any spreadsheet reads.
SUFFIXES = (SUFFIX, ".csv")

#: How often it is told how the recording goes, and the system is asked to put on the disk what it holds, s.
TELL_S = 1.0
_POLL_S = 0.25


@dataclass(frozen=True)
class State:
    """How a recording goes.

    Parameters
    ----------
    seconds : float
        Since it began.
    frames, bytes : int
        In the file.
    rate_hz : float
        Of the frames since this was last told.
    free_bytes : int
        On the file's disk.
    """

    seconds: float
    frames: int
    bytes: int
    rate_hz: float
    free_bytes: int

    @property
    def room_s(self) -> float:
        """How long the disk lasts at the pace so far."""
        return self.free_bytes * self.seconds / self.bytes if self.bytes else float("inf")


class Recorder:
    """A file that frames are added to.

    After each frame the file is whole: a process that is killed loses nothing that it was given, and a machine that loses
    its power what came since the last second. Where the disk is full, a frame half written is taken back. A recording without
    a frame is removed.

    Parameters
    ----------
    path : str or Path
        ``.frames`` or ``.csv``; must not be there yet.
    stream : Stream

    Raises
    ------
    InputError
        The file is there already, or cannot be made.

    Examples
    --------
    >>> import tempfile
    >>> from skinfab.readout.recording_file import read_recording
    >>> from skinfab.readout.strain_simulator import simulated_strain
    >>> path = Path(tempfile.mkdtemp()) / "a.frames"
    >>> with simulated_strain(channels=2, in_time=False) as source, Recorder(path, source.stream) as recorder:
    ...     for _ in range(10):
    ...         recorder.add(source.read())
    >>> len(read_recording(path))
    10
    """

    def __init__(self, path: str | Path, stream: Stream) -> None:
        self.path = require_new(path)
        try:
            # Unlike a rename onto the name, this fails where somebody made the file meanwhile.
            self._file = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o666)
        except FileExistsError:
            require_new(path)
            raise
        except OSError as fault:
            raise InputError(explain_os_error(fault, self.path)) from fault
        self.frames = self.bytes = 0
        self._csv = self.path.suffix.lower() == ".csv"
        try:
            if self._csv:
                self.write(csv_head(stream).encode())
            else:
                self._layout = write_header(self, stream)
        except BaseException:
            self.close()
            raise

    def add(self, frame: Frame) -> None:
        """Add a frame.

        Raises
        ------
        InputError
            The disk is full, or gone; the frames before are in the file.
        """
        if self._csv:
            self.write(csv_line(frame).encode())
        else:
            append(self, self._layout, frame)
        self.frames += 1

    def write(self, data: bytes) -> None:
        """Add bytes, all of them or none."""
        at = 0
        try:
            while at < len(data):
                at += os.write(self._file, data[at:])
        except OSError as fault:
            os.ftruncate(self._file, self.bytes)
            kept = f"; the {self.frames:,} frames recorded before are in it" if self.frames else ""
            raise InputError(explain_os_error(fault, self.path) + kept) from fault
        self.bytes += len(data)

    def sync(self) -> None:
        """Have the system put all of it on the disk."""
        os.fsync(self._file)

    def close(self) -> None:
        """End the recording."""
        if self._file < 0:
            return
        os.close(self._file)
        self._file = -1
        if not self.frames:
            self.path.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def require_new(path: str | Path) -> Path:
    """Refuse a file that is there already, or is not called as a recording is.

    Raises
    ------
    InputError
    """
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{path}: call a recording .frames (exact, with checksums) or .csv (for other programs)")
    require_place(path)
    if os.path.lexists(path):
        raise InputError(f"{path} is there already, and recordings are never overwritten; give another name")
    return path


def record(
    source: Source,
    recorder: Recorder,
    *,
    seconds: float | None = None,
    told: Callable[[State], None] | None = None,
    stop: threading.Event | None = None,
) -> None:
    """Record an open source until it ends, or for so many seconds.

    Parameters
    ----------
    source : Source
    recorder : Recorder
    seconds : float, optional
        By the clock, whether or not frames come.
    told : callable, optional
        Called every second, and at the end.
    stop : threading.Event, optional
        Ends the recording between two frames, within a quarter of a second.

    Raises
    ------
    InputError
        The disk is full, or the source has failed; what was recorded stays.
    """
    began = last = time.monotonic()
    before = 0

    def tell(now: float) -> None:
        nonlocal last, before
        recorder.sync()
        if told is not None:
            rate = (recorder.frames - before) / (now - last) if now > last else 0.0
            told(State(now - began, recorder.frames, recorder.bytes, rate, shutil.disk_usage(recorder.path.parent).free))
        last, before = now, recorder.frames

    while stop is None or not stop.is_set():
        now = time.monotonic()
        left = float("inf") if seconds is None else began + seconds - now
        if left <= 0:
            break
        asked = min(left, _POLL_S)
        frame = source.read(asked)
        if frame is not None:
            recorder.add(frame)
        elif time.monotonic() - now < asked / 2:
            break  # not for want of time: the source has ended
        if now - last >= TELL_S:
            tell(now)
    tell(time.monotonic())
