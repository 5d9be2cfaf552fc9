"""Answers come in the window's loop, and only the newest."""

import threading
import time

import pytest

from gui.jobs.background import Background
from skinfab.errors import InputError


@pytest.fixture
def background(root):
    made = Background(root)
    yield made
    made.close()


def wait(root, condition):
    end = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < end
        root.update()
        time.sleep(0.002)


def test_an_answer_comes_in_the_windows_own_thread(root, background):
    heard = []
    background.ask("sum", lambda: sum(range(10)), lambda o: heard.append((o.result, threading.current_thread())))
    wait(root, lambda: heard)
    assert heard == [(45, threading.main_thread())]


def test_only_the_newest_question_is_answered(root, background):
    heard, begun, asked = [], threading.Event(), threading.Event()

    def slow():
        begun.set()
        asked.wait(30)
        return "old"

    background.ask("strain", slow, lambda o: heard.append(o.result))
    begun.wait(30)
    background.ask("strain", lambda: "skipped", lambda o: heard.append(o.result))
    background.ask("strain", lambda: "new", lambda o: heard.append(o.result))
    background.ask("other", lambda: "other", lambda o: heard.append(o.result))
    asked.set()
    wait(root, lambda: len(heard) == 2)
    root.after(100, lambda: heard.append("end"))
    wait(root, lambda: "end" in heard)
    assert heard == ["new", "other", "end"]


def test_a_fault_is_a_sentence(root, background):
    heard = []

    def refuse():
        raise InputError("the path leaves piece P1")

    background.ask("strain", refuse, lambda o: heard.append(o.sentence))
    wait(root, lambda: heard)
    assert heard == ["the path leaves piece P1"]


def test_closed_it_leaves_no_thread_that_holds_the_window(root):
    made, begun = Background(root), threading.Event()

    def slow():
        begun.set()
        time.sleep(0.05)

    made.ask("strain", slow, pytest.fail)
    assert begun.wait(30) and any(t.name == "background" for t in threading.enumerate())
    made.close()
    assert not made._thread.is_alive()
