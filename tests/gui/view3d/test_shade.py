"""Colours of pixels: light, boards, tints, smooth outlines, and spots that glow."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import sphere

from gui.view3d.camera import Camera
from gui.view3d.lines import Strokes
from gui.view3d.painter import Painter, Spots
from gui.view3d.shade import Paint
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh

NONE = Strokes.joined([])
SQUARE = Mesh(np.array([[0.0, 0, 0], [10, 0, 0], [10, 0, 10], [0, 0, 10]]), np.array([[0, 1, 2], [0, 2, 3]]), "square")


def paint_of(m, background=(255, 255, 255), colour=(200, 100, 50)):
    tints = np.array([[0, 0, 0, 0], [0, 0, 255, 0.5]], dtype=np.float32)
    return Paint(np.tile(np.uint8(colour), (m, 1)), np.zeros(m, np.uint8), tints, np.array(background, np.uint8))


def front(mesh, width=120, height=100):
    return Camera.fitted(mesh.V, width, height).seen_from("front").whole()


def test_a_flat_surface_has_one_colour_of_its_own_hue():
    image = Painter().draw(Solid.of(SQUARE), front(SQUARE), paint_of(2), NONE)
    inner = image[20:80, 30:90].reshape(-1, 3).astype(float)
    assert np.ptp(inner, axis=0).max() == 0
    assert inner[0, 0] / inner[0, 1] == pytest.approx(2, rel=0.03) and 120 < inner[0, 0] <= 200
    assert (image[0, 0] == 255).all()


def test_the_inside_is_darker():
    solid = Solid.of(SQUARE)
    outside, inside = (Painter().draw(solid, front(SQUARE).seen_from(s), paint_of(2), NONE)[50, 60, 0] for s in ("front", "back"))
    assert inside < outside


def test_a_ball_is_smooth_and_light_comes_over_the_left_shoulder():
    ball = Mesh(*sphere(3))
    image = Painter().draw(Solid.of(ball), front(ball, 200, 200), paint_of(len(ball.F)), NONE, sharper=2).astype(int)
    assert image[60, 60, 0] > image[140, 140, 0] + 30
    inner = image[60:140, 60:140, 0]
    assert np.abs(np.diff(inner, axis=1)).max() <= 4  # no facets


def test_a_crease_stays_sharp():
    V = np.array([[0.0, 0, 0], [0, 0, 10], [-8, 6, 0], [-8, 6, 10], [8, 6, 0], [8, 6, 10]])
    roof = Mesh(V, np.array([[0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1]]))
    row = Painter().draw(Solid.of(roof), front(roof), paint_of(4), NONE)[50, :, 0].astype(int)
    assert (np.abs(np.diff(row[row < 255])) > 8).sum() == 1


def test_outlines_are_averaged_when_it_is_sharper():
    ball = Mesh(*sphere(3))
    count = [
        len(np.unique(Painter().draw(Solid.of(ball), front(ball), paint_of(len(ball.F), (0, 0, 0)), NONE, sharper=s)[:, :, 0]))
        for s in (1, 2)
    ]
    assert count[1] > count[0] + 10


def test_a_quick_picture_looks_like_a_smooth_one():
    ball = Mesh(*sphere(5))
    assert len(ball.F) > 20_000
    few = Mesh(*sphere(4))
    images = [Painter().draw(Solid.of(m), front(ball), paint_of(len(m.F)), NONE).astype(int) for m in (ball, few)]
    assert np.abs(images[0] - images[1])[:, :, 0].mean() < 1.5


def test_tints_lie_over_colours():
    paint = replace(paint_of(2), tint=np.array([0, 1], np.uint8))
    image = Painter().draw(Solid.of(SQUARE), front(SQUARE), paint, NONE).astype(int)
    plain, tinted = image[70, 80], image[30, 40]
    assert tinted[2] > tinted[0] and plain[0] > plain[2]


def test_the_board_has_squares_where_the_flat_map_says():
    """Ten squares a side: along a row the colour changes nine times; faces without a flat place have no board."""
    flat = SQUARE.V[SQUARE.F][:, :, [0, 2]].astype(np.float32)
    image = Painter().draw(Solid.of(SQUARE), front(SQUARE, 400, 400), replace(paint_of(2), flat=flat), NONE, sharper=2).astype(int)
    row = image[200 + 10, 40:360, 0]
    assert (np.abs(np.diff(np.sign(row - row.mean()))) > 0).sum() == 9
    flat[1] = np.nan
    image = Painter().draw(Solid.of(SQUARE), front(SQUARE, 400, 400), replace(paint_of(2), flat=flat), NONE).astype(int)
    assert np.ptp(image[60:150, 45, 0]) == 0 and np.ptp(image[250:340, 345, 0]) > 30


def test_spots_glow_where_they_are_and_not_through_the_object():
    ball = Mesh(10 * sphere(3)[0], sphere(3)[1])
    camera, paint = front(ball, 200, 200), paint_of(len(ball.F), colour=(90, 90, 90))
    plain = Painter().draw(Solid.of(ball), camera, paint, NONE).astype(int)
    for y, glows in ((-10.0, True), (10.0, False)):
        spots = Spots(np.array([[0, y, 0]]), np.array([4.0]), np.array([[255.0, 0, 0, 1]]))
        image = Painter().draw(Solid.of(ball), camera, paint, NONE, spots=spots).astype(int)
        assert bool((image[100, 100] - plain[100, 100])[0] > 80) == glows
        assert np.array_equal(image[100, 30], plain[100, 30])
