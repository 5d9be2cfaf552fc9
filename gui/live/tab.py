"""The tab: a source is chosen, read in a thread of its own, and shown; what came is fetched thirty times a second."""

from __future__ import annotations

import math
import time
import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tkinter import ttk

from calibration.strain.document import SensorCalibration
from calibration.strain.reading import Reading
from gui.live.angle_row import AngleRow
from gui.live.channels import label, sensors_of, unread, watched
from gui.live.choices import Choice, LogChoice, PortChoice
from gui.live.connect import ConnectRow
from gui.live.feed import Feed, Status
from gui.live.lights import Lights, lights_of
from gui.live.log_row import LogRow
from gui.live.plots import Now, Plots
from gui.live.record_row import RANGES, RecordRow
from gui.live.ring import Ring
from gui.live.words import silent, words_of
from gui.state.derived import Derived
from gui.state.problem import Problem
from gui.state.selection import Target
from gui.state.session import Session
from gui.theme import Theme
from gui.view2d.view import View2D
from gui.view3d.view import View3D
from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.record import SUFFIXES, Recorder

#: Between two pictures, ms; whatever one takes, the window has as long for itself.
_EVERY_MS, _AT_LEAST_MS = 33, 12
#: How often it is said how the source is, s.
_SAY_S = 0.25
#: Numbers kept for the plots at most: 48 MB.
_KEPT = 6_000_000
#: Frames a second, where nobody has said, for how many are kept.
_UNKNOWN_HZ = 200.0
_NOTHING = "Choose a port, a log or a simulator, and connect"
LOGS = [("logs", "*.csv *.mcap *.bag *.db3 *.frames"), ("all files", "*")]
CALIBRATIONS = [("calibrations", "*.json"), ("all files", "*")]

Kinds = list[tuple[str, str]]


@dataclass(frozen=True, eq=False)
class _Shown:
    """A moment of the source."""

    now: Now
    reading: Reading | None


