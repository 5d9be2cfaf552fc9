"""Where points are seen, and that turning, moving and enlarging keep what they must."""

from dataclasses import replace

import numpy as np
import pytest

from gui.view3d.camera import SIDES, Camera

BOX = np.array([[x, y, z] for x in (0.0, 40) for y in (-5.0, 5) for z in (10.0, 30)])


@pytest.fixture
def camera():
    return Camera.fitted(BOX, 640, 480)


def test_a_place_on_the_screen_is_one_in_space(camera):
    point = np.array([3.0, 1.0, 22.0])
    moved = camera.panned(31, -7).zoomed(1.7, (100, 90))
    np.testing.assert_allclose(moved.to_space(*moved.to_screen([point])[0]), point, atol=1e-9)


@pytest.mark.parametrize("side", SIDES)
def test_all_of_the_object_fits_and_fills_the_window(camera, side):
    screen = camera.seen_from(side).whole().to_screen(BOX)[:, :2]
    low, high = screen.min(axis=0), screen.max(axis=0)
    assert (low >= 0).all() and (high <= [640, 480]).all()
    assert ((high - low) / [640, 480]).max() == pytest.approx(0.86, abs=0.01)


@pytest.mark.parametrize("side", SIDES)
def test_sides_are_turns_and_not_mirrors(camera, side):
    turn = camera.seen_from(side).turn
    np.testing.assert_allclose(turn @ turn.T, np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1)


def test_from_the_front_x_is_right_and_z_is_up(camera):
    middle, x, z, y = camera.seen_from("front").to_screen(np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1], [0, 1, 0]]))
    assert x[0] > middle[0] and x[1] == pytest.approx(middle[1])
    assert z[1] < middle[1] and y[2] > middle[2]  # rows count down, depth away from the viewer


def test_enlarging_keeps_what_is_under_the_pointer(camera):
    at = (500.0, 120.0)
    before = camera.to_space(*at, 3.0)
    after = camera.zoomed(3.3, at)
    np.testing.assert_allclose(after.to_screen([before])[0, :2], at, atol=1e-9)
    assert after.scale == pytest.approx(3.3 * camera.scale)


def test_there_is_an_end_to_enlarging(camera):
    for factor, most in ((10.0, 1e5), (0.1, 1e-3)):
        zoomed = camera
        for _ in range(20):
            zoomed = zoomed.zoomed(factor, (0, 0))
        assert np.isfinite(zoomed.pan).all() and min(most, 1) <= zoomed.zoom <= max(most, 1)


def test_the_ball_follows_the_pointer(camera):
    """Pushing right moves what is in front right, and a thousand small turns leave a rotation."""
    near = camera.middle + camera.turn[2]
    assert camera.dragged((320, 240), (330, 240)).to_screen([near])[0, 0] > camera.to_screen([near])[0, 0]
    assert camera.dragged((320, 240), (320, 250)).to_screen([near])[0, 1] > camera.to_screen([near])[0, 1]
    rng = np.random.default_rng(0)
    for a, b in rng.uniform(-100, 700, (1000, 2, 2)):
        camera = camera.dragged(tuple(a), tuple(b))
    np.testing.assert_allclose(camera.turn @ camera.turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(camera.turn) == pytest.approx(1)


def test_beside_the_ball_it_turns_in_the_plane_of_the_screen(camera):
    turned = camera.dragged((639, 100), (639, 300))
    angle = np.degrees(np.arccos(np.clip(turned.turn[2] @ camera.turn[2], -1, 1)))
    across = camera.dragged((320, 140), (320, 340))
    assert angle < np.degrees(np.arccos(np.clip(across.turn[2] @ camera.turn[2], -1, 1)))


def test_a_drag_that_does_not_move_turns_nothing(camera):
    assert camera.dragged((5, 5), (5, 5)) is camera


def test_another_size_of_window_shows_the_same(camera):
    moved = camera.panned(48, 24)
    wider = moved.sized(1280, 960)
    np.testing.assert_allclose(wider.to_screen(BOX)[:, :2], 2 * moved.to_screen(BOX)[:, :2])


def test_sharper_pictures_have_more_pixels(camera):
    rows, shift = camera.projection(2)
    np.testing.assert_allclose((BOX @ rows.T + shift) / [2, 2, 1], camera.to_screen(BOX))


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.ones((1, 3)), np.ones((5, 3))])
def test_what_has_no_size_can_be_looked_at(points):
    camera = Camera.fitted(points, 300, 200)
    assert np.isfinite(camera.to_screen([[1.0, 1, 1]])).all() and camera.scale > 0
    assert np.isfinite(replace(camera, width=1, height=1).whole().scale)
