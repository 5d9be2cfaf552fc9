"""The bar that goes through a print: play, scrub, step by step, faster or slower."""

from __future__ import annotations

import time
import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from gui.toolpath.timeline import Timeline

#: How many seconds of the print pass in one while it plays.
SPEEDS = (1, 5, 20, 60, 300)

#: From one picture to the next while it plays, ms.
FRAME_MS = 33


def clock(seconds: float) -> str:
    """A time as it is read.

    Examples
    --------
    >>> clock(65.26), clock(3725)
    ('1:05.3', '1:02:05.0')
    """
    tenths = round(seconds * 10)
    minutes, rest = divmod(tenths, 600)
    hours, minutes = divmod(minutes, 60)
    return (f"{hours}:{minutes:02d}" if hours else f"{minutes}") + f":{rest / 10:04.1f}"


class Transport(ttk.Frame):
    """Says what time is looked at.

    Parameters
    ----------
    master : widget
    on_time : callable
        Called with the time, s, whenever it changes.
    """

    def __init__(self, master: tk.Misc, *, on_time: Callable[[float], None]) -> None:
        super().__init__(master, name="transport", padding=(6, 3))
        self._on_time = on_time
        self.line: Timeline | None = None
        self.time = 0.0
        self.playing: str | None = None
        self._last = 0.0
        self._setting = False
        self.play = ttk.Button(self, text="▶", width=3, command=self.toggle, name="play")
        self.back = ttk.Button(self, text="◀|", width=3, command=lambda: self.step(-1), name="back")
        self.forth = ttk.Button(self, text="|▶", width=3, command=lambda: self.step(1), name="forth")
        self.scale = ttk.Scale(self, from_=0.0, to=1.0, command=self._scrubbed, name="scale", takefocus=True)
        self.speed = ttk.Combobox(self, values=[f"{s} x" for s in SPEEDS], state="readonly", width=6, name="speed")
        self.speed.set(f"{SPEEDS[2]} x")
        for k, widget in enumerate((self.play, self.back, self.scale, self.forth, self.speed)):
            widget.grid(row=0, column=k, sticky="ew", padx=2)
        self.columnconfigure(2, weight=1)
        self.bind_keys(self.scale)
        self.bind("<Destroy>", lambda event: self._cancel())  # its buttons are gone by then
        self.show(None)

    def bind_keys(self, widget: tk.Misc) -> None:
        """Let a widget's keys move through the print: arrows, Home, End, space."""
        keys: dict[str, Callable[[], object]] = {
            "<Left>": lambda: self.step(-1),
            "<Right>": lambda: self.step(1),
            "<Prior>": lambda: self.seek(self.time - self._tenth()),
            "<Next>": lambda: self.seek(self.time + self._tenth()),
            "<Home>": lambda: self.seek(0.0),
            "<End>": lambda: self.seek(float("inf")),
            "<space>": self.toggle,
        }
        for key, work in keys.items():
            widget.bind(key, _then_stop(work))

    def show(self, line: Timeline | None) -> None:
        """Go through another print; at its end at first, or at the same time where one was looked at."""
        end = self.line.end if self.line is not None else 0.0
        at_end = self.line is None or self.time >= end or line is None or line.piece != self.line.piece
        self.line = line
        for widget in (self.play, self.back, self.forth, self.scale, self.speed):
            widget.state(["disabled" if line is None else "!disabled"])
        if line is None:
            self.stop()
            self.time = 0.0
            self._set_scale()
        else:
            self.scale.configure(to=max(line.end, 1e-3))
            self.time = line.end if at_end else min(self.time, line.end)
            self._set_scale()

    def seek(self, time: float) -> None:
        """Look at a time, s."""
        if self.line is None:
            return
        self.time = min(max(time, 0.0), self.line.end)
        self._set_scale()
        self._on_time(self.time)

    def step(self, by: int) -> None:
        """To the end of the step before or after."""
        if self.line is None:
            return
        line, k = self.line, self.line.step_at(self.time)
        ends = [*line.start[1:], line.end]
        if by > 0:
            k += self.time >= ends[k]
            self.seek(float(ends[min(k, len(ends) - 1)]))
        else:
            self.seek(float(line.start[k] if self.time > line.start[k] else line.start[max(k - 1, 0)]))

    def toggle(self) -> None:
        """Play, or stop; from the start where it had come to its end."""
        if self.playing is not None:
            self.stop()
        elif self.line is not None:
            if self.time >= self.line.end:
                self.seek(0.0)
            self._last = time.monotonic()
            self.playing = self.after(FRAME_MS, self._frame)
            self.play.configure(text="▮▮")

    def stop(self) -> None:
        """Play no more."""
        if self.playing is not None:
            self._cancel()
            self.play.configure(text="▶")

    def _cancel(self) -> None:
        if self.playing is not None:
            self.after_cancel(self.playing)
            self.playing = None

    def _frame(self) -> None:
        now = time.monotonic()
        passed, self._last = now - self._last, now
        self.seek(self.time + passed * float(self.speed.get().split()[0]))
        if self.line is None or self.time >= self.line.end:
            self.stop()
        else:
            self.playing = self.after(FRAME_MS, self._frame)

    def _tenth(self) -> float:
        return self.line.end / 10 if self.line is not None else 0.0

    def _set_scale(self) -> None:
        self._setting = True
        self.scale.set(self.time)
        self._setting = False

    def _scrubbed(self, value: str) -> None:
        if not self._setting and self.line is not None:
            self.time = float(value)
            self._on_time(self.time)


def _then_stop(work: Callable[[], object]) -> Callable[[tk.Event], str]:
    def pressed(event: tk.Event) -> str:
        work()
        return "break"

    return pressed