class LiveTab(ttk.Frame):
    """Live readings.

    Parameters
    ----------
    master : widget
    session : Session
    derived : Derived
    theme : Theme
    view3d, view2d : View3D, View2D
        Where contact lights are.
    ask_open : callable
        Asks for a file, given a title and kinds of files; None where none was given.
    ask_save : callable
        Asks where to write, given a title, a suffix and a name.
    log : callable, optional
        Is called, from another thread, with the traceback of a fault of the program's own.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        derived: Derived,
        theme: Theme,
        *,
        view3d: View3D,
        view2d: View2D,
        ask_open: Callable[[str, Kinds], Path | None],
        ask_save: Callable[[str, str, str], Path | None],
        log: Callable[[str], None] | None = None,
    ) -> None:
        super().__init__(master, name="live")
        self._session, self._ask_save, self._log = session, ask_save, log
        self.feed: Feed | None = None
        self.ring = Ring(1, capacity=1)
        self._stream: Stream | None = None
        self._sensors: tuple[str, ...] = ()
        self._newest: Frame | None = None
        #: What is shown, and what stands still in its place while it is paused.
        self._last: _Shown | None = None
        self._held: _Shown | None = None
        self._record_name, self._said_at, self._timer = "", 0.0, ""
        self._status: Status = Status("ended")
        self.connect = ConnectRow(self, ask_log=lambda: ask_open("Open a log", LOGS), connect=self.choose, complain=self._complain)
        self.connect.pack(fill="x")
        self.status = ttk.Label(self, name="status", padding=(6, 0), justify="left")
        self.status.pack(fill="x")
        self.bind("<Configure>", lambda event: self.status.configure(wraplength=max(event.width - 14, 80)))
        self.angle = AngleRow(
            self, theme, ask=lambda: ask_open("Open a calibration", CALIBRATIONS), changed=self._calibrate, complain=self._complain_of_angle
        )
        self.angle.pack(side="bottom", fill="x")
        self.row = RecordRow(self, pause=self._pause, record=self.record)
        self.row.pack(side="bottom", fill="x")
        self.log_row = LogRow(self)
        self.plots = Plots(self, theme, chosen=self._chosen)
        self.plots.pack(fill="both", expand=True, padx=4, pady=2)
        self.plots.canvas.bind("<space>", lambda event: self._toggle())
        self.plots.canvas.bind("<Configure>", lambda event: self._blank(), add=True)
        self.lights = Lights(session, derived, theme, view3d, view2d)
        self.row.enable(record=False, pause=False)
        session.listen("skin", self._on_skin)
        self.bind("<Destroy>", self._destroyed, add=True)
        self.restyle(theme)

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        style = ttk.Style(self)
        style.configure("Simulated.TLabel", background=theme.warning, foreground=theme.view)
        for part in (self.plots, self.angle, self.lights):
            part.restyle(theme)
        self._blank()

    def choose(self, choice: Choice | None) -> None:
        """Connect to a source, after letting go the one there is; None for none."""
        before, self.feed = self.feed, None
        if before is not None:
            before.close()
        self._stream, self._newest, self._last, self._held = None, None, None, None
        self.row.paused.set(False)
        self.row.ended("")
        if before is not None:
            self._finish_record(before)  # its words stay
        self.row.enable(record=False, pause=False)
        self.lights.show({})
        self.lights.say("")
        self.log_row.lead(None)
        self.log_row.pack_forget()
        self.angle.offer(())
        self.angle.show(None, silent=True)
        self._complain("")
        self._session.report("live notes", [])
        self.connect.connected(choice is not None)
        if choice is None:
            self._stop()
            self.status.configure(text="", style="TLabel")
            self._blank()
            return
        self.connect.tell(choice)
        self.feed = Feed(choice, contact=self._contact_channels, after=before, log=self._log)
        self.plots.clear("")
        self._said_at = 0.0
        if not self._timer:
            self._timer = self.after(1, self._tick)

    def record(self) -> None:
        """Record what comes to a new file, or end that."""
        feed = self.feed
        if feed is None or self._stream is None:
            return
        if feed.records:
            feed.end_recording()
            return
        path = self._ask_save("Record to a new file", SUFFIXES[0], f"{time.strftime('%Y-%m-%d-%H%M%S')}{SUFFIXES[0]}")
        if path is None or self.feed is not feed or self._stream is None:
            return
        try:
            feed.record(Recorder(path, self._stream))
        except InputError as fault:
            self._complain(str(fault))
            return
        self._complain("")
        self._record_name = path.name

    def close(self) -> None:
        """Let the source go: for the end of the window."""
        self._stop()
        if self.feed is not None:
            self.feed.close()
            self.feed.join(0.5)
            self.feed = None

    # What comes

    def _tick(self) -> None:
        self._timer = ""
        began = time.perf_counter()
        if self.feed is None:
            return
        self._look(self.feed)
        spent = 1000 * (time.perf_counter() - began)
        self._timer = self.after(max(round(_EVERY_MS - spent), _AT_LEAST_MS), self._tick)

    def _look(self, feed: Feed) -> None:
        """Fetch what came, and show it."""
        status = self._status = feed.status()
        if status.stream is not None and self._stream is None:
            self._begin(feed, status.stream)
        if self._stream is not None:
            self._show(feed, status)
        now = time.monotonic()
        if now - self._said_at > _SAY_S:
            self._said_at = now
            self._say(feed, status)
        if status.state == "ended":
            self._end(feed, status)

    def _begin(self, feed: Feed, stream: Stream) -> None:
        """The source has said what it sends."""
        self._stream = stream
        columns = len(stream.channels) + 1
        capacity = int(float(RANGES[-1]) * (1.1 * stream.rate_hz or _UNKNOWN_HZ)) + 10
        self.ring = Ring(columns, capacity=min(capacity, _KEPT // columns))
        self.log_row.lead(feed.player)
        if feed.player is not None:
            self.log_row.pack(side="bottom", fill="x", before=self.row)
        self.row.enable(record=feed.player is None, pause=feed.player is None)
        self.angle.offer(stream.names)
        self._name_channels(feed)

    def _show(self, feed: Feed, status: Status) -> None:
        stream = self._stream
        assert stream is not None
        news = feed.take()
        if news.anew:
            self.ring.clear()
        if len(news.time):
            self.ring.add(news.time, news.rows)
        self._newest = news.newest
        quiet = silent(status, paused=self._standing(feed) != "")
        touched = {} if quiet else _read(news.touched, news.newest, stream)
        # Lights stand still with the rows; those of a source that is gone are off, as is said of them.
        lit = touched if self._held is None or quiet else self._held.now.touched
        self.lights.show(lights_of(lit, stream.names, self._sensors))
        last = float(self.ring.time[-1]) if len(self.ring) else 0.0
        angle = math.nan if news.reading is None else news.reading.angle
        self._last = _Shown(Now(last, self.row.range_s, news.newest, touched, angle, quiet), news.reading)
        if not self.plots.winfo_viewable():
            return
        shown = self._last if self._held is None else self._held
        self.plots.draw(self.ring, replace(shown.now, range_s=self.row.range_s))
        if feed.player is not None:
            self.log_row.follow()
        self.angle.show(shown.reading, silent=shown.now.silent)

    def _say(self, feed: Feed, status: Status) -> None:
        opening = "" if isinstance(feed.choice, PortChoice) else f"opening {feed.choice.name}"
        words = words_of(
            feed.choice.name, status, standing=self._standing(feed), pace=self._pace(feed), contacts=feed.contacts, opening=opening
        )
        self.status.configure(text=words.text, style=f"{words.kind.title()}.TLabel")
        self.lights.say(self._note(feed, status))
        if feed.records:
            self.row.recording(self._record_name, feed.recording)
        elif self._record_name:
            self._finish_record(feed)

    def _finish_record(self, feed: Feed) -> None:
        if not self._record_name:
            return
        name, self._record_name = self._record_name, ""
        frames = feed.recorded
        self.row.ended(f"{name}: {frames:,} frames recorded" if frames else f"{name}: no frame came; no file was left")
        if feed.recording_fault:
            self._complain(feed.recording_fault)

    def _end(self, feed: Feed, status: Status) -> None:
        """The source has ended by itself; what it gave stays to be looked at."""
        self._say(feed, status)
        if status.sentence:
            self._complain(status.sentence)
        self.lights.show({})
        self.lights.say("")
        self.connect.connected(False)
        self.row.enable(record=False, pause=False)
        self.feed = None
        if self._stream is None:
            self._blank()

    def _standing(self, feed: Feed) -> str:
        player = feed.player
        if player is None:
            return ""
        if player.paused:
            return "paused"
        return "at its end" if player.at_end else ""

    def _pace(self, feed: Feed) -> str:
        player = feed.player
        return "" if player is None else "at its own pace" if player.pace == 1 else f"{player.pace:g} times its own pace"

    def _note(self, feed: Feed, status: Status) -> str:
        """What has to be said beside lights that are not of now."""
        watch = feed.watch
        if watch is None or not watch.contact or not any(self._sensors) or status.stream is None or status.state != "running":
            return ""
        parts = ["paused"] * (self._held is not None) + ["simulated"] * status.stream.simulated
        if isinstance(feed.choice, LogChoice):
            parts.append(f"log {feed.choice.name}")
        return "contacts: " + ", ".join(parts) if parts else ""

    # What the user and the document do

    def _contact_channels(self, stream: Stream) -> tuple[str, ...]:
        skin = self._session.skin
        return watched(stream, sensors_of(stream, skin), skin)

    def _on_skin(self) -> None:
        if self.feed is not None and self._stream is not None:
            self._name_channels(self.feed)
            self.feed.watch_for_contacts(self._contact_channels(self._stream))

    def _name_channels(self, feed: Feed) -> None:
        stream = self._stream
        assert stream is not None
        self._sensors = sensors_of(stream, self._session.skin)
        notes = (*feed.notes, unread(self._sensors, self._session.skin))
        self._session.report("live notes", [Problem(note, "live notes", kind="note") for note in notes if note])
        labels = [label(name, sensor) for name, sensor in zip(stream.names, self._sensors, strict=True)]
        self.plots.begin(stream, labels, angle=self.angle.calibration is not None and bool(self.angle.channel.get()))

    def _chosen(self, channel: int) -> None:
        sensor, skin = self._sensors[channel] if channel < len(self._sensors) else "", self._session.skin
        if sensor and skin is not None:
            self._session.select(Target(piece=next(s.piece for s in skin.sensors if s.id == sensor), sensor=sensor))

    def _calibrate(self, calibration: SensorCalibration | None, channel: str) -> None:
        if self.feed is not None and self._stream is not None:
            self.feed.calibrate(calibration, channel)
            self._name_channels(self.feed)

    def _pause(self, paused: bool) -> None:
        """Curves, colours, readings and lights stand still; what comes is kept and recorded all the same."""
        self._held = self._last if paused else None
        self._said_at = 0.0  # the views say at once that their lights are of then

    def _toggle(self) -> None:
        if self.log_row.player is not None:
            self.log_row.toggle()
        elif self.feed is not None:
            self.row.paused.set(not self.row.paused.get())
            self._pause(self.row.paused.get())

    def _blank(self) -> None:
        if self.feed is None and self._stream is None:
            self.plots.clear(_NOTHING)

    def _complain(self, sentence: str) -> None:
        self._session.report("live", [Problem(sentence, "live")] if sentence else [])

    def _complain_of_angle(self, sentence: str) -> None:
        self._session.report("angle", [Problem(sentence, "angle", kind="warning")] if sentence else [])

    def _stop(self) -> None:
        if self._timer:
            self.after_cancel(self._timer)
            self._timer = ""

    def _destroyed(self, event: tk.Event) -> None:
        if event.widget is self:
            self._stop()
            if self.feed is not None:
                self.feed.close()


def _read(touched: dict[str, float], newest: Frame | None, stream: Stream) -> dict[str, float]:
    """Touched channels without those that have no reading now: whether they are touched is not known."""
    if newest is None:
        return touched
    return {name: change for name, change in touched.items() if newest.valid[stream.index(name)]}
