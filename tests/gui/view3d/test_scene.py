"""What lights up, what is shown over it, and that nothing is computed twice."""

from dataclasses import replace

import numpy as np
import pytest

from gui.state.derived import Derived
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from gui.theme import DARK, LIGHT, rgb
from gui.view3d.scene import Scene


@pytest.fixture
def session(skin):
    session = Session()
    session.open(skin, None)
    return session


@pytest.fixture
def scene(session):
    return Scene(session, Derived(), LIGHT)


def test_the_piece_under_the_pointer_and_the_selected_one_are_tinted(skin, session, scene):
    assert not scene.paint(skin).tint.any()
    session.hover(Target(face=3, piece="P1"))
    session.select(Target(piece="P2"))
    tint = scene.paint(skin).tint
    assert (tint[skin.pieces[0].faces] == 1).all() and (tint[skin.pieces[1].faces] == 2).all()
    assert {rgb(LIGHT.select), rgb(LIGHT.hover)} <= {tuple(c) for c in scene.strokes(skin, 5.0).colour.tolist()}
    session.select(Target(piece="P2", sensor="C1"))  # the sensor is meant, not all of its piece
    assert (scene.paint(skin).tint[skin.pieces[1].faces] == 0).all()


def test_paint_is_made_anew_only_when_it_differs(skin, session, scene):
    paint = scene.paint(skin)
    session.hover(Target(face=3))
    assert scene.paint(skin) is paint
    moved = replace(skin, sensors=(replace(skin.sensors[0], x=35.0),))
    assert scene.paint(moved) is paint
    session.shade("distortion")
    assert scene.paint(skin) is not paint


def test_a_checker_board_lies_as_the_pieces_do(skin, session, scene):
    assert scene.paint(skin).flat is None
    session.shade("checker")
    flat, piece = scene.paint(skin).flat, skin.pieces[1]
    np.testing.assert_allclose(5 * flat[piece.faces], piece.UV[piece.F], atol=1e-4)
    bare = replace(skin, pieces=(), sensors=())
    assert np.isnan(scene.paint(bare).flat).all()


def test_a_sensor_and_a_seam_light_up(skin, session, scene):
    def colours():
        strokes = scene.strokes(skin, 5.0)
        return {tuple(strokes.colour[k].tolist()) for k in np.unique(strokes.item)}

    assert rgb(LIGHT.select) not in colours() and rgb(LIGHT.hover) not in colours()
    session.select(Target(sensor="C1", piece="P2"))
    assert rgb(LIGHT.select) in colours() and rgb(LIGHT.ink) not in colours()
    session.hover(Target(seam=int(skin.mesh.topology.edge_ids(skin.seams)[0])))
    assert rgb(LIGHT.hover) in colours()
    session.select(NOTHING)
    session.hover(Target(face=7))
    strokes = scene.strokes(skin, 5.0)
    np.testing.assert_allclose(strokes.a[-3:], skin.mesh.V[skin.mesh.F[7]])
    session.hover(Target(face=10**6))  # of a larger mesh that was open before
    scene.strokes(skin, 5.0)


def test_sensors_selected_together_light_up_together(skin, session, scene):
    other = replace(skin.sensors[0], id="C2", x=20.0)
    session.do("copy", replace(skin, sensors=(*skin.sensors, other)))
    session.select(Target(sensor="C1", piece="P2", also=("C2", "gone")))
    strokes = scene.strokes(session.skin, 5.0)
    shown = {t.sensor: tuple(c) for t, c in zip(strokes.targets, strokes.colour.tolist(), strict=True) if t.sensor}
    assert shown == {"C1": rgb(LIGHT.select), "C2": rgb(LIGHT.select)}


def test_lines_are_dark_on_the_bar_of_colours(skin, session, scene):
    scene.theme = DARK
    assert tuple(scene.strokes(skin, 5).colour[0].tolist()) in (rgb(DARK.seam), rgb(DARK.locked))
    session.shade("distortion")
    assert tuple(scene.strokes(skin, 5).colour[0].tolist()) in (rgb(LIGHT.seam), rgb(LIGHT.locked))


def test_what_is_shown_is_on_top_until_it_is_hidden(skin, scene):
    before = len(scene.strokes(skin, 5).targets)
    scene.show("path", [[[0, 0, 0], [9, 0, 9]], [[5, 0, 5]]], "#102030", 3)
    strokes = scene.strokes(skin, 5)
    assert len(strokes.targets) == before + 2 and strokes.colour[-1].tolist() == [16, 32, 48]
    scene.show("path", [[[0, 0, 0], [9, 0, 9]]], "#102030", 3)
    assert len(scene.strokes(skin, 5).targets) == before + 1
    assert scene.hide("path") and not scene.hide("path")
    assert len(scene.strokes(skin, 5).targets) == before


def test_lights_of_several_names_glow_together(scene):
    assert scene.spots is None
    scene.glow("C1", [[1, 2, 3]], "#ff0000", radius=4)
    scene.glow("C2", [[4, 5, 6], [np.nan] * 3], "#00ff00", radius=5, strength=7)
    spots = scene.spots
    assert (
        spots.points.tolist() == [[1, 2, 3], [4, 5, 6]] and spots.colour[1].tolist() == [0, 255, 0, 1] and spots.radius.tolist() == [4, 5]
    )
    assert scene.spots is spots
    assert scene.hide("C1") and len(scene.spots.points) == 1 and scene.hide("C2") and scene.spots is None
