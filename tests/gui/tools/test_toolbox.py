"""Which tool is in hand, and what it is handed."""

import pytest
from person import MESHES


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    return person


def test_every_tool_has_a_key_a_button_and_a_hint(cube):
    box, bar = cube.app.toolbox, cube.app.root.nametowidget("toolbar")
    for id, tool in box.tools.items():
        cube.session.take_up("lock" if id != "lock" else "cut")
        cube.press(tool.key)
        assert box.held is tool and cube.session.tool == id
        assert cube.app.status.text.get() == tool.tip and tool.tip.endswith(".")
        assert bar.nametowidget(id).instate(["selected"]) and not bar.nametowidget("glue" if id != "glue" else "cut").instate(["selected"])
    bar.nametowidget("glue").invoke()
    assert box.held.id == "glue"


def test_a_button_pressed_by_the_space_bar_is_not_undone_by_its_key(cube):
    bar = cube.app.root.nametowidget("toolbar")
    bar.nametowidget("cut").focus_force()
    cube.app.root.update()
    for event in ("<KeyPress-space>", "<KeyRelease-space>"):
        bar.nametowidget("cut").event_generate(event)
    cube.app.root.update()
    assert cube.session.tool == "cut"
    cube.view3d.canvas.focus_force()
    cube.press("Key-space")
    assert cube.session.tool == "select"


def test_a_click_beside_the_object_selects_nothing(cube):
    cube.click_face(3)
    assert cube.session.selected.face == 3
    cube._click((5, 60), False)
    assert not cube.session.selected
    cube.press("c")
    cube._click((5, 60), False)
    assert not cube.app.toolbox.held.begun


def test_escape_with_nothing_in_hand_drops_the_selection(cube):
    cube.click_face(3)
    cube.press("Escape")
    assert not cube.session.selected


def test_hovering_says_what_is_there(cube):
    x, y = cube.see_face(4)
    cube.view3d.canvas.event_generate("<Motion>", x=x, y=y)
    cube.app.root.update()
    assert cube.session.hovered.face == 4 and "face 4, not flat yet" in cube.app.status.text.get()
