"""A signal ends the window whatever it asks just then."""

import os
import signal
import time

import pytest

from gui import ending
from gui.dialogs.dialogs import Dialogs
from gui.ending import heeding_signals
from gui.jobs.tasks import MeshFacts
from gui.theme import LIGHT, apply

FACTS = MeshFacts("cup.stl", "12 triangles", 40.0, "mm", "a guess", False, (), (), ("fills a hole",), False)

#: Everything that can be asked, and what no answer is.
QUESTIONS = {
    "a question": (lambda d: d.ask("Unsaved", "Save it?", ("Save", "Do not", "Stay"), cancel="Stay"), "Stay"),
    "a number": (lambda d: d.number("How many", "Pieces?", least=1, most=9, value=2), None),
    "a mesh": (lambda d: d.how_to_open(FACTS), None),
    "a file": (lambda d: d.open_path(), None),
    "a folder": (lambda d: d.folder("Where to"), None),
    "a new file": (lambda d: d.save_path("Save", ".skin", "mine.skin"), None),
}


def interrupt(number, frame):
    raise KeyboardInterrupt


@pytest.fixture
def window(root, monkeypatch, tmp_path):
    """A window in a program that raises what ends it, as the commands do."""
    (tmp_path / "mine.skin").write_text("")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ending, "_LOOK_MS", 10)
    apply(root, LIGHT)
    root.update()
    before = signal.signal(signal.SIGTERM, interrupt)
    yield root
    signal.signal(signal.SIGTERM, before)


def test_whatever_is_asked_is_closed_as_by_cancel_before_it_ends(window):
    got, ended = [], []

    def one_after_another():
        for question, _ in QUESTIONS.values():
            got.append(question(Dialogs(window)))

    def terminate():
        os.kill(os.getpid(), signal.SIGTERM)

    def end():
        ended.append(list(got))
        window.quit()

    window.after(0, one_after_another)
    window.after(100, terminate)
    with pytest.raises(KeyboardInterrupt), heeding_signals(window, end):
        window.mainloop()
    assert ended == [[none for _, none in QUESTIONS.values()]]
    assert window.grab_current() is None
    assert signal.getsignal(signal.SIGTERM) is interrupt


def test_a_question_about_what_would_be_overwritten_is_closed_too(window):
    got = []

    def overwrite():
        window.tk.call(".__tk_filedialog.contents.f2.ok", "invoke")

    def seen():
        if int(window.tk.call("winfo", "exists", ".__tk_filedialog.__tk__messagebox")):
            os.kill(os.getpid(), signal.SIGTERM)
        else:
            window.after(10, seen)

    window.after(0, lambda: got.append(Dialogs(window).save_path("Save", ".skin", "mine.skin")))
    window.after(100, overwrite)
    window.after(120, seen)
    with pytest.raises(KeyboardInterrupt), heeding_signals(window, window.quit):
        window.mainloop()
    assert got == [None]


def test_a_loop_that_stands_still_is_interrupted_by_the_second(window, monkeypatch):
    monkeypatch.setattr(ending, "STUCK_S", 0.02)
    reached = []

    def stand_still():
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGTERM)
            reached.append(time.sleep(0.05))

    with pytest.raises(KeyboardInterrupt), heeding_signals(window, window.quit):
        stand_still()
    assert len(reached) == 1


def test_what_was_ignored_stays_so(window):
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with heeding_signals(window, window.quit):
            assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN and signal.getsignal(signal.SIGTERM) is not interrupt
            os.kill(os.getpid(), signal.SIGHUP)
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)
