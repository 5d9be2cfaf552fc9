"""A number is asked for, and only one that may be is taken."""

import pytest

from gui.dialogs.dialogs import Dialogs
from gui.theme import DARK, apply


def answer(root, *acts):
    """What is given when these are done to the dialog, one after the other."""
    apply(root, DARK)
    root.update()

    def act():
        window = root.nametowidget("number")
        window.focus_force()
        window.update_idletasks()
        for each in acts:
            each(window)

    root.after(60, act)
    given = Dialogs(root).number("Cones", "How many cones?", least=2, most=200, value=3)
    assert root.grab_current() is None and "number" not in root.children
    return given


def typed(text):
    def write(window):
        field = window.nametowidget("body.field")
        field.delete(0, "end")
        field.insert(0, text)

    return write


def press(widget, key):
    return lambda window: (window.nametowidget(widget).focus_force(), window.nametowidget(widget).event_generate(key))


def click(name):
    return lambda window: window.nametowidget(f"body.buttons.{name}").invoke()


def test_what_stands_there_or_is_typed_is_given(root):
    assert answer(root, click("ok")) == 3
    assert answer(root, typed(" 8 "), press("body.field", "<Return>")) == 8
    assert answer(root, press("body.buttons.ok", "<Return>")) == 3


@pytest.mark.parametrize("end", [click("cancel"), press("body.field", "<Escape>"), lambda window: window.destroy()])
def test_it_may_be_left_unanswered(root, end):
    assert answer(root, typed("8"), end) is None


def test_what_may_not_be_is_said_and_asked_again(root):
    said = []
    acts = []
    for text in ("1", "201", "-5", "3.5", "", "many"):
        acts += [typed(text), click("ok"), lambda window: said.append(window.nametowidget("body.wrong").cget("text"))]
    assert answer(root, *acts, typed("200"), click("ok")) == 200
    assert said == ["a whole number from 2 to 200, please"] * 6
