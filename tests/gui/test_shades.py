"""Both views ask here what colour a face has."""

from dataclasses import replace

import numpy as np
import pytest

from gui.shades import HEAT_RANGE, face_colours, heat, piece_colours
from gui.state.derived import Derived
from gui.theme import DARK, LIGHT
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.skin import SeamMarks, Skin, Source


@pytest.fixture
def skin():
    """Two pieces of a strip of three faces; the second is stretched by a tenth; the third face is on no piece."""
    V = np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [20, 0, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 2]])
    one = Piece("P1", np.array([0]), np.array([0, 1, 2]), np.array([[0, 1, 2]]), V[[0, 1, 2], :2])
    two = Piece("P2", np.array([1]), np.array([0, 2, 3]), np.array([[0, 1, 2]]), 1.1 * V[[0, 2, 3], :2])
    return Skin(Mesh(V, F), Source("strip.obj", "0" * 64, "mm", 1.0), np.array([[0, 2]]), (one, two))


def test_darker_is_worse():
    light = heat(np.linspace(*HEAT_RANGE, 50)).astype(float) @ [0.3, 0.6, 0.1]
    assert (np.diff(light) < 0).all()


def test_pieces_differ_and_bare_faces_are_grey(skin):
    colours = face_colours(skin, Derived(), "pieces", LIGHT)
    assert np.array_equal(colours[:2], piece_colours(2, LIGHT)) and len({tuple(c) for c in colours.tolist()}) == 3
    assert np.ptp(colours[2].astype(int)) < 15


def test_pieces_are_darker_in_the_dark(skin):
    light, dark = (face_colours(skin, Derived(), "pieces", theme).astype(int) for theme in (LIGHT, DARK))
    assert (dark < light).all()


def test_distortion_is_that_of_the_face(skin):
    colours = face_colours(skin, Derived(), "distortion", LIGHT)
    s = 1.1
    assert np.array_equal(colours[0], heat([4.0])[0])
    assert np.array_equal(colours[1], heat([(1 + s**-4) * 2 * s * s])[0])


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_painted_faces_are_told_apart(skin, theme):
    assert len(np.unique(face_colours(skin, Derived(), "preferences", theme), axis=0)) == 1
    marked = replace(skin, marks=replace(SeamMarks.none(3), preference=np.array([1, 0, -1], dtype=np.int8)))
    red, green, _ = face_colours(marked, Derived(), "preferences", theme)[[0, 2]].astype(int).T
    assert green[0] > red[0] + 30 and red[1] > green[1] + 30


def test_more_pieces_than_colours_begin_again():
    assert np.array_equal(piece_colours(12, DARK)[10], piece_colours(1, DARK)[0])


def test_both_views_share_what_is_kept_and_strokes_of_the_brush_are_not(skin):
    derived = Derived()
    kept = {(s, t.name): face_colours(skin, derived, s, t) for s in ("pieces", "distortion") for t in (LIGHT, DARK)}
    assert len({colours.tobytes() for colours in kept.values()}) == 4
    for (shading, name), colours in kept.items():
        assert face_colours(replace(skin, seed=9), derived, shading, LIGHT if name == "light" else DARK) is colours
    one_less = face_colours(replace(skin, pieces=skin.pieces[:1]), derived, "pieces", LIGHT)
    assert one_less[1].tolist() == kept["pieces", "light"][2].tolist()
    assert face_colours(skin, derived, "preferences", LIGHT) is not face_colours(skin, derived, "preferences", LIGHT)
