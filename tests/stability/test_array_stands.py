"""Fingers that do not move, on a tactel array: what noise makes of them, taken frame by frame, and what is told."""

import math

import numpy as np
import pytest

from skinfab.fingertip.array.certainty import of_points
from skinfab.fingertip.array.false_events import Stood, false_events
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.matched import ArrayModel, Contact, Matcher
from skinfab.fingertip.array.simulator import Skin
from skinfab.fingertip.array.tracking import Place, Tracker

SEED = Geometry()
MATCH = Matcher(ArrayModel.nominal(SEED), noise=2e-4)


def scattered(force: float, angle: float, count: int) -> tuple[list[Place], np.ndarray]:
    """Places of a finger that holds still at 12 mm, 15 a second, and how far around each is off, in its standard deviations."""
    rng, Z = np.random.default_rng(0), Skin(SEED).pressed(force, axial_mm=12.0, angle_rad=angle)
    places, off = [], []
    for k in range(count):
        frame = Z + 2e-4 * rng.standard_normal(SEED.shape)
        x, s, f, *_ = MATCH.one(frame)
        one = Contact(x, s / SEED.core_radius, f)
        (sd,) = of_points(frame, [one], MATCH.predicted, SEED, noise=2e-4)
        places.append(Place(k / 15, one.axial_mm, one.angle_rad, f, *sd))
        off.append((one.angle_rad - angle) * SEED.finger_radius / sd[1])
    return places, np.array(off)


def test_a_light_finger_over_a_stripe_does_not_slip() -> None:
    """0.2 N scatter by 0.7 mm around the finger there: at their face value places slip and roll a dozen times in ten seconds."""
    places, off = scattered(0.2, 0.0, 150)
    assert 0.6 < off.std() < 1.2 and np.abs(off).max() < 5  # it is known how surely they are told
    bare = [Place(each.time, each.axial_mm, each.angle_rad, each.force_n) for each in places]
    assert sum(event.kind in ("slip", "roll") for event in Tracker(12.7).follow(bare)) >= 10
    assert [event.kind for event in Tracker(12.7).follow(places)] == ["touch"]


@pytest.mark.parametrize(("force", "angle"), [(0.1, 0.1), (0.5, math.pi / 8), (1.0, 0.0)])
def test_it_is_known_how_surely_a_place_is_told(force: float, angle: float) -> None:
    _, off = scattered(force, angle, 60)
    assert off.std() < 1.3 and np.abs(off).max() < 5


@pytest.mark.parametrize("rate", [15.0, 200.0])
def test_fingers_that_hold_still_or_come_and_go(rate: float) -> None:
    for row in false_events(1, forces=(0.12, 0.3), rates=(rate,), frames=60, how=("still", "ramped")):
        assert row == Stood(row.how, row.force_n, rate, 1, touch=1, lift=1, slip=0, roll=0)


@pytest.mark.parametrize("rate", [15.0, 100.0])
def test_what_does_move_is_told_at_any_rate(rate: float) -> None:
    slipped, rolled = false_events(1, forces=(0.5,), rates=(rate,), how=("slipped", "rolled"))
    assert (slipped.touch, slipped.slip, slipped.roll, slipped.lift) == (1, 1, 0, 1)
    assert (rolled.touch, rolled.slip, rolled.roll, rolled.lift) == (1, 0, 1, 1)
