"""No thread but the window's own collects what Tk has to be told of."""

import gc
import threading
import time
import tkinter as tk
import weakref

import pytest

from gui.jobs.sweep import Sweep


@pytest.fixture
def sweep(root):
    made = Sweep(root)
    yield made
    made.close()
    assert gc.isenabled()


class Cycle:
    """Tells in which thread it was collected."""

    def __init__(self, told):
        self.me = self
        weakref.finalize(self, lambda: told.append(threading.current_thread()))


def litter():
    for _ in range(5000):
        [].append(kept := [])
        kept.append(kept)


def test_a_thread_that_makes_garbage_collects_none(root, sweep):
    told, variable = [], tk.StringVar(root)
    Cycle(told)
    variable.me = variable
    del variable
    thread = threading.Thread(target=litter)
    thread.start()
    thread.join()
    assert told == []
    end = time.monotonic() + 10
    while not told:
        assert time.monotonic() < end
        root.update()
        time.sleep(0.01)
    assert told == [threading.main_thread()]


def test_without_it_a_thread_would(root):
    told = []
    gc.collect()
    Cycle(told)
    thread = threading.Thread(target=litter)
    thread.start()
    thread.join()
    assert told and told[0] is thread
