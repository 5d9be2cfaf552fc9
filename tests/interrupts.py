"""Ctrl-C, pressed at a frame rather than at a time: what a test reads of a port does not depend on how busy the machine is."""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

#: From one to the next, s.
AGAIN_S = 0.05


@contextmanager
def pressed(watch: type, *, after: int, then: Callable[[], None] = lambda: None) -> Iterator[None]:
    """While `watch` is given its frame of that number, which must come."""
    step = watch.step  # type: ignore[attr-defined]
    given = 0

    def stepped(self: Any, *args: Any) -> Any:
        nonlocal given
        given += 1
        made = step(self, *args)
        if given == after:
            then()
            signal.raise_signal(signal.SIGINT)
        return made

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(watch, "step", stepped)
            yield
            assert given == after
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def pressed_twice(watch: type, writing: str, *, after: int) -> Iterator[None]:
    """So, and again 0.05 s later: at the latest while `writing`, a figure, is under way."""
    again = threading.Timer(AGAIN_S, os.kill, (os.getpid(), signal.SIGINT))

    def drawn(*args: Any, **words: Any) -> None:
        again.join()
        next(each for each in args if isinstance(each, Path)).write_bytes(b"drawn")

    with pytest.MonkeyPatch.context() as patch, pressed(watch, after=after, then=again.start):
        patch.setattr(writing, drawn)
        try:
            yield
        finally:
            again.cancel()  # where the command went down by the first, the second is not to meet the tests
        assert not again.is_alive()
