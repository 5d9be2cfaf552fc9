"""How things are shown, by key and by menu."""

import numpy as np
import pytest
from person import MESHES

from gui.state.session import SHADINGS
from gui.state.store import recall
from gui.theme import DARK, LIGHT


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    person.press("F5")
    person.wait()
    person.view3d.canvas.focus_force()
    person.app.root.update()
    return person


def picture(person):
    person.view3d.settle()
    person.wait()
    return person.view2d.surface.picture[:, :, :3].copy()


def test_each_shading_has_its_key_and_its_tick(cube):
    for k, name in enumerate(SHADINGS):
        cube.press(f"Control-Key-{k + 1}")
        assert cube.session.shading == name
        assert [a.checked() for a in cube.app.actions.all if a.id.startswith("shade_")] == [s == name for s in SHADINGS]
    cube.press("Control-Key-1")
    plain = picture(cube)
    cube.press("Control-Key-3")
    assert not np.array_equal(plain, picture(cube)), "the checker board is seen"


def test_show_all_brings_both_views_back(cube):
    cube.view3d.fit()
    whole, plane = cube.view3d.camera.zoom, cube.view2d.plane
    cube.view3d.move(cube.view3d.camera.zoomed(5, (10, 10)))
    cube.view2d.zoom(3)
    cube.wait()
    assert cube.view3d.camera.zoom != whole and cube.view2d.plane.scale != plane.scale
    cube.press("Home")
    cube.wait()
    assert cube.view3d.camera.zoom == whole and cube.view2d.plane.scale == pytest.approx(plane.scale)


def test_grid_and_dark_go_on_and_off(cube):
    shown = picture(cube)
    cube.press("Control-g")
    assert not cube.view2d.grid_shown and not cube.app.actions["grid"].checked() and not np.array_equal(shown, picture(cube))
    cube.press("Control-g")
    assert np.array_equal(shown, picture(cube))
    cube.press("Control-d")
    assert cube.app.theme is DARK and cube.app.actions["dark"].checked()
    assert recall(cube.app.desk.state).theme == "dark", "a crash must not take it"
    cube.press("Control-d")
    assert recall(cube.app.desk.state).theme == "light"
    assert cube.app.theme is LIGHT and np.array_equal(shown, picture(cube))
