"""Small questions answered beside the window's loop: half a second of numpy, not worth a process nor a progress bar."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from typing import Any

from gui.jobs.runner import Clock
from gui.jobs.worker import Outcome, outcome_of

#: How often the window looks for answers while it waits for one, ms.
_LOOK_MS = 20

#: A question that takes longer, s, is one that never ends.
_PATIENCE_S = 10.0


class Background:
    """One thread; of questions under the same key only the newest is answered.

    Parameters
    ----------
    clock : tk widget
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._questions: queue.SimpleQueue[tuple[str, int, Callable[[], Any]] | None] = queue.SimpleQueue()
        self._answers: queue.SimpleQueue[tuple[str, int, Outcome]] = queue.SimpleQueue()
        self._newest: dict[str, tuple[int, Callable[[Outcome], None]]] = {}
        self._count = 0
        self._timer: str | None = None
        self._thread = threading.Thread(target=self._run, name="background", daemon=True)
        self._thread.start()

    def ask(self, key: str, question: Callable[[], Any], answered: Callable[[Outcome], None]) -> None:
        """Compute `question` and hand what comes of it to `answered`, in the window's loop, unless `key` is asked again before."""
        self._count += 1
        self._newest[key] = self._count, answered
        self._questions.put((key, self._count, question))
        if self._timer is None:
            self._timer = self._clock.after(_LOOK_MS, self._look)

    def close(self) -> None:
        """Forget what was asked, and end the thread.

        That is waited for: a thread that outlives the window is the last to hold it, and Tk aborts the process when it is let go there.
        """
        self._newest.clear()
        self._questions.put(None)
        if self._timer is not None:
            self._clock.after_cancel(self._timer)
        self._thread.join(timeout=_PATIENCE_S)

    def _run(self) -> None:
        while (asked := self._questions.get()) is not None:
            key, number, question = asked
            newest = self._newest.get(key)
            if newest is not None and newest[0] == number:
                self._answers.put((key, number, outcome_of(question)))

    def _look(self) -> None:
        self._timer = None
        while not self._answers.empty():
            key, number, outcome = self._answers.get()
            newest = self._newest.get(key)
            if newest is not None and newest[0] == number:
                del self._newest[key]
                newest[1](outcome)
        if self._newest and self._timer is None:
            self._timer = self._clock.after(_LOOK_MS, self._look)
