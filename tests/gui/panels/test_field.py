"""A field takes good values, keeps bad ones in sight and says why."""

import tkinter as tk

import pytest

from gui.panels.field import Field, focused, number, select_all_by_key
from skinfab.errors import InputError


@pytest.fixture
def field(root):
    taken, said = [], []

    def take(text):
        taken.append(number(text, "x"))

    made = Field(root, "x", unit="mm", take=take, complain=said.append, name="x", tip="where it lies")
    made.pack()
    made.show("5")
    made.taken, made.said = taken, said
    made.entry.focus_force()
    root.update()
    return made


def write(root, field, text, key):
    field.entry.delete(0, "end")
    field.entry.insert(0, text)
    field.entry.event_generate(key)
    root.update()


def test_enter_takes_the_value_once(root, field):
    write(root, field, "12,5", "<Return>")
    field.entry.event_generate("<FocusOut>")
    root.update()
    assert field.taken == [12.5] and field.entry.get() == "12,5"


def test_what_is_no_number_stays_and_is_said(root, field):
    write(root, field, "twelve", "<Return>")
    assert field.said[-1] == "x is 'twelve'; it must be a number" and field.entry.instate(["invalid"])
    write(root, field, "twelve", "<Escape>")
    assert field.entry.get() == "5" and not field.entry.instate(["invalid"]) and field.taken == []


def test_a_new_value_does_not_overwrite_what_is_being_typed(root, field):
    field.entry.insert("end", "1")
    field.show("7")
    assert field.entry.get() == "51"
    write(root, field, "51", "<Escape>")
    field.show("7")
    assert field.entry.get() == "7"


@pytest.mark.parametrize("text", ["", "nan", "inf", "1e999", "0x10"])
def test_only_finite_numbers_are_numbers(text):
    with pytest.raises(InputError, match="must be a number"):
        number(text, "y")


def test_ctrl_a_selects_all_of_any_entry(root, field):
    select_all_by_key(root)
    plain = tk.Entry(root)
    plain.insert(0, "old one")
    plain.pack()
    for entry in (field.entry, plain):
        entry.focus_force()
        root.update()
        entry.event_generate("<Control-a>")
        assert entry.selection_get() == entry.get()


def test_what_has_the_focus_is_found_and_taken(root, field):
    assert focused(root) is field and not field.pending
    field.entry.insert("end", "1")
    assert field.pending and field.commit() and field.taken == [51.0] and not field.pending
    field.entry.insert("end", "x")
    assert not field.commit() and field.pending
    field.revert()
    assert field.entry.get() == "51"


def test_all_is_selected_in_entries_of_tks_own_dialogs_too(root):
    """They are made by Tcl, and Python knows them by their names alone."""
    select_all_by_key(root)
    root.tk.eval("ttk::entry .theirs; pack .theirs; .theirs insert 0 old.skin; focus -force .theirs")
    root.update()
    root.tk.eval("event generate .theirs <Control-a>")
    root.update()
    assert root.tk.eval(".theirs index sel.first") == "0" and root.tk.eval(".theirs index sel.last") == "8"
