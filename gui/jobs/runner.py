"""Start, watch and stop the work of the worker process, from the window's own loop."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any, Protocol

from gui.jobs.worker import Order, Outcome, Step, serve

#: How often the window looks, ms.
POLL_MS = 15

#: What was cancelled may clean up this long, s, before it is ended for good.
GRACE_S = 5.0


class Clock(Protocol):
    """The part of a Tk widget that the runner needs."""

    def after(self, ms: int, func: Callable[[], None], /) -> str: ...
    def after_cancel(self, id: str, /) -> None: ...


@dataclass(frozen=True)
class Job:
    """Work that is going on.

    Parameters
    ----------
    label : str
        "flattening", for the status bar.
    done : callable
        Called with the result.
    failed : callable
        Called with a sentence.
    """

    label: str
    done: Callable[[Any], None]
    failed: Callable[[str], None]


class Runner:
    """One piece of long work at a time, in a process that is kept warm.

    Parameters
    ----------
    clock : tk widget
    changed : callable
        Called with `Step` while work goes on, and with None when there is none any more.
    log : callable
        Called with the traceback of a fault of the program's own.
    """

    def __init__(self, clock: Clock, *, changed: Callable[[Step | None], None], log: Callable[[str], None]) -> None:
        self._clock = clock
        self._changed = changed
        self._log = log
        self._job: Job | None = None
        self._closed = False
        self._retired: list[tuple[SpawnProcess, float]] = []
        self._process, self._channel = _start()
        self._timer = clock.after(POLL_MS, self._poll)

    @property
    def job(self) -> Job | None:
        """What is going on, or None."""
        return self._job

    def start(
        self, label: str, function: Callable[..., Any], *, done: Callable[[Any], None], failed: Callable[[str], None], **arguments: Any
    ) -> None:
        """Have `function` done with `arguments` and ``progress``; what was going on is cancelled.

        Parameters
        ----------
        label : str
        function : callable
            One that can be named from another process: at the top of a module.
        done : callable
            Called with its result, in the window's loop.
        failed : callable
            Called with one sentence where it raised, or its process ended.
        **arguments
            Values that can be pickled.
        """
        if self._closed:  # the window was closed under a question that led here
            return
        self.cancel()
        self._job = Job(label, done, failed)
        self._changed(Step(0.0, label))
        try:
            self._channel.send(Order(function, arguments))
        except (BrokenPipeError, ConnectionResetError):  # it died while idle
            self._replace()
            self._channel.send(Order(function, arguments))

    def cancel(self) -> bool:
        """Stop what is going on; whether there was anything. Its files are cleaned up, its result is never seen."""
        if self._job is None:
            return False
        self._job = None
        self._replace()
        self._changed(None)
        return True

    def close(self) -> None:
        """End the process, at the end of the program."""
        self._closed = True
        self._clock.after_cancel(self._timer)
        self._job = None
        self._channel.close()
        self._process.terminate()
        for process, _ in [(self._process, 0.0), *self._retired]:
            process.join(timeout=1.0)
            if process.is_alive():
                process.kill()
                process.join()

    def _replace(self) -> None:
        self._channel.close()
        self._process.terminate()
        self._retired.append((self._process, time.monotonic() + GRACE_S))
        self._process, self._channel = _start()

    def _poll(self) -> None:
        self._timer = self._clock.after(POLL_MS, self._poll)
        self._bury()
        # What it says may start other work, on another channel.
        channel = self._channel
        try:
            while not self._closed and channel is self._channel and channel.poll():
                self._hear(channel.recv())
        except (EOFError, ConnectionResetError):
            self._mourn()

    def _hear(self, message: Step | Outcome) -> None:
        job = self._job
        if job is None:
            return
        if isinstance(message, Step):
            self._changed(message)
            return
        self._job = None
        self._changed(None)
        if message.trace:
            self._log(message.trace)
        if message.sentence:
            job.failed(message.sentence)
        else:
            job.done(message.result)

    def _mourn(self) -> None:
        """The process ended by itself."""
        job, self._job = self._job, None
        self._replace()
        self._changed(None)
        if job is not None:
            job.failed(f"{job.label}: the work was ended by the system, most likely for want of memory; take a mesh with fewer faces")

    def _bury(self) -> None:
        now = time.monotonic()
        for process, deadline in self._retired:
            if process.is_alive() and now > deadline:
                process.kill()
        self._retired = [(p, t) for p, t in self._retired if p.is_alive()]


def _start() -> tuple[SpawnProcess, Connection]:
    # Not forked: a copy of a process with a window and threads is neither safe nor small.
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(theirs,), daemon=True, name="skinfab worker")
    process.start()
    theirs.close()
    return process, ours
