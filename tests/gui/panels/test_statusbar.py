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


def test_it_is_as_high_with_work_as_without(root, session):
    bar = StatusBar(root, session, cancel=lambda: None, describe=str)
    bar.pack(fill="x")
    root.update()
    idle = bar.winfo_height()
    bar.progress(Step(0.25, "cutting"))
    root.update()
    assert bar.nametowidget("work").winfo_ismapped() and bar.winfo_height() == idle


def test_what_was_said_before_work_that_is_asked_for_is_no_longer_shown(root, session):
    bar = StatusBar(root, session, cancel=lambda: None, describe=lambda: "over P1")
    bar.say("cannot write out/P1.gcode")
    bar.progress(Step(0.0, "flattening"))
    assert bar.text.get() == "cannot write out/P1.gcode", "nobody has asked for that"
    bar.progress(None)
    bar.progress(Step(0.0, "exporting"), asked=True)
    assert bar.text.get() == "over P1"
    bar.say("in between")
    bar.progress(Step(0.5, "exporting"), asked=True)
    assert bar.text.get() == "in between"
