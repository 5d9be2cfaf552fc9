"""Ctrl-C as the way to end what goes on until it comes: recordings, cameras."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def ended_by_signals() -> Iterator[threading.Event]:
    """An event that Ctrl-C, SIGTERM and SIGHUP set, and set once more: what is under way is ended between two frames, and is kept.

    Whatever is written within is written whole, however often Ctrl-C is pressed.

    Examples
    --------
    >>> with ended_by_signals() as stop:
    ...     signal.raise_signal(signal.SIGINT)
    ...     stop.is_set()
    True
    """
    stop = threading.Event()
    before = {s: signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    # What is ignored (nohup) stays so; and only the main thread may say what a signal does.
    ours = [s for s, handler in before.items() if callable(handler) and threading.current_thread() is threading.main_thread()]
    try:
        for s in ours:
            signal.signal(s, lambda number, frame: stop.set())
        yield stop
    finally:
        for s in ours:
            signal.signal(s, before[s])
