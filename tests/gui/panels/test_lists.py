"""The lists of pieces and sensors follow the document and the selection, both ways."""

import time
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
    for shown, height in ((low, 60), (high, 300), (low, 60)):
        forms.select(shown)
        end = time.monotonic() + 30
        while shown.winfo_height() != height:
            assert time.monotonic() < end
            root.update()
            time.sleep(0.005)
        heights.append(forms.winfo_height())
    assert heights[0] == heights[2] == heights[1] - 240


def test_sizes_of_large_pieces_are_not_cut_off(root, session, pieces):
    large = [replace(p, UV=p.UV * (12.24, 9.28)) for p in session.skin.pieces]
    session.do("large", replace(session.skin, pieces=tuple(large), sensors=()))
    assert pieces.list.set("P1", "size") == "1224 x 928"
    letters = font.nametofont("TkDefaultFont", root=root)
    for column in pieces.list["columns"]:  # the distortion is immense too
        assert pieces.list.column(column, "minwidth") >= letters.measure(pieces.list.set("P1", column)) + 8
    assert float(pieces.list.set("P1", "mean")) > 100
    # The side panel is 320 wide, with 4 left free at either side, and the scroll bar.
    bar = next(w for w in pieces.list.master.winfo_children() if isinstance(w, ttk.Scrollbar))
    assert sum(pieces.list.column(c, "minwidth") for c in pieces.list["columns"]) <= 312 - bar.winfo_reqwidth()


def test_the_piece_of_a_sensor_that_was_dragged_to_another_is_shown(root, session, pieces):
    session.select(Target(piece="P1", sensor="C1"))
    moved = tuple(replace(s, piece="P2") if s.id == "C1" else s for s in session.skin.sensors)
    session.do("move C1", replace(session.skin, sensors=moved))
    root.update()
    assert pieces.list.selection() == ("P2",) and session.selected.sensor == "C1"
    session.undo()
    root.update()
    assert pieces.list.selection() == ("P1",) and session.selected.sensor == "C1"


def test_the_selected_row_is_seen_when_the_list_gets_less_room(root, session):
    made = tuple(replace(session.skin.sensors[0], id=f"C{k}", channel=k) for k in range(1, 13))
    session.do("many", replace(session.skin, sensors=made))
    box = ttk.Frame(root, width=320, height=400)
    box.pack_propagate(False)
    box.pack()
    panel = SensorsPanel(box, session, ProfileShelf())
    panel.pack(fill="both", expand=True)
    root.update()
    session.select(Target(piece="P1", sensor="C12"))
    root.update()
    assert panel.list.bbox("C12")
    box.configure(height=140)
    root.update()
    assert panel.list.bbox("C12") and not panel.list.bbox("C1")
