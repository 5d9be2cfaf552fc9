"""A question is answered by mouse and keys, and never lost."""

import tkinter as tk

import pytest

from gui.dialogs.question import ask
from gui.theme import LIGHT, apply


def answer(root, act, **given):
    """What `ask` gives when `act` is done to its window."""
    seen = {}

    def look():
        window = root.nametowidget("question")
        window.focus_force()
        root.update_idletasks()
        seen.update(x=window.winfo_rootx(), y=window.winfo_rooty(), words=window.nametowidget("body.text").cget("text"))
        act(window)

    apply(root, LIGHT)
    root.update()
    root.after(80, look)
    result = ask(root, "Unsaved", "Save it?", ("Save", "Leave", "Stay"), **given)
    assert root.grab_current() is None and "question" not in root.children
    return result, seen


def test_each_button_gives_its_answer(root):
    for k, words in enumerate(("Save", "Leave", "Stay")):
        got, seen = answer(root, lambda w, k=k: w.nametowidget(f"body.buttons.answer{k}").invoke(), cancel="Stay")
        assert got == words and seen["words"] == "Save it?" and seen["x"] > 100 and seen["y"] > 50


@pytest.mark.parametrize(
    "end", [lambda w: w.event_generate("<Escape>"), lambda w: w.tk.call(*w.tk.splitlist(w.protocol("WM_DELETE_WINDOW")))]
)
def test_escape_and_closing_it_are_the_cautious_answer(root, end):
    assert answer(root, end, cancel="Stay")[0] == "Stay"
    assert answer(root, end)[0] == ""


def test_enter_is_the_usual_answer_and_of_the_button_that_has_the_focus(root):
    def enter(window, name):
        button = window.nametowidget(f"body.buttons.{name}")
        button.focus_force()
        window.update()
        button.event_generate("<Return>")

    assert answer(root, lambda w: enter(w, "answer0"))[0] == "Save"
    assert answer(root, lambda w: enter(w, "answer1"))[0] == "Leave"


def test_it_stays_on_the_screen_over_a_window_at_its_edge(root):
    root.geometry("200x100+0+0")
    _, seen = answer(root, tk.Toplevel.destroy)
    assert seen["x"] >= 0 and seen["y"] >= 0
