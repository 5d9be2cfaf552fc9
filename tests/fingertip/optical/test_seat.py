"""A camera that has moved is told by an image at rest, and an image that is none of the untouched fingertip as well."""

import math

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.labelled import labelled
from skinfab.fingertip.optical.pins import Pins
from skinfab.fingertip.optical.seat import seat
from skinfab.fingertip.optical.simulator import Fingertip

TIP = Fingertip()
REST = TIP.image(TIP.rest)


@pytest.fixture(scope="module")
def usual() -> Pins:
    """Pins whose usual places stand for rest, learned from presses that are all deep and to one side: the worst case there is."""
    some = labelled(TIP, 80, depths_mm=(1.6, 2.4), reach_mm=5)
    return Pins.of_images([one.image for one in some if abs(one.edge.angle_rad) < 1])


def moved(shift_px: float, turn_deg: float) -> tuple[np.ndarray, np.ndarray]:
    """The image, and the way that it went."""
    way = cv2.getRotationMatrix2D((119.5, 119.5), turn_deg, 1.0) + np.array([[0, 0, shift_px], [0, 0, 0]])
    return cv2.warpAffine(REST, way, (240, 240)), way


def test_shift_and_turn_are_told() -> None:
    pins = Pins.of_rest(REST)
    image, way = moved(3.0, 2.0)
    found = seat(pins, image)
    np.testing.assert_allclose(found.pins.rest, pins.rest @ way[:, :2].T + way[:, 2], atol=0.1)
    assert found.shift_px == pytest.approx(3, abs=0.1) and math.degrees(found.turn_rad) == pytest.approx(-2, abs=0.05)
    assert found.fits and found.left_px < 0.1 and found.pitch_px == pytest.approx(17, abs=0.5)


@pytest.mark.parametrize(("shift_px", "turn_deg"), [(0, 0), (2, 1), (5, 0), (0, 3), (3, 3)])
def test_a_camera_that_has_moved_fits_also_usual_places(usual: Pins, shift_px: float, turn_deg: float) -> None:
    assert seat(usual, moved(shift_px, turn_deg)[0]).fits


@pytest.mark.parametrize(("shift_px", "turn_deg"), [(8, 0), (0, 6), (0, 10)])
def test_one_that_has_moved_too_far_does_not(usual: Pins, shift_px: float, turn_deg: float) -> None:
    assert not seat(usual, moved(shift_px, turn_deg)[0]).fits


def test_where_there_are_no_pins_it_is_refused(usual: Pins) -> None:
    with pytest.raises(InputError, match="pins are not found in the image at rest"):
        seat(usual, cv2.GaussianBlur(REST, (61, 61), 0))
