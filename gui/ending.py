"""Signals that end the program are taken up by the window's own loop.

Raised as an interrupt, one that comes while a question is open is lost: there Python runs in callbacks alone, and what is raised at the
entry of one ends up in Tk, which shows a box of its own and goes on waiting.
"""

from __future__ import annotations

import signal
import time
import tkinter as tk
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

#: How often it is looked whether a signal has come, ms.
_LOOK_MS = 150

#: A signal that comes so long after the first, s, finds a loop that stands still, and is raised there as an interrupt.
STUCK_S = 5.0

#: What a terminal, a log-out and a shutdown send.
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

#: Classes of windows that wait for an answer: the window's own, Tk's for files and folders, its questions, and its box for faults.
_FILES = ("TkFDialog", "TkChooseDir")
_CLASSES = ("Toplevel", *_FILES, "Dialog", "ErrorDialog")


@contextmanager
def heeding_signals(root: tk.Tk, end: Callable[[], None]) -> Iterator[None]:
    """While the window's loop runs inside, close what it asks once a signal has come, then call `end`; the signal is passed on afterwards.

    Parameters
    ----------
    root : Tk
    end : callable
        Ends the window, and with it the loop; called once, when no question waits for an answer.

    Raises
    ------
    KeyboardInterrupt
        At the end, from whoever handled these signals before, where one has come.
    """
    before = {number: signal.getsignal(number) for number in SIGNALS}
    ours = {number: handler for number, handler in before.items() if callable(handler)}  # not those that are ignored, as by nohup
    came: dict[int, float] = {}

    def heed(number: int, frame: FrameType | None) -> None:
        first = min(came.values(), default=time.monotonic())
        came.setdefault(number, time.monotonic())
        if time.monotonic() - first > STUCK_S:
            ours[signal.Signals(number)](number, frame)

    def look() -> None:
        if came and not close_question(root):
            end()
        else:
            root.after(_LOOK_MS, look)

    root.after(_LOOK_MS, look)
    for number in ours:
        signal.signal(number, heed)
    try:
        yield
    finally:
        for number, handler in ours.items():
            signal.signal(number, handler)
        for told in came:
            signal.raise_signal(told)


def close_question(root: tk.Tk) -> bool:
    """Close the uppermost question over the main window, Tk's own dialogs too, as Cancel would; whether there was one."""
    found = _questions(root, ".")
    if not found:
        return False
    above = found[-1]
    if _class_of(root, above) in _FILES:
        root.tk.call(f"{above}.contents.f2.cancel", "invoke")  # Tk keeps the window, hidden, and breaks where it is destroyed
    else:
        root.tk.call("destroy", above)
    return True


def _questions(root: tk.Tk, widget: str) -> list[str]:
    """By name, since Tk's own dialogs are no widgets of Python's; one that lies over another comes behind it."""
    # Minimised with the main window it still waits; what Tk keeps for the next time is withdrawn.
    waits = widget != "." and _class_of(root, widget) in _CLASSES and str(root.tk.call("wm", "state", widget)) != "withdrawn"
    found = [widget] if waits else []
    for child in root.tk.splitlist(root.tk.call("winfo", "children", widget)):
        found += _questions(root, str(child))
    return found


def _class_of(root: tk.Tk, widget: str) -> str:
    return str(root.tk.call("winfo", "class", widget))
