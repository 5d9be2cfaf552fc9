"""The seed's pipeline: merged pins found where they are, on images drawn for it and on the simulated fingertip."""

import math

import cv2
import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.plates import HalfPlane
from skinfab.fingertip.optical.published import feature, merged, stretched
from skinfab.fingertip.optical.simulator import Fingertip, paper_fingertip


def spots(*places: tuple[float, float], radius: int = 4) -> np.ndarray:
    image = np.zeros((200, 200), np.uint8)
    for x, y in places:
        cv2.circle(image, (round(100 + x), round(100 + y)), radius, 200, -1)
    return image


ALONE = [(-60.0, -60.0), (60.0, -60.0), (60.0, 60.0), (-60.0, 60.0)]


@pytest.mark.parametrize("turn", [0.0, 0.5, 1.0, 2.0, 3.0])
def test_a_row_of_close_pins_is_one_feature_along_it(turn: float) -> None:
    row = [(t * math.cos(turn), t * math.sin(turn)) for t in (-22, -11, 0, 11, 22)]
    found = feature(spots(*row, *ALONE))
    assert found is not None and found.good and found.pins >= 4 and found.elongation > 5
    assert abs(math.remainder(found.angle_rad - turn - math.pi / 2, math.pi)) < math.radians(4)
    assert np.linalg.norm(found.centroid) < 1.5


def test_the_side_is_told_by_the_white_beside_it() -> None:
    row, beside = [(0.0, float(t)) for t in range(-32, 33, 16)], [(22.0, float(t)) for t in (-30, 0, 30)]
    left = feature(spots(*row, *beside, *ALONE))
    right = feature(spots(*row, *beside, *ALONE), plate_is_white=True)
    assert left is not None and right is not None
    assert math.cos(left.angle_rad) > 0.99 and math.cos(right.angle_rad) < -0.99  # one leaves the plate towards the white, or away


def test_pins_apart_are_no_feature_and_those_at_the_rim_no_good_one() -> None:
    assert feature(spots(*ALONE, (0, 0))) is None
    far = feature(spots(*[(70.0, float(t)) for t in (-32, -16, 0, 16, 32)], *ALONE[::3]))
    assert far is not None and not far.good and far.centroid[0] == pytest.approx(70, abs=1)


def test_five_dilations_close_ten_pixels() -> None:
    def regions(gap: int) -> int:
        image = np.zeros((80, 120), np.uint8)
        image[30:50, 20:40] = image[30:50, 40 + gap : 60 + gap] = 255
        return cv2.connectedComponents(merged(image))[0] - 1

    assert [regions(gap) for gap in (9, 10, 11, 12)] == [1, 1, 2, 2]


def test_light_does_not_matter_and_darkness_is_told() -> None:
    image = spots(*[(0.0, float(t)) for t in range(-32, 33, 16)], *ALONE)
    bright, dim = feature(image + np.uint8(40)), feature((image * 0.5).astype(np.uint8))
    assert bright is not None and dim is not None and bright.angle_rad == pytest.approx(dim.angle_rad, abs=0.05)
    with pytest.raises(InputError, match="no pins are seen"):
        feature(np.full((200, 200), 30, np.uint8))
    with pytest.raises(InputError, match="one channel"):
        stretched(np.zeros((20, 20, 3), np.uint8))


def test_on_the_seeds_fingertip_it_tells_most_edges_in_the_middle() -> None:
    rng, tip, axis, side = np.random.default_rng(0), paper_fingertip(), [], []
    for turn in rng.uniform(-math.pi, math.pi, 30):
        found = feature(tip.frame(HalfPlane(0.0, turn), rng=rng))
        if found is not None and found.good:
            axis.append(abs(math.degrees(math.remainder(found.angle_rad - turn, math.pi))))
            side.append(math.cos(found.angle_rad - turn) > 0)
    assert len(axis) > 15 and np.median(axis) < 12 and np.mean(side) > 0.8


def test_pins_that_merge_at_rest_already_tell_nothing() -> None:
    """127 pins, 3 mm apart, in an image of 240 pixels: five dilations close most of their gaps without any contact."""
    image = Fingertip().frame(HalfPlane(40.0, 0.0), rng=np.random.default_rng(0))
    assert cv2.connectedComponents(merged(stretched(image)))[0] < 60
    paper = paper_fingertip().frame(HalfPlane(40.0, 0.0), rng=np.random.default_rng(0))
    assert cv2.connectedComponents(merged(stretched(paper)))[0] > 240
    assert feature(paper) is None
