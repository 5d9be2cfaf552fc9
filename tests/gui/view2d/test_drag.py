"""Where dragged sensors come to lie."""

import numpy as np
import pytest

from gui.view2d.drag import Grabbed
from skinfab.placement.edit import middle_of

OFFSETS = {"P1": np.array([0.0, 0.0]), "P2": np.array([70.0, 5.0])}


def grab(sensors, others=(), *, at=(30.0, 30.0), turning=False):
    return Grabbed(tuple(sensors), np.array(at), turning, OFFSETS.__getitem__, tuple(others))


def test_free_it_follows_the_pointer_and_snapped_its_middle_keeps_to_the_grid(skin):
    (sensor,) = skin.sensors[:1]
    (free,), guides = grab([sensor]).moved(np.array([33.3, 28.9]), piece="P1", snap=False, reach=1.0)
    assert (free.x, free.y) == pytest.approx((23.3, 28.9)) and not len(guides)
    (snapped,), _ = grab([sensor]).moved(np.array([33.3, 28.9]), piece="P1", snap=True, reach=1.0)
    assert middle_of(snapped) == pytest.approx(np.round(middle_of(free)))


def test_it_falls_in_line_with_another_and_the_guide_says_so(skin):
    one, two = skin.sensors
    from dataclasses import replace

    other = replace(two, piece="P1", x=20.37, y=48.0)
    goal = np.array([30.2, 21.0])
    (moved,), guides = grab([one], [other]).moved(goal, piece="P1", snap=True, reach=0.5)
    assert middle_of(moved)[0] == pytest.approx(middle_of(other)[0]) and guides.shape == (1, 2, 2)
    assert guides[0, 1] == pytest.approx(middle_of(other))


def test_onto_another_piece_it_keeps_its_place_on_the_sheet(skin):
    (sensor,) = skin.sensors[:1]
    (moved,), _ = grab([sensor]).moved(np.array([110.0, 40.0]), piece="P2", snap=False, reach=1.0)
    assert moved.piece == "P2" and (moved.x, moved.y) == pytest.approx((20 + 80 - 70, 30 + 10 - 5))
    (beside,), _ = grab([sensor]).moved(np.array([110.0, 40.0]), piece="", snap=False, reach=1.0)
    assert beside.piece == "P1"


def test_turned_freely_and_in_steps(skin):
    (sensor,) = skin.sensors[:1]
    middle = middle_of(sensor)
    held = grab([sensor], at=middle + np.array([10, 0]), turning=True)
    to = middle + 9 * np.array([np.cos(0.6), np.sin(0.6)])
    (free,), _ = held.moved(to, piece="P1", snap=False, reach=1.0)
    (stepped,), _ = held.moved(to, piece="P1", snap=True, reach=1.0)
    assert free.angle == pytest.approx(0.6) and np.degrees(stepped.angle) == pytest.approx(30) and middle_of(free) == pytest.approx(middle)
