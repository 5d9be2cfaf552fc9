"""A source being read, in a thread: what came is kept until the window fetches it, and is recorded whether or not it does."""

from __future__ import annotations

import math
import queue
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from calibration.contact.detector import Contact
from calibration.strain.document import SensorCalibration
from calibration.strain.reading import Reading
from gui.jobs.worker import sentence_of
from gui.live.choices import Choice, LogChoice, source_of
from gui.live.picture import warm
from gui.live.player import Player
from gui.live.stream_clock import StreamClock
from gui.live.watch import Watch, require_readable
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.record import Recorder, State, record
from skinfab.readout.source import Counts, Source

FloatArray = NDArray[np.float64]

#: How long a read waits, s: the thread ends, or goes elsewhere in a log, as soon.
WAIT_S = 0.05
#: Rows that wait to be fetched at most; a window that does not fetch for longer has lost the oldest, the recording has not.
WAITING = 200_000
#: Rows of a log that are shown at once where it is sought, s.
SHOWN_S = 120.0
#: Frames a second are counted over so long, s, and are said from so long on; what a source had kept ready comes in a burst in the
#: first of its time, s, which does not count.
_RATE_S, _SAID_FROM_S, _BURST_S = 2.0, 1.0, 0.5


@dataclass(frozen=True, eq=False)
class News:
    """What came since it was last asked.

    Parameters
    ----------
    time : (k,) float, s
        Since the first frame, only growing.
    rows : (k, c + 1) float
        The channels, NaN where not valid; behind them the angle, deg, NaN where there is none.
    anew : bool
        What was shown before is not what lies before these.
    newest : Frame or None
        The last there was.
    touched : mapping of str to float
        Signed change of each channel that is being touched.
    contacts : tuple of Contact
        Those that began or ended.
    reading : Reading or None
        The joint by the last frame.
    """

    time: FloatArray
    rows: FloatArray
    anew: bool
    newest: Frame | None
    touched: dict[str, float]
    contacts: tuple[Contact, ...]
    reading: Reading | None


@dataclass(frozen=True)
class Status:
    """How the source is.

    Parameters
    ----------
    state : "opening", "running" or "ended"
    sentence : str
        Why it ended; empty where that was wanted.
    stream : Stream or None
        Known once it runs.
    counts : Counts
    rate_hz : float
        Frames a second that came lately; NaN while they are still being counted.
    age_s : float
        Since the last frame came; infinite where none did.
    gone_s : float
        Since the port is gone; NaN where it is there.
    outages_s : tuple of float
        How long the port was gone, each time that it came back.
    """

    state: Literal["opening", "running", "ended"]
    sentence: str = ""
    stream: Stream | None = None
    counts: Counts = field(default_factory=Counts)
    rate_hz: float = math.nan
    age_s: float = math.inf
    gone_s: float = math.nan
    outages_s: tuple[float, ...] = ()


