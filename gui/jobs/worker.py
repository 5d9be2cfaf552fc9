"""The process that does the long work: it is sent functions with their arguments, and sends back what comes of them."""

from __future__ import annotations

import importlib
import os
import signal
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from types import FrameType
from typing import Any

from gui.jobs.parcel import receive, send, shared
from skinfab.errors import SkinfabError

#: Progress is told at most this often, s: more than a screen shows is only traffic.
TELL_EVERY_S = 0.03

#: Modules that take long to import and that its work needs.
NEEDS = ("shapely", "gcode.write", "skinfab.placement.auto", "skinfab.seams.auto")


@dataclass(frozen=True)
class Order:
    """Work to do: a function that can be named (not a lambda), and what it is given besides ``progress``."""

    function: Callable[..., Any]
    arguments: dict[str, Any]


@dataclass(frozen=True)
class Ready:
    """All is imported: what is sent now is read at once."""


@dataclass(frozen=True)
class Step:
    """How far the work is."""

    fraction: float
    label: str


@dataclass(frozen=True)
class Outcome:
    """How the work ended.

    Parameters
    ----------
    result : object
        What the function gave; None where it failed.
    sentence : str
        What went wrong and what to do; "" where all went well.
    trace : str
        Where, for a fault of the program's own; "" otherwise.
    """

    result: Any = None
    sentence: str = ""
    trace: str = ""


def serve(channel: Connection) -> None:
    """Do one order after the other until the window is gone. The main function of the process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C on a terminal reaches all its processes; the window decides
    signal.signal(signal.SIGTERM, _end)
    try:
        _import_what_takes_long()
        send(channel, Ready())
        while True:
            order = receive(channel)
            known = shared(order.arguments)
            signal.signal(signal.SIGTERM, _interrupt)  # cancelled: unwind, so that half-written files go
            outcome = _obey(order, channel)
            signal.signal(signal.SIGTERM, _end)
            send(channel, outcome, known)
    except (EOFError, BrokenPipeError, ConnectionResetError, KeyboardInterrupt):
        return  # the window was closed, or wants this work no more


def outcome_of(work: Callable[[], Any]) -> Outcome:
    """Do it; a fault becomes a sentence.

    Examples
    --------
    >>> from skinfab.errors import InputError
    >>> def refuse():
    ...     raise InputError("no such mesh")
    >>> outcome_of(refuse).sentence, outcome_of(lambda: 7).result
    ('no such mesh', 7)
    """
    try:
        return Outcome(result=work())
    except Exception as fault:
        sentence, ours = sentence_of(fault)
        return Outcome(sentence=sentence, trace=traceback.format_exc() if ours else "")


def sentence_of(fault: BaseException) -> tuple[str, bool]:
    """What to tell the user of a fault, and whether it is one of the program's own."""
    if isinstance(fault, SkinfabError):
        return str(fault), False
    if isinstance(fault, MemoryError):
        return "not enough memory for this; close other programs, or take a mesh with fewer faces", False
    if isinstance(fault, OSError):
        where = f"{fault.filename}: " if fault.filename is not None else ""
        return f"{where}{fault.strerror or fault}", False
    return f"unexpected {type(fault).__name__}: {fault} (a fault of skinfab: please report it)", True


def _obey(order: Order, channel: Connection) -> Outcome:
    told = 0.0

    def progress(fraction: float, label: str) -> None:
        nonlocal told
        now = time.monotonic()
        if now - told >= TELL_EVERY_S:
            told = now
            send(channel, Step(fraction, label))

    return outcome_of(lambda: order.function(**order.arguments, progress=progress))


def _end(number: int, frame: FrameType | None) -> None:
    os._exit(0)  # nothing is begun that would have to be cleaned up, and imports that are broken off only make noise


def _interrupt(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # once is enough, and the cleaning up must not be cut short
    raise KeyboardInterrupt


def _import_what_takes_long() -> None:
    """Before the first order, while the user still looks at the window; with less than its share of a core."""
    os.nice(5)
    for name in NEEDS:
        importlib.import_module(name)
