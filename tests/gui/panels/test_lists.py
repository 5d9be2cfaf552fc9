"""The lists of pieces and sensors follow the document and the selection, both ways."""

from dataclasses import replace
from tkinter import font, ttk

import pytest

from gui.panels.forms import Forms
from gui.panels.pieces import PiecesPanel
from gui.panels.sensors import SensorsPanel
from gui.state.derived import Derived
from gui.state.profiles import ProfileShelf
from gui.state.selection import NOTHING, Target
from gui.state.session import Session


@pytest.fixture
def pieces(root, session):
    panel = PiecesPanel(root, session, Derived())
    panel.pack()
    return panel


@pytest.fixture
def sensors(root, session):
    panel = SensorsPanel(root, session, ProfileShelf())
    panel.pack()
    return panel


def test_pieces_with_size_and_distortion(pieces):
    assert [pieces.list.item(k, "values") for k in ("P1", "P2")] == [
        ("P1", "100 x 100", "4.000", "4.00", "4.00"),
        ("P2", "100 x 100", "4.000", "4.00", "4.00"),
    ]
    assert pieces.summary.get() == "4 triangles, 2 pieces"


def test_what_does_not_lie_flat_is_counted(root, session, pieces):
    session.do("cut", replace(session.skin, pieces=session.skin.pieces[:1], sensors=()))
    assert pieces.summary.get() == "4 triangles, 1 piece; 2 triangles do not lie flat yet"


def test_a_click_selects_and_the_selection_is_shown(root, session, pieces, sensors):
    pieces.list.selection_set("P2")
    root.update()
    assert session.selected == Target(piece="P2")
    sensors.list.selection_set("C2")
    root.update()
    assert session.selected == Target(piece="P1", sensor="C2") and pieces.list.selection() == ("P1",)
    session.select(NOTHING)
    root.update()
    assert pieces.list.selection() == () == sensors.list.selection() and session.selected == NOTHING


def test_sensors_with_the_resistance_to_expect(session, sensors):
    id, kind, piece, channel, r = sensors.list.item("C1", "values")
    assert (id, kind, piece, channel) == ("C1", "contact-spiral", "P1", "0")
    low, high = map(int, r.split(" to "))
    assert 0 < low < high


def test_a_missing_profile_hides_the_resistance_only(session, sensors):
    session.do("other material", replace(session.skin, material="/nowhere/mine.toml"))
    assert sensors.list.item("C1", "values")[4] == ""


def test_nothing_is_open(root):
    assert PiecesPanel(root, Session(), Derived()).summary.get() == "Nothing is open."


def test_every_heading_has_room_for_its_words(root, pieces, sensors):
    heading = font.nametofont("TkHeadingFont", root=root)
    for panel in (pieces, sensors):
        for column in panel.list["columns"]:
            assert panel.list.column(column, "minwidth") >= heading.measure(panel.list.heading(column, "text")) + 8


def test_forms_are_as_high_as_the_one_that_is_shown(root, session):
    forms = Forms(root, session)
    low, high = ttk.Frame(forms, height=60, width=50), ttk.Frame(forms, height=300, width=50)
    forms.add(low, text="low")
    forms.add(high, text="high")
    forms.pack()
    heights = []
    for shown in (low, high, low):
        forms.select(shown)
        root.after(50, lambda: root.setvar("shown", "1"))
        root.wait_variable("shown")
        heights.append(forms.winfo_height())
    assert heights[0] == heights[2] == heights[1] - 240
