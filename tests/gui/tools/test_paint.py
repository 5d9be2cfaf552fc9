"""Painting where seams are wanted, by strokes over the real picture."""

import numpy as np
import pytest
from person import MESHES


@pytest.fixture
def finger(person):
    person.open(MESHES / "cylinder.obj")
    return person


def painted(person):
    marks = person.skin.marks
    return np.zeros(len(person.skin.mesh.F), dtype=int) if marks is None else marks.preference.astype(int)


def stroke(person, face):
    x, y = person.see_face(face)
    camera = person.view3d.camera
    person.drag3d((x, y), (x + 12, y), (x + 40, y + 5))
    assert person.view3d.camera is camera, "the object does not turn under the brush"


def test_a_stroke_is_one_step_and_shows_what_is_painted(finger):
    finger.press("a")
    stroke(finger, 100)
    assert (painted(finger) == 1).sum() > 5 and painted(finger)[100] == 1 and (painted(finger) >= 0).all()
    assert finger.session.shading == "preferences" and finger.session.undo_label == "paint"
    finger.press("Control-z")
    assert finger.skin.marks is None and finger.session.undo_label is None
    finger.press("Control-y")
    assert painted(finger)[100] == 1


def test_avoid_neutral_and_shift(finger):
    finger.press("v")
    finger.click_face(200)
    assert painted(finger)[200] == -1
    finger.press("a")
    finger.click_face(200)
    assert painted(finger)[200] == 1
    finger.click_face(200, shift=True)
    assert painted(finger)[200] == 0
    finger.press("v")
    finger.click_face(200)
    finger.press("e")
    stroke(finger, 200)
    assert painted(finger)[200] == 0
    assert finger.session.undo_label == "paint"


def test_a_stroke_that_begins_beside_the_object_turns_it(finger):
    finger.press("a")
    before = finger.view3d.camera
    finger.drag3d((4, 60), (40, 90), (60, 100))
    assert finger.skin.marks is None and not np.array_equal(finger.view3d.camera.turn, before.turn)


def test_a_stroke_broken_off_by_another_tool_is_a_step_of_its_own(finger):
    finger.press("a")
    x, y = finger.see_face(300)
    canvas = finger.view3d.canvas
    canvas.event_generate("<ButtonPress-1>", x=x, y=y)
    canvas.event_generate("<B1-Motion>", x=x + 20, y=y, state=0x100)
    finger.app.root.update()
    finger.press("v")
    finger.press("a")
    canvas.event_generate("<ButtonRelease-1>", x=x + 20, y=y, state=0x100)
    finger.app.root.update()
    first = finger.skin
    finger.click_face(3000)
    finger.press("Control-z")
    assert finger.skin is first
