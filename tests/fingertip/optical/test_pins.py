"""Pins are found where they are, and each is given its own tip, also when some are hidden or all have moved far."""

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.pins import Pins, find_tips, level_of, require_image
from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.simulator import NO_ERRORS, Fingertip
from skinfab.tolerances import PIN_ROUNDS


@pytest.fixture(scope="module")
def tip() -> Fingertip:
    return Fingertip()


@pytest.fixture(scope="module")
def pins(tip: Fingertip) -> Pins:
    return Pins.of_rest(tip.image(tip.rest))


def true_movement(tip: Fingertip, pins: Pins, tips_mm: np.ndarray) -> np.ndarray:
    """What the simulator moved each found pin by, px."""
    rest = tip.dome.to_px(tip.rest)
    own = np.linalg.norm(pins.rest[:, None] - rest, axis=2).argmin(axis=1)
    assert len(set(own.tolist())) == len(rest)
    return tip.dome.to_px(tips_mm)[own] - rest[own]


def test_tips_are_found_to_a_tenth_of_a_pixel(tip: Fingertip, pins: Pins) -> None:
    rng = np.random.default_rng(3)
    for angle in (0.0, 1.0, 4.0):
        at = tip.pressed(HalfPlane(0.5, angle), rng=rng)
        found = pins.track(tip.image(at, rng=rng))
        assert not found.missing.any() and found.spare == 0
        off = found.moved - true_movement(tip, pins, at)
        assert np.sqrt((off**2).mean()) < 0.1 and np.abs(off).max() < 0.4


def test_a_hidden_pin_goes_with_its_neighbours(tip: Fingertip, pins: Pins) -> None:
    at = tip.pressed(HalfPlane(-20.0, 0.0), shear_mm=(1.0, 0.0))
    true = true_movement(tip, pins, at)
    middle = int(np.linalg.norm(pins.rest - pins.rest.mean(axis=0), axis=1).argmin())
    image = tip.image(at)
    column, row = np.rint(pins.rest[middle] + true[middle]).astype(int)
    image[row - 6 : row + 7, column - 6 : column + 7] = 0
    found = pins.track(image)
    assert np.flatnonzero(found.missing).tolist() == [middle]
    assert np.linalg.norm(found.moved[middle] - true[middle]) < 0.3 * np.linalg.norm(true[middle])


def test_a_pin_that_went_beyond_reach_is_found_where_its_neighbours_went(pins: Pins) -> None:
    from_middle = pins.rest - pins.rest.mean(axis=0)
    middle = int(np.linalg.norm(from_middle, axis=1).argmin())
    shift = 10.9 * np.exp(-(from_middle**2).sum(axis=1) / (2 * 25.0**2))
    tips = pins.rest + np.c_[0 * shift, shift]
    assert (shift > 0.55 * 18).sum() == 1  # farther than a tip may lie from rest
    found = pins.match(tips)
    assert not found.missing.any() and found.moved[middle, 1] == pytest.approx(shift[middle])


def test_specks_and_the_rim_are_no_pins(tip: Fingertip, pins: Pins) -> None:
    image = tip.image(tip.rest)
    image[2, 2] = image[5, 200] = 255
    image[-4:] = 255
    assert len(find_tips(image, pins.level)) == len(tip.rest)


def test_the_level_lies_midway_so_that_another_coding_is_read_alike(tip: Fingertip) -> None:
    two = np.where(tip.image(tip.rest) > 128, 255, 0).astype(np.uint8)
    assert level_of([two]) == 127 and level_of([two // 2 + 10]) in (73, 74)
    pins = Pins.of_rest(two)
    grey = np.clip(two + np.random.default_rng(0).normal(0, 8, two.shape), 0, 255).astype(np.uint8)
    coded = cv2.imdecode(cv2.imencode(".jpg", two, [cv2.IMWRITE_JPEG_QUALITY, 90])[1], cv2.IMREAD_GRAYSCALE)
    for other in (grey, coded, cv2.GaussianBlur(two, (3, 3), 0)):
        found = pins.track(other)
        assert not found.missing.any() and found.spare == 0 and np.abs(found.moved).max() < 0.2


def test_each_round_finds_pins_beside_those_of_the_last_and_there_are_few_rounds() -> None:
    """A row of pins, each gone 2.5 pixels farther than the one before: three are in reach, then one more a round."""
    k = np.arange(16.0)
    pins = Pins(np.c_[10 * k + 20, np.full(16, 50.0)], (120, 200), 100)
    found = pins.match(pins.rest + np.c_[0 * k, 2.5 * k])
    assert found.missing.tolist() == (k >= 3 + PIN_ROUNDS).tolist() and found.spare == found.missing.sum()
    np.testing.assert_allclose(found.moved[~found.missing, 1], 2.5 * k[~found.missing])


def test_usual_places_stand_for_rest() -> None:
    tip, rng = Fingertip(errors=NO_ERRORS), np.random.default_rng(0)
    images = [tip.image(tip.pressed(HalfPlane(float(rng.uniform(-4, 4)), float(rng.uniform(-3, 3))))) for _ in range(60)]
    pins = Pins.of_images(images)
    assert len(pins.rest) == len(tip.rest)
    off = np.linalg.norm(pins.rest[:, None] - tip.dome.to_px(tip.rest), axis=2).min(axis=1)
    assert off.max() < 3  # less than a sixth of the pitch: the usual movement is not taken out


def test_what_is_no_image_of_pins_is_refused(tip: Fingertip, pins: Pins) -> None:
    with pytest.raises(InputError, match="0 pins were found"):
        Pins.of_rest(np.zeros((240, 240), np.uint8))
    with pytest.raises(InputError, match="100 x 240 pixels, and the pins are known in 240 x 240"):
        pins.track(np.zeros((240, 100), np.uint8))
    with pytest.raises(InputError, match="grey bytes"):
        require_image(np.zeros((240, 240, 3), np.uint8), "one.png")
    assert 1 <= level_of([np.zeros((32, 32), np.uint8)]) <= 254
    dark = pins.track(np.zeros((240, 240), np.uint8))
    assert dark.missing.all() and not dark.moved.any()
