"""Copy, mirror, align, spread: exact places, the rest untouched, and what cannot be done is said."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.patterns.registry import make_pattern
from skinfab.placement.arrange import SIDES, align, copy, distribute, mirror
from skinfab.placement.edit import middle_of
from skinfab.placement.sensor import Sensor

SPIRAL, LINES = make_pattern("contact-spiral", {"s": 15}), make_pattern("strain-lines", {"l1": 40, "l2": 30, "b": 6})
THREE = (
    Sensor("C1", "P1", SPIRAL, 20.0, 30.0, 0.3, 0),
    Sensor("C2", "P1", SPIRAL, 70.0, 44.0, 2.0, 1),
    Sensor("S1", "P1", LINES, 31.0, 90.0, 5.0, 2),
)
ALL = ["C1", "C2", "S1"]


def test_copies_have_free_ids_and_channels():
    sensors = (*THREE, Sensor("C4", "P1", SPIRAL, 0.0, 0.0, 0.0, 7))
    result, new = copy(sensors, ["C1", "C4", "S1"], dx=5.0, dy=-2.0)
    assert new == ("C3", "C5", "S2") and result[:4] == sensors
    assert [s.channel for s in result[4:]] == [3, 4, 5]
    assert (result[4].x, result[4].y, result[4].angle, result[4].pattern) == (25.0, 28.0, 0.3, SPIRAL)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_mirrored_twice_is_as_before_and_once_is_the_image(axis):
    k = "xy".index(axis)
    once = mirror(THREE, ALL, axis=axis, at=50.0)
    for before, after in zip(THREE, once, strict=True):
        image = middle_of(before)
        image[k] = 100.0 - image[k]
        assert middle_of(after) == pytest.approx(image)
        direction = np.array([np.cos(before.angle), np.sin(before.angle)])
        direction[k] *= -1
        assert (np.cos(after.angle), np.sin(after.angle)) == pytest.approx(tuple(direction))
    for before, after in zip(THREE, mirror(once, ALL, axis=axis, at=50.0), strict=True):
        assert (after.x, after.y, after.angle) == pytest.approx((before.x, before.y, before.angle))


def test_a_mirror_amid_them_keeps_the_outermost_places():
    x = sorted(middle_of(s)[0] for s in mirror(THREE, ALL, axis="x"))
    assert (x[0], x[-1]) == pytest.approx((min(middle_of(s)[0] for s in THREE), max(middle_of(s)[0] for s in THREE)))


@pytest.mark.parametrize("side", SIDES)
def test_aligned_sides_lie_on_one_line_and_the_first_stays(side):
    result = align(THREE, ["C2", "S1", "C1"], side=side)
    assert result[1] == THREE[1]
    k = 0 if side in ("left", "right", "middle-x") else 1
    if side.startswith("middle"):
        places = [middle_of(s)[k] for s in result]
    else:
        places = [s.printed_path.bbox[0 if side in ("left", "bottom") else 1, k] for s in result]
    assert np.ptp(places) < 1e-9
    for before, after in zip(THREE, result, strict=True):
        assert ((before.x, before.y)[1 - k], before.angle) == ((after.x, after.y)[1 - k], after.angle)


def test_spread_evenly_between_the_outermost():
    x = [middle_of(s)[0] for s in distribute(THREE, ALL, axis="x")]
    before = sorted(middle_of(s)[0] for s in THREE)
    assert np.diff(sorted(x)) == pytest.approx([(before[-1] - before[0]) / 2] * 2)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: distribute(THREE, ["C1", "C2"], axis="x"), "three or more"),
        (lambda: align(THREE, ["C1", "C9"], side="left"), "no sensor C9"),
        (lambda: align(THREE, ALL, side="centre"), "choose one of left"),
        (lambda: mirror(THREE, [], axis="x"), "no sensors to arrange"),
        (lambda: mirror(THREE, ["C1"], axis="z"), "choose x or y"),
        (lambda: align(THREE, ["C1", "C1"], side="left"), "named twice"),
        (lambda: align((THREE[0], replace(THREE[1], piece="P2")), ["C1", "C2"], side="left"), "one piece at a time"),
        (lambda: copy(THREE, ["C7"]), "no sensor C7"),
    ],
)
def test_what_cannot_be_done_is_said(call, says):
    with pytest.raises(InputError, match=says):
        call()
