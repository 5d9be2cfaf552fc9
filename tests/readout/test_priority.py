"""Real-time priority: for this thread and its own, for a while, and nothing amiss where it is not granted."""

import os
import threading

import pytest

from skinfab.readout.priority import real_time


def test_not_granted_all_goes_on_as_usual(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    before = os.sched_getscheduler(0)
    with real_time() as granted:
        assert not granted and os.sched_getscheduler(0) == before


def test_threads_have_it_too_and_it_ends_whatever_happens() -> None:
    before, found, told = os.sched_getscheduler(0), [], []

    def work() -> None:
        with real_time() as granted:
            told.append(granted)
            thread = threading.Thread(target=lambda: found.append(os.sched_getscheduler(0)))
            thread.start()
            thread.join()
            raise KeyError

    with pytest.raises(KeyError):
        work()
    assert found == [os.SCHED_RR if told[0] else before] and os.sched_getscheduler(0) == before
