"""Labels stand where what they name is seen, and not upon each other."""

from dataclasses import replace

import numpy as np

from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import LIGHT
from gui.view3d.camera import Camera
from gui.view3d.labels import Label, piece_labels, seam_labels, sensor_label, without_overlap
from gui.view3d.marks import SeamLabels
from gui.view3d.painter import Painter
from gui.view3d.scene import Scene
from gui.view3d.solid import Solid


def drawn(skin, camera):
    session, painter = Session(), Painter()
    session.open(skin, None)
    scene = Scene(session, Derived(), LIGHT)
    painter.draw(Solid.of(skin.mesh), camera, scene.paint(skin), scene.strokes(skin, camera.scale))
    return painter, scene


def test_pieces_bear_their_names_on_themselves(skin):
    camera = Camera.fitted(skin.mesh.V, 700, 400).seen_from("front").whole()
    painter, scene = drawn(skin, camera)
    one, two = piece_labels(painter, scene.owner(skin), ["P1", "P2"])
    (x, *_), (end, *_) = camera.to_screen([[60, 0, 30], [120, 0, 30]])
    assert one.text == "P1" and one.x < x < two.x < end


def test_a_piece_that_is_hardly_seen_bears_none(skin):
    camera = Camera.fitted(skin.mesh.V, 700, 400).seen_from("front").panned(348, 0)
    painter, scene = drawn(skin, camera)
    assert [label.text for label in piece_labels(painter, scene.owner(skin), ["P1", "P2"])] == ["P1"]


def test_sensors_bear_theirs_above_what_is_seen_of_them(skin):
    camera = Camera.fitted(skin.mesh.V, 700, 400).seen_from("front").whole()
    painter, scene = drawn(skin, camera)
    line = scene.sensor_line(skin, 0)
    label = sensor_label(painter, camera, "C1", line)
    screen = camera.to_screen(line)
    assert label.y < np.nanmin(screen[:, 1]) and np.nanmin(screen[:, 0]) < label.x < np.nanmax(screen[:, 0])
    away = camera.panned(500, 0)
    painter, _ = drawn(skin, away)
    assert sensor_label(painter, away, "C1", line) is None
    assert sensor_label(painter, away, "C1", np.full((9, 3), np.nan)) is None


def test_numbers_of_hidden_seams_are_left_out(skin):
    """A second wall in front of the first hides its seam."""
    front = replace(
        skin.mesh,
        V=np.concatenate([skin.mesh.V, skin.mesh.V - [0, 30, 0]]),
        F=np.concatenate([skin.mesh.F, skin.mesh.F + len(skin.mesh.V)]),
    )
    camera = Camera.fitted(front.V, 700, 400).seen_from("front").whole()
    both = replace(skin, mesh=front, marks=None)
    labels = SeamLabels.of(skin)
    painter, _ = drawn(both, camera)
    assert seam_labels(painter, camera, labels) == []
    painter, _ = drawn(skin, camera)
    assert [label.text for label in seam_labels(painter, camera, labels)] == ["1"]


def test_no_two_labels_touch():
    rng = np.random.default_rng(0)
    words = [Label(str(k), *rng.uniform(0, 200, 2), "seam") for k in range(80)]
    kept = without_overlap(words, lambda label: (30.0, 12.0))
    assert kept[0] is words[0] and 5 < len(kept) < 80
    assert all(abs(a.x - b.x) >= 30 or abs(a.y - b.y) >= 12 for a in kept for b in kept if a is not b)
