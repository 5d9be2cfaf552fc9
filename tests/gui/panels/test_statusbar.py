"""Hints, what is under the pointer, and how far work is."""

from gui.jobs.worker import Step
from gui.panels.statusbar import StatusBar
from gui.state.selection import Target


def test_hints_come_before_what_is_pointed_at(root, session):
    bar = StatusBar(root, session, cancel=lambda: None, describe=lambda: f"over {session.hovered.piece}")
    bar.tip("Save (Ctrl+S)")
    session.hover(Target(piece="P1"))
    assert bar.text.get() == "Save (Ctrl+S)"
    bar.tip("")
    assert bar.text.get() == "over P1"


def test_work_shows_its_progress_and_can_be_cancelled(root, session):
    cancelled = []
    bar = StatusBar(root, session, cancel=lambda: cancelled.append(True), describe=str)
    bar.pack()
    work = bar.nametowidget("work")
    assert not work.winfo_manager()
    bar.progress(Step(0.25, "cutting"))
    root.update()
    assert work.winfo_ismapped() and bar.progress_text.get() == "cutting" and bar.nametowidget("work.bar")["value"] == 0.25
    bar.nametowidget("work.cancel").invoke()
    bar.progress(None)
    assert cancelled == [True] and not work.winfo_manager()


def test_an_estimate_is_given_once_there_is_one(root, session, monkeypatch):
    now = [100.0]
    monkeypatch.setattr("gui.panels.statusbar.time.monotonic", lambda: now[0])
    bar = StatusBar(root, session, cancel=lambda: None, describe=str)
    bar.progress(Step(0.0, "cutting"))
    now[0] = 110.0
    bar.progress(Step(0.01, "cutting"))
    assert bar.progress_text.get() == "cutting"
    bar.progress(Step(0.5, "cutting"))
    assert bar.progress_text.get() == "cutting, 10 s left"
    now[0] = 500.0
    bar.progress(Step(0.5, "cutting"))
    assert bar.progress_text.get() == "cutting, 7 min left"
