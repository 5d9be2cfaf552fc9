"""A new sensor by a click in each view."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from person import MESHES

from skinfab.placement.edit import middle_of

ROUND = (0, 1, 3, 2, 6, 7, 5, 4)


@pytest.fixture
def flat(person):
    """A cube of 40 mm that lies flat as one piece."""
    person.open(MESHES / "cube.obj")
    seams = np.array([sorted(pair) for pair in itertools.pairwise(ROUND)])
    person.session.do("cut", replace(person.skin, seams=seams))
    person.wait()
    return person


def test_on_the_object(flat):
    flat.press("s")
    assert flat.session.tool == "add"
    flat.click_face(3)
    (sensor,) = flat.skin.sensors
    assert sensor.id == flat.session.selected.sensor and sensor.piece == flat.skin.pieces[0].id
    assert flat.session.undo_label == f"add {sensor.id}" and sensor.channel == 0
    # Where it was clicked: in the middle of face 3, in the flat too.
    mesh, piece = flat.skin.mesh, flat.skin.pieces[0]
    (uv,) = flat.app.derived.flat_map(mesh, piece).to_flat([3], [[1 / 3, 1 / 3, 1 / 3]])
    assert np.hypot(*(middle_of(sensor) - uv)) < 1.0
    flat.press("Control-z")
    assert flat.skin.sensors == () and flat.session.selected.sensor == ""


def test_on_the_flat_skin(flat):
    piece = flat.skin.pieces[0]
    goal = piece.UV[piece.F[5]].mean(axis=0)
    flat.press("s")
    flat.click_flat(flat.flat_place(piece.id, goal))
    flat.click_flat(flat.flat_place(piece.id, goal + np.array([1.5, 0])))
    one, two = flat.skin.sensors
    assert (one.channel, two.channel) == (0, 1) and one.id != two.id
    assert np.hypot(*(middle_of(one) - goal)) < 0.6
    assert any("too close" in p.text or "cross" in p.text or "overlap" in p.text for p in flat.session.problems), flat.session.problems


def test_where_nothing_lies_flat_it_says_so(person):
    person.open(MESHES / "cube.obj")
    person.press("s")
    person.click_face(3)
    assert person.skin.sensors == () and "no flat piece there" in person.app.status.text.get()


def test_a_profile_that_is_missing_is_a_sentence(flat):
    flat.session.do("other material", replace(flat.skin, material="no-such-ink"))
    flat.press("s")
    flat.click_face(3)
    assert any("no-such-ink" in text for text in flat.problems()) and flat.skin.sensors == ()
    flat.press("Control-z")
    flat.press("s")
    flat.click_face(3)
    assert len(flat.skin.sensors) == 1 and flat.problems() == []