class Feed:
    """Reads a source until it is closed.

    Parameters
    ----------
    choice : Choice
    contact : callable
        Which of a stream's channels are watched for contacts.
    after : Feed, optional
        The one before, which is closed first: a port can be opened only once.
    log : callable, optional
        Is called, in the thread, with the traceback of a fault of the program's own.
    """

    def __init__(
        self,
        choice: Choice,
        *,
        contact: Callable[[Stream], Sequence[str]],
        after: Feed | None = None,
        log: Callable[[str], None] | None = None,
    ) -> None:
        self.choice = choice
        self._contact, self._log = contact, log
        self._lock = threading.Lock()
        self._closing, self._recorded = threading.Event(), threading.Event()
        self._source: Source | None = None
        #: What to know of the source, sentences.
        self.notes: tuple[str, ...] = ()
        self.watch: Watch | None = None
        self._state: Literal["opening", "running", "ended"] = "opening"
        self._sentence = ""
        self._clock = StreamClock(live=not isinstance(choice, LogChoice))
        self._pending: deque[tuple[float, FloatArray]] = deque(maxlen=WAITING)
        self._orders: queue.SimpleQueue[Callable[[Watch], None]] = queue.SimpleQueue()
        self._contacts: list[Contact] = []
        #: What keeps contacts from being seen, in words.
        self.contacts = ""
        self._touched, self._reading = dict[str, float](), cast("Reading | None", None)
        self._anew, self._newest, self._came = False, cast("Frame | None", None), -math.inf
        self._given: deque[tuple[float, int]] = deque()
        self._frames, self._first = 0, math.inf
        self._recorder: Recorder | None = None
        self._recorded_by: Recorder | None = None
        #: How the recording goes, and why it ended before it was to; None and empty where there is none.
        self.recording: State | None = None
        self.recording_fault = ""
        self._thread = threading.Thread(target=self._run, args=(after,), name=f"live {choice.name}", daemon=True)
        self._thread.start()

    # For the window's thread

    @property
    def player(self) -> Player | None:
        """The log, where it is one and was read."""
        return self._source if isinstance(self._source, Player) else None

    @property
    def alive(self) -> bool:
        """Its thread has not ended yet."""
        return self._thread.is_alive()

    def close(self) -> None:
        """End it soon; a recording is whole then. A port that has not said yet what it is takes a few seconds."""
        self._closing.set()
        self._recorded.set()

    def join(self, timeout: float | None = None) -> bool:
        """Wait for the end of its thread; whether it has come."""
        self._thread.join(timeout)
        return not self.alive

    def take(self) -> News:
        """What came since the last call."""
        with self._lock:
            pending, self._pending = self._pending, deque(maxlen=WAITING)
            contacts, self._contacts = tuple(self._contacts), []
            anew, self._anew = self._anew, False
            touched, reading, newest = self._touched, self._reading, self._newest
        columns = 0 if self.watch is None else len(self.watch.stream.channels) + 1
        rows = np.array([row for _, row in pending]) if pending else np.empty((0, columns))
        return News(np.array([at for at, _ in pending]), rows, anew, newest, touched, contacts, reading)

    def status(self) -> Status:
        """How it is now."""
        now, source = time.monotonic(), self._source
        rate = self._rate(now)
        if source is None or self.watch is None:
            return Status(self._state, self._sentence)
        outages = getattr(source, "outages", ())
        gone = next((time.time() - each.began for each in outages if each.ended is None), math.nan)
        back = tuple(each.ended - each.began for each in outages if each.ended is not None)
        return Status(self._state, self._sentence, self.watch.stream, source.counts, rate, now - self._came, gone, back)

    def _rate(self, now: float) -> float:
        """Frames a second that came lately."""
        if now - self._first < _BURST_S:
            return math.nan
        self._given.append((now, self._frames))
        while now - self._given[0][0] > _RATE_S and len(self._given) > 2:
            self._given.popleft()
        since, frames = self._given[0]
        return (self._frames - frames) / (now - since) if now - since >= _SAID_FROM_S else math.nan

    def calibrate(self, calibration: SensorCalibration | None, channel: str = "") -> None:
        """Give out angles.

        Raises
        ------
        InputError
            The stream has no such channel, or is too slow for its filter.
        """
        watch = self.watch
        if watch is None:
            return
        if calibration is not None:
            require_readable(calibration, watch.stream, channel)
        self._orders.put(lambda watch: watch.calibrate(calibration, channel))

    def watch_for_contacts(self, channels: Sequence[str]) -> None:
        """Watch other channels from now on."""
        self._orders.put(lambda watch: watch.watch(channels))

    def record(self, recorder: Recorder) -> None:
        """Add all frames from now on to a file, until `end_recording`."""
        self._recorded.clear()
        self.recording_fault = ""
        self._recorder = self._recorded_by = recorder

    @property
    def recorded(self) -> int:
        """Frames in the last recording so far."""
        return self._recorded_by.frames if self._recorded_by is not None else 0

    def end_recording(self) -> None:
        """Close the file, within a quarter of a second."""
        self._recorded.set()

    @property
    def records(self) -> bool:
        """A recording is going on."""
        return self._recorder is not None

    # What follows runs in the thread

    def _run(self, after: Feed | None) -> None:
        try:
            if after is not None:
                after.close()
                after.join()
            if not self._closing.is_set():
                self._read()
        except Exception as fault:  # a thread has nobody else to tell
            self._sentence, ours = sentence_of(fault)
            if ours and self._log is not None:
                self._log(traceback.format_exc())
        finally:
            if self._recorder is not None:
                self._recorder.close()
                self._recorder = None
            self._state = "ended"

    def _read(self) -> None:
        warm()
        source, self.notes = source_of(self.choice)
        with source:
            stream = source.stream
            watch = Watch(stream, contact=self._contact(stream))
            self.watch, self._source = watch, source
            self._state = "running"
            while not self._closing.is_set():
                self._obey()
                if (recorder := self._recorder) is not None:
                    self._record(recorder)
                    continue
                if isinstance(source, Player) and (to := source.jumped()) is not None:
                    self._jump(source, to)
                asked = time.monotonic()
                self.contacts = watch.blind
                frame = source.read(WAIT_S)
                if frame is not None:
                    self._take(frame)
                elif not isinstance(source, Player) and time.monotonic() - asked < WAIT_S / 2:
                    return  # not for want of time: it has ended

    def _record(self, recorder: Recorder) -> None:
        try:
            with recorder:
                record(cast(Source, _Tap(self)), recorder, told=self._told, stop=self._recorded)
        except Exception as fault:  # the disk is full, or the port has changed: reading goes on, and says so itself where it cannot
            self.recording_fault = sentence_of(fault)[0]
        finally:
            self._recorder = None

    def _told(self, state: State) -> None:
        self.recording = state

    def read_on(self, timeout: float | None) -> Frame | None:
        """The next frame, seen by all before it is recorded."""
        assert self._source is not None
        self._obey()
        frame = self._source.read(timeout)
        if frame is not None:
            self._take(frame)
        return frame

    def _obey(self) -> None:
        """Do what the window has asked for: only this thread touches the watch."""
        while not self._orders.empty():
            assert self.watch is not None
            self._orders.get()(self.watch)
            with self._lock:
                self._touched, self._reading = self.watch.touched, self.watch.reading

    def _take(self, frame: Frame) -> None:
        watch = self.watch
        assert watch is not None
        contacts, touched, reading = watch.step(frame), watch.touched, watch.reading
        row = _row(frame, math.nan if reading is None else reading.angle)
        at = self._clock.at(frame.device_time, frame.host_time)
        with self._lock:
            self._contacts += contacts
            self._touched, self._reading = touched, reading
            self._pending.append((at, row))
            self._newest, self._came = frame, time.monotonic()
            self._first = min(self._first, self._came)
            self._frames += 1

    def _jump(self, player: Player, to: int) -> None:
        """Elsewhere in a log: know what would be known there, and show what comes before it."""
        watch, recording = self.watch, player.recording
        assert watch is not None
        angles = watch.catch_up(recording, to)
        time_s = recording.device_time
        first = int(np.searchsorted(time_s[:to], time_s[to - 1] - SHOWN_S)) if to else 0
        self._clock = StreamClock(live=False)
        rows = []
        for k in range(first, to):
            frame, j = recording.frame(k), k - to + len(angles)
            rows.append((self._clock.at(frame.device_time, frame.host_time), _row(frame, float(angles[j]) if j >= 0 else math.nan)))
        with self._lock:
            self._pending.clear()
            self._pending.extend(rows)
            self._anew, self._contacts = True, []
            self._touched, self._reading = watch.touched, watch.reading
            self._newest = recording.frame(to - 1) if to else None
            self._came = time.monotonic()


def _row(frame: Frame, angle: float) -> FloatArray:
    row = np.empty(len(frame.values) + 1)
    row[:-1] = np.where(frame.valid, frame.values, np.nan)
    row[-1] = angle
    return row


class _Tap:
    """What `record` is given to read from."""

    def __init__(self, feed: Feed) -> None:
        self._feed = feed

    def read(self, timeout: float | None = None) -> Frame | None:
        """The next frame."""
        return self._feed.read_on(timeout)
