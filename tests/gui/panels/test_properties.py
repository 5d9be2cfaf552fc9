"""What is selected can be read and typed."""

import math
import time

import pytest

from gui.jobs.background import Background
from gui.panels.properties import PropertiesPanel
from gui.state.derived import Derived
from gui.state.profiles import ProfileShelf
from gui.state.selection import NOTHING, Target


@pytest.fixture
def panel(root, session):
    background, said = Background(root), []
    thick = []
    made = PropertiesPanel(root, session, Derived(), ProfileShelf(), background, complain=said.append, make_thick=thick.append)
    made.thick = thick
    made.pack()
    made.said = said
    root.update()
    yield made
    background.close()


def type_into(root, panel, path, text):
    entry = panel.nametowidget(f"{path}.entry")
    entry.focus_force()
    root.update()
    entry.delete(0, "end")
    entry.insert(0, text)
    entry.event_generate("<Return>")
    root.update()


def sensor(session, id="C1"):
    return next(s for s in session.skin.sensors if s.id == id)


def test_a_sensor_is_moved_turned_and_wired_by_typing(root, session, panel):
    session.select(Target(piece="P1", sensor="C1"))
    assert panel.title.get() == "C1: contact-spiral on P1"
    type_into(root, panel, "sensor.place.x", "44,5")
    assert (sensor(session).x, sensor(session).y) == (44.5, 30.0) and session.undo_label == "move C1"
    type_into(root, panel, "sensor.place.angle", "90")
    assert sensor(session).angle == pytest.approx(math.pi / 2)
    type_into(root, panel, "sensor.place.channel", "7")
    assert sensor(session).channel == 7
    for _ in range(3):
        session.undo()
    assert (sensor(session).x, sensor(session).angle, sensor(session).channel) == (50.0, 0.0, 0)


@pytest.mark.parametrize(
    ("field", "text", "said"), [("channel", "1", "used by C2"), ("channel", "0.5", "whole number"), ("x", "east", "a number")]
)
def test_what_cannot_be_is_said_and_changes_nothing(root, session, panel, field, text, said):
    session.select(Target(piece="P1", sensor="C1"))
    before = session.skin
    type_into(root, panel, f"sensor.place.{field}", text)
    assert said in panel.said[-1] and session.skin is before


def test_parameters_of_the_pattern_have_their_fields_and_bounds(root, session, panel):
    session.select(Target(piece="P1", sensor="C1"))
    type_into(root, panel, "sensor.params.param_s", "24")
    assert sensor(session).pattern.s == 24 and session.undo_label == "s of C1"
    type_into(root, panel, "sensor.params.param_s", "2")
    assert "nearest value that works" in panel.said[-1] and sensor(session).pattern.s == 24
    panel.nametowidget("sensor.params.param_caps").invoke()
    assert sensor(session).pattern.caps is True


def test_a_parameter_named_as_a_coordinate_is_another_field(root, session, panel):
    session.select(Target(piece="P1", sensor="C1"))
    assert panel.nametowidget("sensor.place.x.entry").get() == "50"
    type_into(root, panel, "sensor.params.param_x", "2")
    assert (sensor(session).pattern.x, sensor(session).x) == (2, pytest.approx(50, abs=5))


def test_prediction_fit_and_strain_are_said(root, session, panel):
    session.select(Target(piece="P1", sensor="C1"))
    words, form = panel.nametowidget("sensor").words, panel.nametowidget("sensor")
    assert form.fit.get() == "fits" and "162." in words.get() and "kohm" in words.get()
    end = time.monotonic() + 10
    while "worn +" not in words.get():
        assert time.monotonic() < end
        root.update()
        time.sleep(0.005)
    assert "worn +0.00 %" in words.get(), "a plate is worn as flat as it was made"
    type_into(root, panel, "sensor.place.x", "95")
    assert "outside piece P1" in form.fit.get()


def test_a_piece_and_the_document_in_numbers(root, session, panel):
    session.select(Target(piece="P1"))
    assert panel.title.get() == "Piece P1" and "sensors: C1, C2" in panel.nametowidget("piece").text.get()
    session.select(NOTHING)
    assert panel.title.get() == "plate.obj"
    type_into(root, panel, "document.bound", "4.2")
    assert session.skin.max_distortion == 4.2
    type_into(root, panel, "document.thickness", "2.5")
    assert panel.thick == [2.5]
    type_into(root, panel, "document.thickness", "-1")
    assert "0 or more" in panel.said[-1] and panel.thick == [2.5]
    type_into(root, panel, "document.bound", "4")
    assert "above 4" in panel.said[-1] and session.skin.max_distortion == 4.2
    type_into(root, panel, "document.bound", "short")
    root.update()
    assert session.skin.max_distortion == 4.1 and panel.nametowidget("document.bound").entry.get() == "4.1"


def test_another_printer_is_chosen(root, session, panel):
    box = panel.nametowidget("document.printer")
    box.set("generic-grbl")
    box.event_generate("<<ComboboxSelected>>")
    root.update()
    assert session.skin.printer == "generic-grbl" and session.undo_label == "other printer"


def test_several_selected_sensors_are_counted(root, session, panel):
    session.select(Target(piece="P1", sensor="C1", also=("C2", "C9")))
    assert panel.title.get() == "C1: contact-spiral on P1, and 1 more", "C9 is gone"
    root.update()
    assert panel.nametowidget("title").winfo_reqwidth() <= 300, "a longer one goes on in the next line"
    session.select(Target(piece="P1", sensor="C2"))
    assert panel.title.get() == "C2: contact-spiral on P1"
