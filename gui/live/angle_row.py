"""The calibrated joint angle: dial, calibration and the channel it reads."""

from __future__ import annotations

import math
import tkinter as tk
from collections.abc import Callable, Sequence
from pathlib import Path
from tkinter import ttk

from calibration.strain.document import SensorCalibration, load_calibration
from calibration.strain.reading import Reading
from gui.live.dial import Dial
from gui.theme import Theme
from skinfab.errors import SkinfabError


class AngleRow(ttk.Frame):
    """What turns a reading into an angle, and the angle.

    Parameters
    ----------
    master : widget
    theme : Theme
    ask : callable
        Asks for a calibration.json; None where none was given.
    changed : callable
        Called with the calibration, None for none, and the channel; raises SkinfabError where they do not go with the source.
    complain : callable
        Called with a sentence, or "" once all is well.
    """

    def __init__(
        self,
        master: tk.Misc,
        theme: Theme,
        *,
        ask: Callable[[], Path | None],
        changed: Callable[[SensorCalibration | None, str], object],
        complain: Callable[[str], object],
    ) -> None:
        super().__init__(master, name="angle", padding=(4, 2))
        self._ask, self._changed, self._complain = ask, changed, complain
        self.calibration: SensorCalibration | None = None
        self.channel = tk.StringVar(self)
        self.dial = Dial(self, theme)
        self._side = side = ttk.Frame(self, name="side")
        side.pack(side="left", fill="both", expand=True)
        row = ttk.Frame(side, name="row")
        row.pack(fill="x", pady=(2, 0))
        ttk.Button(row, text="Calibration \N{HORIZONTAL ELLIPSIS}", command=self._choose, style="Tool.TButton", name="choose").pack(
            side="left"
        )
        self._channels = ttk.Combobox(row, textvariable=self.channel, state="readonly", width=12, name="channel")
        self._channels.bind("<<ComboboxSelected>>", lambda event: self.apply())
        self._without = ttk.Button(row, text="Without", command=self.drop, style="Tool.TButton", name="without")
        self._words = ttk.Label(side, style="Faint.TLabel", name="words", justify="left")
        self._words.pack(fill="x", pady=(3, 0))
        side.bind("<Configure>", lambda event: self._words.configure(wraplength=max(event.width - 4, 60)))
        self._lay()

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self.dial.restyle(theme)

    def offer(self, channels: Sequence[str]) -> None:
        """The channels of a source that is there now; the calibration's own is taken where it is among them."""
        self._channels.configure(values=list(channels))
        wanted = "" if self.calibration is None else self.calibration.signal
        if self.channel.get() not in channels:
            self.channel.set(wanted if wanted in channels or not channels else "")
        if self.calibration is not None and self.channel.get():
            self.apply()
        elif self.calibration is not None and channels:
            self._complain(f"the source has no channel {wanted!r}; choose the one beside the calibration that the angle is to be read from")

    def load(self, path: Path) -> None:
        """Take a calibration."""
        try:
            calibration = load_calibration(path)
        except SkinfabError as fault:
            self._complain(str(fault))
            return
        self.calibration = calibration
        self.channel.set("")
        self._complain("")
        self._lay()
        values = self._channels["values"]
        self.offer([values] if isinstance(values, str) and values else list(values or ()))

    def drop(self) -> None:
        """No angle any more."""
        self.calibration = None
        self.channel.set("")
        self._changed(None, "")
        self._complain("")
        self._lay()

    def apply(self) -> None:
        """Have the angle read."""
        try:
            self._changed(self.calibration, self.channel.get())
        except SkinfabError as fault:
            self._complain(str(fault))
        else:
            self._complain("")

    def show(self, reading: Reading | None, *, silent: bool) -> None:
        """The angle now."""
        made = self.calibration
        if made is None:
            return
        angle = math.nan if reading is None or silent else reading.angle
        words = "no reading" if reading is None or silent else reading.fault
        doubtful = reading is not None and reading.outside and not words
        if doubtful:
            words = "beyond its calibration"
        self.dial.show(angle, words, made.low, made.high, doubtful=doubtful)

    def _choose(self) -> None:
        path = self._ask()
        if path is not None:
            self.load(path)

    def _lay(self) -> None:
        made = self.calibration
        for part in (self.dial, self._channels, self._without):
            part.pack_forget()
        if made is None:
            self._words.configure(text="no joint angle: give a calibration.json of skinfab calibrate")
            return
        self.dial.pack(side="left", before=self._side)
        self._channels.pack(side="left", padx=4, fill="x", expand=True)
        self._without.pack(side="left")
        simulated = ", from a simulated log" if made.made_from.get("simulated") else ""
        error = made.error.get("held_out_rms_deg")
        rms = f", {error:.1f}\N{DEGREE SIGN} rms" if error is not None and math.isfinite(error) else ""
        fitted = f"{made.low:.0f} to {made.high:.0f}\N{DEGREE SIGN}{rms}"
        self._words.configure(text=f"{made.signal} to {made.angle}, {fitted}: {made.model.name} of {made.date[:10]}{simulated}")
        self.show(None, silent=True)
