"""The line at the foot: a hint or what is under the pointer, how far long work is, and the units."""

from __future__ import annotations

import time
import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from gui.jobs.worker import Step
from gui.scale import px
from gui.state.session import Session

#: An estimate of the time left is given from this part of the work on: before, it is a guess.
_ESTIMATE_FROM = 0.05


class StatusBar(ttk.Frame):
    """Hints, progress with a cancel button, units.

    Parameters
    ----------
    master : widget
    session : Session
    cancel : callable
        Stops the work that is going on.
    describe : callable
        One line about what the pointer is on.
    """

    def __init__(self, master: tk.Misc, session: Session, *, cancel: Callable[[], object], describe: Callable[[], str]) -> None:
        super().__init__(master, name="statusbar", padding=(8, 2))
        self._session, self._describe = session, describe
        self._tip = ""
        self._began, self._asked = 0.0, False
        self.text = tk.StringVar(self, value="Open a mesh or a skin to begin (Ctrl+O).")
        ttk.Label(self, textvariable=self.text, name="text").pack(side="left", fill="x", expand=True)
        ttk.Label(self, text="mm", style="Faint.TLabel").pack(side="right", padx=(10, 0))
        self._work = ttk.Frame(self, name="work")
        self.progress_text = tk.StringVar(self)
        ttk.Label(self._work, textvariable=self.progress_text, name="label").pack(side="left")
        self._bar = ttk.Progressbar(self._work, length=px(self, 160), maximum=1.0, name="bar")
        self._bar.pack(side="left", padx=6)
        ttk.Button(self._work, text="Cancel", command=cancel, style="Tool.TButton", name="cancel").pack(side="left")
        # As high without work as with it: the views must not move when it begins and ends.
        height = max(child.winfo_reqheight() for child in self._work.winfo_children())
        ttk.Frame(self, height=height, width=1, name="strut").pack(side="right")
        session.listen("hover", self._refresh)
        session.listen("skin", self._refresh)

    def tip(self, text: str) -> None:
        """Show a hint; "" goes back to what the pointer is on."""
        self._tip = text
        self._refresh()

    def say(self, text: str) -> None:
        """Show a sentence until something else is pointed at."""
        self.text.set(text)

    def progress(self, step: Step | None, *, asked: bool = False) -> None:
        """Show how far the work is; None when there is none. What was said before work that was `asked` for is no longer shown."""
        if step is None:
            self._work.pack_forget()
            self._began, self._asked = 0.0, False
            return
        if asked and not self._asked:
            self._asked = True
            self._refresh()
        if not self._began:
            self._began = time.monotonic()
            self._work.pack(side="right")
        self._bar["value"] = min(max(step.fraction, 0.0), 1.0)
        self.progress_text.set(step.label + self._time_left(step.fraction))

    def _time_left(self, fraction: float) -> str:
        spent = time.monotonic() - self._began
        if fraction < _ESTIMATE_FROM or spent < 1:
            return ""
        left = spent * (1 - fraction) / fraction
        return f", {left:.0f} s left" if left < 90 else f", {left / 60:.0f} min left"

    def _refresh(self) -> None:
        self.text.set(self._tip or self._describe())
