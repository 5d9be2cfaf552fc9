"""Start, watch and stop the work of the worker process, from the window's own loop."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any, Protocol

from gui.jobs.parcel import receive, send, shared
from gui.jobs.worker import Order, Outcome, Ready, Step, serve

#: How often the window looks, ms.
POLL_MS = 15

#: What was cancelled may clean up this long, s, before it is ended for good.
GRACE_S = 5.0


#: A second process is made ready so long, s, after the first was started: quick clicks that take back work want one each, but the
#: window's own start comes first.
SPARE_AFTER_S = 3.0


@dataclass
class _Helper:
    """A process, the way to it, whether it listens yet, and since when there is it."""

    process: SpawnProcess
    channel: Connection
    began: float
    ready: bool = False


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
    own : bool
        Nobody asked for it: other work may take its place.
    wanted : callable, optional
        Whether its result could still be used.
    """

    label: str
    done: Callable[[Any], None]
    failed: Callable[[str], None]
    own: bool = False
    wanted: Callable[[], bool] | None = None


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
        self._helper = _start()
        self._spare: _Helper | None = None
        self._known: list[object] = []  # what was sent and may come back as it is
        self._order: Order | None = None  # waits until the process listens: sending much to one that does not would stop the window
        self._timer = clock.after(POLL_MS, self._poll)

    @property
    def job(self) -> Job | None:
        """What is going on, or None."""
        return self._job

    def start(
        self,
        label: str,
        function: Callable[..., Any],
        *,
        done: Callable[[Any], None],
        failed: Callable[[str], None],
        own: bool = False,
        wanted: Callable[[], bool] | None = None,
        **arguments: Any,
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
        own : bool
            Nobody asked for it.
        wanted : callable, optional
            Whether its result could still be used, for one who looks whether to go on with it.
        **arguments
            Values that can be pickled.
        """
        if self._closed:  # the window was closed under a question that led here
            return
        self.cancel()
        self._job = Job(label, done, failed, own, wanted)
        self._changed(Step(0.0, label))
        self._order = Order(function, arguments)
        self._send()

    def cancel(self) -> bool:
        """Stop what is going on; whether there was anything. Its files are cleaned up, its result is never seen."""
        if self._job is None:
            return False
        self._job = None
        if self._order is None:
            self._replace()
        self._order = None  # one that was not sent yet costs no process
        self._changed(None)
        return True

    def close(self) -> None:
        """End the process, at the end of the program."""
        self._closed = True
        self._clock.after_cancel(self._timer)
        patience = GRACE_S if self._job is not None else 1.0
        self._job = None
        helpers = [self._helper, *([self._spare] if self._spare is not None else [])]
        for helper in helpers:
            helper.channel.close()
            helper.process.terminate()
        for process in [*(helper.process for helper in helpers), *(process for process, _ in self._retired)]:
            process.join(timeout=patience)
            if process.is_alive():
                process.kill()
                process.join()

    def _send(self) -> None:
        if self._order is None or not self._helper.ready:
            return
        order, self._order = self._order, None
        try:
            send(self._helper.channel, order)
            self._known = shared(order.arguments)
        except (BrokenPipeError, ConnectionResetError):  # it died while idle
            self._order = order
            self._replace()

    def _replace(self) -> None:
        """Let the process go; the spare one takes its place."""
        self._helper.channel.close()
        self._helper.process.terminate()
        self._retired.append((self._helper.process, time.monotonic() + GRACE_S))
        self._helper, self._spare = self._spare or _start(), None
        self._send()

    def _poll(self) -> None:
        self._timer = self._clock.after(POLL_MS, self._poll)
        self._bury()
        if self._spare is None and self._helper.ready and time.monotonic() - self._helper.began > SPARE_AFTER_S:
            self._spare = _start()
        self._listen_to_spare()
        # What it says may start other work, on another channel.
        helper = self._helper
        try:
            while not self._closed and helper is self._helper and helper.channel.poll():
                self._hear(receive(helper.channel, self._known))
        except (EOFError, ConnectionResetError):
            self._mourn()

    def _listen_to_spare(self) -> None:
        """A spare one has nothing to say but that it is ready."""
        spare = self._spare
        try:
            if spare is not None and spare.channel.poll():
                receive(spare.channel)
                spare.ready = True
        except (EOFError, ConnectionResetError):  # it died: another will be made
            self._spare = None

    def _hear(self, message: Ready | Step | Outcome) -> None:
        if isinstance(message, Ready):
            self._helper.ready = True
            self._send()
            return
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


def _start() -> _Helper:
    # Not forked: a copy of a process with a window and threads is neither safe nor small.
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(theirs,), daemon=True, name="skinfab worker")
    process.start()
    theirs.close()
    return _Helper(process, ours, time.monotonic())
