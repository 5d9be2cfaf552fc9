"""Pause, range, and recording to a file."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from skinfab.readout.record import State

#: How much the plots show, s.
RANGES = ("2", "5", "10", "30", "60", "120")


class RecordRow(ttk.Frame):
    """Below the plots.

    Parameters
    ----------
    master : widget
    pause : callable
        Called with whether the plots are to stand still.
    record : callable
        Called by the button, to begin or to end.
    """

    def __init__(self, master: tk.Misc, *, pause: Callable[[bool], object], record: Callable[[], object]) -> None:
        super().__init__(master, name="record_row", padding=(4, 2))
        self.paused, self.range = tk.BooleanVar(self, value=False), tk.StringVar(self, value="10")
        self.hold = ttk.Checkbutton(
            self, text="Pause", variable=self.paused, command=lambda: pause(self.paused.get()), style="Tool.Toolbutton", name="pause"
        )
        self.hold.pack(side="left")
        ttk.Combobox(self, textvariable=self.range, values=RANGES, state="readonly", width=4, name="range").pack(side="left", padx=(6, 2))
        ttk.Label(self, text="s", style="Faint.TLabel").pack(side="left")
        self.button = ttk.Button(self, text="Record \N{HORIZONTAL ELLIPSIS}", command=record, style="Tool.TButton", name="record")
        self.button.pack(side="left", padx=(12, 6))
        self.words = ttk.Label(self, name="words", style="Faint.TLabel")
        self.words.pack(side="left", fill="x", expand=True)

    @property
    def range_s(self) -> float:
        """How much the plots show."""
        return float(self.range.get())

    def enable(self, *, record: bool, pause: bool) -> None:
        """What can be done now."""
        self.button.state(["!disabled" if record else "disabled"])
        self.hold.state(["!disabled" if pause else "disabled"])

    def recording(self, name: str, state: State | None) -> None:
        """A recording goes on, as far as is known."""
        self.button.configure(text="End")
        more = "" if state is None else f": {state.frames:,} frames, {state.bytes / 1e6:.1f} MB; disk {state.free_bytes / 1e9:.0f} GB free"
        self.words.configure(text=f"{name}{more}", style="Error.TLabel")

    def ended(self, words: str) -> None:
        """None goes on any more."""
        self.button.configure(text="Record \N{HORIZONTAL ELLIPSIS}")
        self.words.configure(text=words, style="Faint.TLabel")
