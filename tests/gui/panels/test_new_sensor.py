"""The next sensor's pattern is seen before it is placed."""

from dataclasses import replace

import pytest

from gui.panels.new_sensor import NewSensorPanel
from gui.state.profiles import ProfileShelf
from gui.theme import DARK, LIGHT, apply
from skinfab.drawings.catalogue import catalogue
from skinfab.errors import SkinfabError


@pytest.fixture
def panel(root, session):
    apply(root, LIGHT)
    said, placed = [], []
    made = NewSensorPanel(root, session, ProfileShelf(), LIGHT, complain=said.append, place=lambda: placed.append(True))
    made.pack(fill="x")
    made.said, made.placed = said, placed
    root.update()
    return made


def choose(root, panel, kind):
    panel.kind.set(kind)
    panel.nametowidget("row.kind").event_generate("<<ComboboxSelected>>")
    root.update()


def type_into(root, panel, name, text):
    entry = panel.nametowidget(f"fields.{name}.entry")
    entry.focus_force()
    root.update()
    entry.delete(0, "end")
    entry.insert(0, text)
    entry.event_generate("<Return>")
    root.update()


def drawn(panel):
    return [panel.picture.coords(i) for i in panel.picture.find_all() if panel.picture.type(i) == "line"]


@pytest.mark.parametrize("kind", [entry.kind for entry in catalogue()])
def test_each_pattern_has_its_picture_inside_its_frame_and_its_fields(root, panel, kind):
    choose(root, panel, kind)
    (line,) = drawn(panel)
    width, height = panel.picture.winfo_width(), panel.picture.winfo_height()
    assert min(line[::2]) >= 0 and max(line[::2]) <= width and min(line[1::2]) >= 0 and max(line[1::2]) <= height
    entry = next(e for e in catalogue() if e.kind == kind)
    assert set(panel.nametowidget("fields").children) == set(entry.least) and panel.pattern().kind == kind


def test_a_parameter_changes_the_pattern_and_each_kind_keeps_its_own(root, panel):
    choose(root, panel, "contact-spiral")
    before = drawn(panel)
    type_into(root, panel, "s", "31,5")
    assert panel.pattern().s == 31.5 and drawn(panel) != before
    others = [e.kind for e in catalogue() if e.kind != "contact-spiral"]
    choose(root, panel, others[0])
    choose(root, panel, "contact-spiral")
    assert panel.pattern().s == 31.5 and panel.nametowidget("fields.s.entry").get() == "31.5"


@pytest.mark.parametrize("text", ["0", "-3", "wide", "1e999", "nan", "1e12"])
def test_what_cannot_be_is_said_and_the_pattern_stays(root, panel, text):
    choose(root, panel, "contact-spiral")
    before = panel.pattern()
    type_into(root, panel, "s", text)
    assert panel.said[-1] and "\n" not in panel.said[-1] and panel.pattern() == before


def test_the_documents_material_sets_bead_and_gap(root, panel, session):
    choose(root, panel, "contact-spiral")
    material = ProfileShelf().of(session.skin).material
    assert panel.pattern().bead == material.ink.bead_width and panel.pattern().gap == material.gap


def test_another_material_is_drawn_at_once_and_a_missing_one_said(root, panel, session):
    choose(root, panel, "contact-spiral")
    session.do("missing", replace(session.skin, material="no-such-ink"))
    root.update()
    words = [panel.picture.itemcget(i, "text") for i in panel.picture.find_all() if panel.picture.type(i) == "text"]
    assert drawn(panel) == [] and "no-such-ink" in words[0]
    with pytest.raises(SkinfabError, match="no-such-ink"):
        panel.pattern()
    session.undo()
    root.update()
    assert len(drawn(panel)) == 1


def test_its_button_takes_up_the_tool_and_dark_is_dark(root, panel):
    panel.nametowidget("row.place").invoke()
    assert panel.placed == [True]
    panel.restyle(DARK)
    assert panel.picture.cget("background") == DARK.view
    (line,) = [i for i in panel.picture.find_all() if panel.picture.type(i) == "line"]
    assert panel.picture.itemcget(line, "fill") == DARK.ink
