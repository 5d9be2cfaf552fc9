"""The simulated fingertip: its pins lean as an edge makes them, move with the plate, and are drawn where they are."""

import math

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.plates import Disk, HalfPlane
from skinfab.fingertip.optical.simulator import NO_ERRORS, Dome, Errors, Fingertip

CLEAN = Fingertip(errors=NO_ERRORS)


def moved(tip: Fingertip, plate: HalfPlane | Disk, **options: float) -> np.ndarray:
    return tip.pressed(plate, **options) - tip.rest  # type: ignore[arg-type]


def test_pins_lean_off_the_plate_at_its_edge_most() -> None:
    for turn in (0.0, 1.0, 4.0):
        d = moved(CLEAN, HalfPlane(0.0, turn))
        strongest = int(np.linalg.norm(d, axis=1).argmax())
        outward = np.array([math.cos(turn), math.sin(turn)])
        assert d[strongest] @ outward > 0.8 and abs(CLEAN.rest[strongest] @ outward) < CLEAN.dome.pitch_mm / 2


def test_a_dome_that_is_deeper_in_is_moved_more_and_one_in_the_air_not_at_all() -> None:
    sizes = [np.abs(moved(CLEAN, HalfPlane(0.0, 0.0), depth_mm=depth)).sum() for depth in (0.0, 0.5, 1.0, 2.0, 3.0)]
    assert sizes[0] == 0 and (np.diff(sizes) > 0).all()
    assert np.abs(moved(CLEAN, HalfPlane(40.0, 0.0))).max() == 0


def test_no_pin_comes_nearer_to_anothers_place_than_to_its_own() -> None:
    for offset in np.linspace(-8, 8, 17):
        for turn in np.linspace(0, math.pi / 3, 7):
            assert np.linalg.norm(moved(CLEAN, HalfPlane(offset, turn), depth_mm=2.4), axis=1).max() < CLEAN.dome.pitch_mm / 2


def test_a_turned_fingertip_feels_the_edge_turned_the_other_way() -> None:
    one = moved(CLEAN, HalfPlane(1.0, 0.5))
    np.testing.assert_allclose(CLEAN.pressed(HalfPlane(1.0, 0.8), turn_rad=0.3) - CLEAN.rest, one, atol=1e-9)
    np.testing.assert_allclose(CLEAN.pressed(HalfPlane(0.0, 0.5), at=np.array([math.cos(0.5), math.sin(0.5)])) - CLEAN.rest, one, atol=1e-9)


def test_shear_drags_what_touches_and_nothing_else() -> None:
    plate = HalfPlane(0.0, 0.0)
    dragged = CLEAN.pressed(plate, shear_mm=(0.0, 0.5)) - CLEAN.pressed(plate)
    touching = (np.linalg.norm(CLEAN.rest, axis=1) < 6) & (CLEAN.rest[:, 0] < -2.5)
    assert touching.sum() >= 1 and (dragged[touching, 1] > 0.4).all()
    assert np.abs(dragged[CLEAN.rest[:, 0] > 6]).max() < 0.01 and np.abs(dragged[:, 0]).max() == 0


def test_spots_are_drawn_where_the_tips_are() -> None:
    P = CLEAN.rest + np.random.default_rng(0).uniform(-0.5, 0.5, CLEAN.rest.shape)
    image = CLEAN.image(P)
    _, labels = cv2.connectedComponents((image > 0).astype(np.uint8))
    at = np.rint(CLEAN.dome.to_px(P)).astype(int)
    rows, columns = np.indices(image.shape)
    for p, (x, y) in zip(CLEAN.dome.to_px(P), at, strict=True):
        weight = image * (labels == labels[y, x])
        found = np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum()
        assert np.linalg.norm(found - p) < 0.1  # of a pixel


def test_the_same_seed_gives_the_same_frame_and_another_another() -> None:
    def frame(tip: int, noise: int) -> np.ndarray:
        return Fingertip(seed=tip).frame(HalfPlane(0.0, 0.0), rng=np.random.default_rng(noise))

    assert np.array_equal(frame(1, 2), frame(1, 2))
    assert not np.array_equal(frame(1, 2), frame(1, 3)) and not np.array_equal(frame(1, 2), frame(2, 2))


def test_noise_is_as_large_as_is_said() -> None:
    tip = Fingertip(errors=Errors(pin_mm=0.2, scatter_mm=0.0, grey=0.0))
    rng = np.random.default_rng(0)
    far = HalfPlane(60.0, 0.0)
    d = np.array([tip.pressed(far, rng=rng) - tip.rest for _ in range(20)])
    assert d.std() == pytest.approx(0.2, rel=0.05)
    assert tip.without(pin_mm=0.0).errors == Errors(0.0, 0.0, 0.0)


def test_a_dome_has_the_pins_of_its_rings_and_maps_back() -> None:
    for rings, count in ((1, 7), (6, 127)):
        assert len(Dome(rings=rings).pins) == count
    dome = Dome()
    np.testing.assert_allclose(dome.to_mm(dome.to_px(dome.pins)), dome.pins, atol=1e-12)
    assert np.linalg.norm(dome.pins, axis=1).max() < dome.radius_mm


@pytest.mark.parametrize("depth", [-0.1, 3.1, math.nan])
def test_a_depth_that_the_plate_does_not_allow_is_refused(depth: float) -> None:
    with pytest.raises(InputError, match="depth"):
        CLEAN.pressed(HalfPlane(0.0, 0.0), depth_mm=depth)
