"""The whole window: what goes wrong in it is a sentence, and it lives on."""

import gc
import json
import subprocess
import sys
import time
import tkinter as tk
from dataclasses import replace
from tkinter import ttk

import numpy as np
import pytest
from person import MESHES, Answers, Person

from gui.app import App
from gui.theme import DARK, LIGHT


@pytest.fixture
def start(display, quick_workers, tmp_path, monkeypatch):
    """Opens windows that share one state folder, one after the other."""
    monkeypatch.setenv("SKINFAB_STATE", str(tmp_path / "state"))
    opened = []

    def open_window(path=None, **give):
        answers = Answers(give={"Unsaved work": "Do not save"} | {title.replace("_", " "): answer for title, answer in give.items()})
        app = App(tk.Tk(), path, dialogs=answers)
        opened.append(app)
        person = Person(app, answers)
        person.wait(lambda: app.view2d.winfo_width() > 1)
        return person

    open_window.workers = lambda: [p for app in opened for p in workers_of(app.runner) if p.is_alive()]
    yield open_window
    for app in opened:
        app.abandon()
    gc.collect()


def workers_of(runner):
    """Not those of the file's other window, which starts its spare one while any window is attended to."""
    helpers = [runner._helper, *([runner._spare] if runner._spare is not None else [])]
    return [*(helper.process for helper in helpers), *(process for process, _ in runner._retired)]


def menu_of(person, name):
    bar = person.app.root.nametowidget("menu")
    return next(bar.nametowidget(bar.entrycget(k, "menu")) for k in range(bar.index("end") + 1) if bar.entrycget(k, "label") == name)


def test_every_action_is_in_a_menu_under_its_own_words(person):
    app = person.app
    for action in app.actions.all:
        menu = menu_of(person, action.menu)
        labels = [menu.entrycget(k, "label") for k in range(menu.index("end") + 1)]
        assert labels.count(action.label) == 1, action.id
        assert action.id.isidentifier()


def test_menus_and_keys_do_the_same(person, monkeypatch):
    """Each by the menu's own command and by the real key, with what it does replaced by a mark."""
    person.open(MESHES / "cube.obj")
    done, actions = [], person.app.actions
    for action in actions.all:
        monkeypatch.setitem(action.__dict__, "enabled", lambda: True)
        monkeypatch.setitem(action.__dict__, "run", lambda id=action.id: done.append(id))
    person.view3d.canvas.focus_force()
    person.app.root.update()
    with_key = [a for a in actions.all if a.key]
    for action in with_key:
        person.press(action.key)
    assert done == [a.id for a in with_key]
    assert len({a.key.lower() if "Shift" not in a.key else a.key for a in with_key}) == len(with_key)


def test_what_cannot_be_done_is_grey_and_does_nothing(start):
    person = start()
    actions = person.app.actions
    person.wait()
    assert [a.id for a in actions.all if a.id in ("save", "save_as", "auto_cut", "auto_place", "undo", "cut") and a.enabled()] == []
    bar = person.app.root.nametowidget("toolbar")
    assert bar.nametowidget("save").instate(["disabled"]) and bar.nametowidget("open").instate(["!disabled"])
    menu = menu_of(person, "File")
    actions.refresh()
    assert {menu.entrycget(k, "label"): menu.entrycget(k, "state") for k in (0, 2)} == {"Open …": "normal", "Save": "disabled"}
    person.press("Control-s")
    person.press("F5")
    assert person.answers.asked == [] and person.app.runner.job is None


def test_a_callback_that_raises_is_a_sentence_and_the_window_lives(start, tmp_path):
    person = start()

    def burst():
        raise ZeroDivisionError("nought")

    person.app.root.after(0, burst)
    person.wait(lambda: person.session.problems)
    (text,) = person.problems()
    assert text.startswith("unexpected ZeroDivisionError: nought") and "gui.log" in text and "Traceback" not in text
    assert "in burst" in (tmp_path / "state" / "gui.log").read_text()
    person.open(MESHES / "cube.obj")
    assert person.skin is not None and person.problems() == []


def test_one_broken_listener_keeps_no_other_from_the_news(start):
    person = start()
    person.session.listen("problems", lambda: 1 / 0)
    person.session.listen("skin", lambda: 1 / 0)
    person.open(MESHES / "cube.obj")
    person.app.root.update()
    assert person.view3d.hit_at(*person.see_face(3)).face == 3
    assert "ZeroDivisionError" in (person.app.desk.state / "gui.log").read_text()
    person.press("Control-Key-1")
    person.press("Control-d")
    assert person.app.theme is DARK


