"""What a pixel shows: the face, the place on it, and what is within reach."""

import numpy as np
import pytest

from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import LIGHT
from gui.view3d.camera import Camera
from gui.view3d.hit import hit
from gui.view3d.painter import Painter
from gui.view3d.scene import Scene
from gui.view3d.solid import Solid


@pytest.fixture
def look(skin):
    """Asks what is at a point (x, z) of the wall, or at a pixel."""
    session = Session()
    session.open(skin, None)
    scene, painter = Scene(session, Derived(), LIGHT), Painter()
    camera = Camera.fitted(skin.mesh.V, 700, 400).seen_from("front").whole()
    strokes = scene.strokes(skin, camera.scale)
    painter.draw(Solid.of(skin.mesh), camera, scene.paint(skin), strokes, sharper=2)

    def at(x, z, *, pixel=False, reach=4):
        column, row = (x, z) if pixel else np.floor(camera.to_screen([[x, 0, z]])[0, :2]).astype(int).tolist()
        return hit(skin, painter, scene.owner(skin), column, row, reach=reach)

    return at


@pytest.mark.parametrize("where", [(7.0, 21.0), (33.3, 52.1), (113.0, 4.0)])
def test_the_place_is_the_one_pointed_at(skin, look, where):
    found = look(*where)
    np.testing.assert_allclose(found.point[[0, 2]], where, atol=0.2)
    assert found.barycentric.sum() == pytest.approx(1) and (found.barycentric >= 0).all()
    np.testing.assert_allclose(found.barycentric @ skin.mesh.V[skin.mesh.F[found.face]], found.point)


def test_vertex_and_edge_are_the_nearest(skin, look):
    found = look(10.4, 20.3)
    np.testing.assert_allclose(skin.mesh.V[found.vertex], [10, 0, 20])
    found = look(12.5, 20.2)
    np.testing.assert_allclose(skin.mesh.V[skin.mesh.topology.E[found.edge]].mean(axis=0), [12.5, 0, 20])


def test_pieces_seams_and_sensors_are_found(skin, look):
    assert look(20, 30).target.piece == "P1" and look(115, 50).target.piece == "P2"
    on_seam = look(60.3, 33).target
    assert on_seam.seam == skin.mesh.topology.edge_ids(skin.seams)[6] and not on_seam.sensor
    line = Derived().object_line(skin, skin.sensors[0])
    x, _, z = line[len(line) // 2]
    assert look(x, z).target.sensor == "C1"


def test_beside_the_object_there_is_nothing(look):
    assert look(0, 0, pixel=True) is None and look(-5, 900, pixel=True) is None and look(9999, 3, pixel=True) is None
