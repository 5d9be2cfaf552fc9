"""Ctrl-C, pressed twice: while what a port sends is watched, and again before it is written."""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

#: From one to the next, s.
AGAIN_S = 0.05


@contextmanager
def pressed_twice(watch: type, writing: str, *, after: int) -> Iterator[None]:
    """While `watch` is given its frame of that number, and 0.05 s later: at the latest while `writing`, a figure, is under way."""
    step = watch.step  # type: ignore[attr-defined]
    given = 0
    again = threading.Timer(AGAIN_S, os.kill, (os.getpid(), signal.SIGINT))

    def stepped(self: Any, *args: Any) -> Any:
        nonlocal given
        given += 1
        made = step(self, *args)
        if given == after:
            again.start()
            signal.raise_signal(signal.SIGINT)
        return made

    def drawn(*args: Any, **words: Any) -> None:
        again.join()
        next(each for each in args if isinstance(each, Path)).write_bytes(b"drawn")

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(watch, "step", stepped)
            patch.setattr(writing, drawn)
            yield
            assert not again.is_alive() and given == after
    finally:
        again.cancel()  # where the command went down by the first, the second is not to meet the tests
        signal.signal(signal.SIGINT, before)
