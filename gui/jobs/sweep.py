"""Garbage is collected in the window's own thread only.

What Tk's variables and pictures leave in cycles calls Tk when it is collected. From another thread that waits for the window's loop,
and stands still for ever where the loop waits for that thread.
"""

from __future__ import annotations

import gc

from gui.jobs.runner import Clock

#: How often it is looked, ms: a look costs microseconds where there is nothing to do.
_EVERY_MS = 250


class Sweep:
    """Takes the place of Python's own collector while the window is open.

    Parameters
    ----------
    clock : tk widget
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._was_on = gc.isenabled()
        gc.disable()
        self._timer = clock.after(_EVERY_MS, self._look)

    def close(self) -> None:
        """Let Python collect by itself again."""
        self._clock.after_cancel(self._timer)
        if self._was_on:
            gc.enable()

    def _look(self) -> None:
        self._timer = self._clock.after(_EVERY_MS, self._look)
        # The generations that Python itself would collect now.
        due = [k for k, (count, most) in enumerate(zip(gc.get_count(), gc.get_threshold(), strict=True)) if count > most > 0]
        if due:
            gc.collect(due[-1])
