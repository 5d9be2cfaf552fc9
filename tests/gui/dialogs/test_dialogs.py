"""Tk's own file dialogs, answered as a person does."""

from pathlib import Path

import pytest

from gui.dialogs.dialogs import Dialogs
from gui.theme import LIGHT, apply


@pytest.fixture
def dialogs(root, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    apply(root, LIGHT)
    root.update()
    return Dialogs(root)


def type_name(root, name, *, window=".__tk_filedialog"):
    """Write a name into the dialog once it is there and press its button; "" cancels."""

    def act():
        if not int(root.tk.call("winfo", "exists", f"{window}.contents.f2.ent")):
            root.after(50, act)
            return
        if not name:
            root.tk.call(f"{window}.contents.f2.cancel", "invoke")
            return
        root.tk.call(f"{window}.contents.f2.ent", "delete", 0, "end")
        root.tk.call(f"{window}.contents.f2.ent", "insert", 0, name)
        root.tk.call(f"{window}.contents.f2.ok", "invoke")

    root.after(100, act)


def test_open_gives_a_path_or_none(root, dialogs, tmp_path):
    (tmp_path / "finger of mine.obj").write_text("v 0 0 0\n")
    type_name(root, "finger of mine.obj")
    assert dialogs.open_path() == tmp_path / "finger of mine.obj"
    type_name(root, "")
    assert dialogs.open_path() is None


def test_save_gives_a_path_with_its_suffix_or_none(root, dialogs, tmp_path):
    type_name(root, "mine")
    assert dialogs.save_path("Save the skin", ".skin", "cup.skin") == tmp_path / "mine.skin"
    type_name(root, "")
    assert dialogs.save_path("Save the skin", ".skin", "cup.skin") is None


def test_a_folder_is_chosen_or_not(root, dialogs, monkeypatch):
    from gui.dialogs import dialogs as module

    for given, got in (("/somewhere", Path("/somewhere")), ("", None), ((), None)):
        monkeypatch.setattr(module.filedialog, "askdirectory", lambda given=given, **options: given)
        assert dialogs.folder("Where to") == got


def test_a_question_is_asked_over_the_window(root, dialogs):
    root.after(80, lambda: root.nametowidget("question.body.buttons.answer1").invoke())
    assert dialogs.ask("Title", "Which?", ("One", "Two")) == "Two"
