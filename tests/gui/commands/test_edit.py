"""Undo, redo, and what is done to selected sensors, in the conftest's plate of two pieces."""

import math

import pytest

from gui.state.selection import Target


@pytest.fixture
def plate(person, skin):
    person.session.open(skin, None)
    person.wait()
    return person


def ids(person):
    return [s.id for s in person.skin.sensors]


def test_delete_undo_redo_by_keys(plate):
    plate.session.select(Target(piece="P1", sensor="C2"))
    plate.view3d.canvas.focus_force()
    plate.press("Delete")
    assert ids(plate) == ["C1"] and plate.session.selected.sensor == ""
    plate.press("Control-z")
    assert ids(plate) == ["C1", "C2"] and plate.app.status.text.get() == "Undone: delete C2."
    plate.press("Control-y")
    assert ids(plate) == ["C1"] and plate.app.status.text.get() == "Done again: delete C2."
    plate.press("Control-y")
    assert ids(plate) == ["C1"]


def test_all_that_is_selected_goes_as_one_step(plate):
    before = plate.skin
    plate.session.select(Target(piece="P1", sensor="C1", also=("C2",)))
    plate.app.actions.do("delete")
    assert ids(plate) == [] and plate.session.undo_label == "delete 2 sensors"
    plate.app.actions.do("undo")
    assert plate.skin is before


def test_turning_by_keys_goes_round(plate):
    plate.session.select(Target(piece="P1", sensor="C1"))
    plate.view3d.canvas.focus_force()
    for _ in range(3):
        plate.press("Control-r")
    plate.press("Control-Shift-R")
    assert plate.skin.sensors[0].angle == pytest.approx(math.radians(30)) and plate.session.undo_label == "turn C1"
    assert plate.skin.sensors[1].angle == 0


def test_with_nothing_selected_there_is_nothing_to_do(plate):
    assert not plate.app.actions.do("delete") and not plate.app.actions.do("turn_left")
    plate.session.select(Target(piece="P1", sensor="C1"))
    plate.press("Control-Shift-A")
    assert not plate.session.selected and not plate.app.actions.do("delete")


def test_delete_in_a_field_takes_a_letter_not_a_sensor(plate):
    plate.session.select(Target(piece="P1", sensor="C1"))
    plate.app.root.update()
    entry = next(w for w in walk(plate.app.root) if str(w).endswith("place.x.entry"))
    entry.focus_force()
    plate.app.root.update()
    entry.icursor(0)
    text = entry.get()
    plate.press("Delete")
    assert ids(plate) == ["C1", "C2"] and entry.get() == text[1:]
    plate.press("Escape")


def walk(widget):
    yield widget
    for child in widget.winfo_children():
        yield from walk(child)