def test_light_and_dark_change_everything_and_are_remembered(start):
    person = start()
    person.open(MESHES / "cube.obj")
    app = person.app

    def colours():
        style = ttk.Style(app.root)
        menu = menu_of(person, "File")
        person.view3d.settle()
        return {
            "panel": style.lookup("TFrame", "background"),
            "text": style.lookup("TLabel", "foreground"),
            "list": style.lookup("Treeview", "fieldbackground"),
            "menu": str(menu.cget("background")),
            "view3d": person.view3d.canvas.cget("background"),
            "view2d": tuple(person.view2d.surface.picture[60, 60, :3].tolist()),
            "picture": app.new_sensor.picture.cget("background"),
            "errors": str(app.problems.list.tag_configure("error", "foreground")),
            "window": app.root.cget("background"),
        }

    person.wait()
    light = colours()
    assert light["view3d"] == LIGHT.view and light["panel"] == LIGHT.panel
    app.actions.do("dark")
    person.wait()
    dark = colours()
    assert {k for k in light if light[k] == dark[k]} == set()
    assert dark["view3d"] == DARK.view and dark["errors"] == DARK.error
    app.close()
    assert start().app.theme is DARK


def test_no_line_of_the_window_is_cut_off_at_1280_by_800(start):
    person = start(MESHES / "cube.obj")
    person.wait(lambda: person.skin is not None and person.app.runner.job is None)
    root = person.app.root
    root.geometry("1280x760+0+0")
    root.update()
    for name in ("toolbar", "statusbar", "body"):
        part = root.nametowidget(name)
        assert part.winfo_rootx() >= 0 and part.winfo_rooty() + part.winfo_height() <= root.winfo_rooty() + root.winfo_height(), name
    bar = root.nametowidget("toolbar")
    right = max(child.winfo_x() + child.winfo_width() for child in bar.winfo_children())
    assert bar.winfo_reqwidth() <= 1280 and right <= 1280


@pytest.mark.parametrize("geometry", ["large", "1280x760+9000+20", "", "0x0"])
def test_a_remembered_size_that_suits_no_screen_is_let_go(start, tmp_path, geometry):
    (tmp_path / "state").mkdir()
    (tmp_path / "state" / "gui.json").write_text(json.dumps({"geometry": geometry, "theme": "dark", "recent": []}))
    person = start()
    root = person.app.root
    assert 0 <= root.winfo_rootx() < 1280 and root.winfo_width() >= 960 and person.app.theme is DARK


def test_closed_during_a_job_no_process_is_left(start):
    person = start()
    person.open(MESHES / "robot_finger.obj")
    person.press("F5")
    assert person.app.runner.job is not None
    for _ in range(20):
        person.app.root.update()
        time.sleep(0.005)
    began = time.monotonic()
    person.app.close()
    assert start.workers() == []
    assert time.monotonic() - began < 3


def test_closed_during_an_export_it_asks(start, tmp_path):
    person = start()
    person.open(MESHES / "cube.obj")
    person.press("F5")
    person.wait()
    person.answers.path = tmp_path / "out"
    person.app.actions.do("export_everything")
    person.wait(lambda: (tmp_path / "out").exists())
    person.app.close()
    assert person.answers.asked[-1] == (
        "An export is running: Exporting everything is still going on. If it is stopped, nothing of it is written."
    )
    assert not person.app._closed and person.app.runner.job is not None, "by itself it waits"
    person.answers.give["An export is running"] = "Stop it and close"
    person.app.close()
    assert person.app._closed and start.workers() == [] and not (tmp_path / "out").exists()


def test_closed_under_a_question_it_ends(start):
    """The mesh dialog waits for its answer in a loop of its own: closing the window ends that too."""
    person = start()
    person.answers.choice = lambda facts: person.app.close()
    person.app.files.open_path(MESHES / "cube.obj")
    end = time.monotonic() + 30
    while not person.app._closed:
        assert time.monotonic() < end
        person.app.root.update()
        time.sleep(0.005)
    assert start.workers() == [] and not (person.app.desk.state / "gui.log").exists()


def test_a_window_that_is_closed_at_once_leaves_nothing_behind(start, capfd):
    person = start()
    person.app.close()
    assert capfd.readouterr().err == ""


def test_an_interrupt_ends_it_without_a_question_and_keeps_the_work(start):
    person = start()
    person.open(MESHES / "cube.obj")
    person.session.do("another seed", replace(person.skin, seed=5))

    def interrupt():
        raise KeyboardInterrupt

    person.app.root.after(0, interrupt)
    end = time.monotonic() + 30
    while not person.app.interrupted:
        assert time.monotonic() < end
        person.app.root.update()
        time.sleep(0.005)
    assert person.app.interrupted and start.workers() == [] and person.answers.asked == ["how_to_open cube.obj"]
    copies = list((person.app.desk.state / "autosave").glob("*.skin"))
    assert len(copies) == 1


def test_work_that_is_stopped_is_gone_within_half_a_second_and_can_be_asked_for_again(start):
    person = start()
    person.open(MESHES / "robot_finger.obj")
    person.press("F5")
    bar = person.app.root.nametowidget("statusbar.work")
    person.wait(lambda: bar.winfo_ismapped())
    end = time.monotonic() + 0.3
    while time.monotonic() < end:
        person.app.root.update()
        time.sleep(0.005)
    began = time.monotonic()
    bar.nametowidget("cancel").invoke()
    person.app.root.update()
    assert time.monotonic() - began < 0.5 and person.app.runner.job is None and not bar.winfo_ismapped()
    assert person.session.undo_label is None and "Stopped" in person.app.status.text.get()
    person.open(MESHES / "cube.obj")
    person.press("F5")
    person.wait()
    assert len(person.skin.pieces) >= 1 and np.all(person.app.derived.piece_of_face(person.skin) >= 0)


def test_the_window_answers_while_work_goes_on(start):
    person = start()
    person.open(MESHES / "robot_finger.obj")
    person.press("F5")
    waits, camera = [], person.view3d.camera
    while person.app.runner.job is not None and len(waits) < 60:
        began = time.monotonic()
        person.view3d.canvas.focus_force()
        person.view3d.canvas.event_generate("<Left>")
        person.app.root.update()
        waits.append(time.monotonic() - began)
        time.sleep(0.01)
    assert len(waits) > 5 and person.view3d.camera is not camera
    assert sorted(waits)[len(waits) // 2] < 0.1
    person.wait()


@pytest.fixture
def crashed(start):
    """A run that ended with unsaved work on the cube, of a process that is gone; its folder of copies."""
    person = start()
    person.open(MESHES / "cube.obj")
    person.session.do("another seed", replace(person.skin, seed=42))
    person.app.abandon()
    folder = person.app.desk.state / "autosave"
    for file in list(folder.iterdir()):
        file.rename(folder / f"999999999-{file.name.split('-')[1]}")
    assert len(list(folder.glob("*.skin"))) == 1
    return folder


def test_what_a_crash_has_left_is_offered_and_opened_as_unsaved(start, crashed):
    person = start(MESHES / "dodecahedron.obj", Unsaved_work_was_kept="Open the copy")
    person.wait(lambda: person.skin is not None and person.app.runner.job is None)
    assert "the skin of cube.obj, which had no file yet" in person.answers.asked[0]
    assert person.skin.seed == 42 and person.session.dirty and person.session.path is None
    assert person.app.autosave.settle() and not list(crashed.glob("999999999-*"))
    assert len(list(crashed.glob("*.skin"))) == 1, "what is still unsaved is still kept"


def test_it_can_wait_or_be_thrown_away(start, crashed):
    for answer, left in (("Later", 1), ("Throw it away", 0)):
        person = start(MESHES / "dodecahedron.obj", Unsaved_work_was_kept=answer)
        person.wait(lambda person=person: person.skin is not None)
        assert person.skin.source.file == "dodecahedron.obj" and len(list(crashed.glob("*.skin"))) == left
        person.app.close()
    person = start(MESHES / "cube.obj")
    person.wait(lambda: person.skin is not None)
    assert person.answers.asked == ["how_to_open cube.obj"]


def test_a_damaged_copy_is_a_sentence(start, crashed):
    (copy,) = crashed.glob("*.skin")
    copy.write_bytes(b"PK")
    person = start(Unsaved_work_was_kept="Open the copy")
    person.wait(lambda: person.session.problems)
    assert "not a whole skin document" in person.problems()[0] and person.skin is None and copy.exists()


def test_the_first_window_waits_for_nothing_that_it_does_not_show():
    slow = ("scipy.signal", "scipy.stats", "matplotlib.pyplot", "pandas")
    code = f"import sys, gui.app; print([name for name in {slow!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=MESHES.parent, check=True)
    assert done.stdout == "[]\n"
