"""Events out of places: each kind alone, and the seed's twirling."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.study import twirls
from skinfab.fingertip.array.tracking import Event, Place, Tracker, centre_of_pressure, matched_events


def follow(places: list[Place]) -> list[str]:
    return [event.kind for event in Tracker(12.7).follow(places)]


def path(axial: Callable[[float], float], *, rate: float = 10.0, seconds: float = 4.0, force: float = 1.0) -> list[Place]:
    return [Place(k / rate, axial(k / rate), 0.0, force) for k in range(round(seconds * rate))]


def test_a_contact_that_stands() -> None:
    rng = np.random.default_rng(0)
    assert follow(path(lambda t: 10.0 + 0.2 * rng.standard_normal())) == ["touch"]


@pytest.mark.parametrize("rate", [6.0, 15.0, 100.0])
def test_slow_is_rolling_and_fast_is_slipping_at_any_rate(rate: float) -> None:
    assert follow(path(lambda t: 10 + 4 * min(max(t - 1, 0), 2), rate=rate)) == ["touch", "roll"]
    assert follow(path(lambda t: 10 + 7 * min(max(8 * (t - 1), 0), 1), rate=rate)) == ["touch", "slip"]


def test_how_far_it_rolled() -> None:
    events = Tracker(12.7).follow([Place(k / 6, 10.0, 0.1 * min(max(k - 3, 0), 8), 1.0) for k in range(30)])
    roll = events[-1]
    assert roll.kind == "roll" and roll.around_mm == pytest.approx(0.8 * 12.7, abs=0.01) and roll.along_mm == 0
    assert roll.start == pytest.approx(0.5) and roll.end == pytest.approx(11 / 6)


def test_round_the_back_of_the_finger_is_no_slip() -> None:
    angles = np.linspace(math.pi - 0.3, math.pi + 0.3, 20)
    places = [Place(k / 10, 10.0, math.remainder(a, math.tau), 1.0) for k, a in enumerate(angles.tolist())]
    assert follow(places) == ["touch", "roll"]


def test_touch_and_lift_have_hysteresis() -> None:
    forces = [0.0, 0.09, 0.12, 0.08, 0.06, 0.11, 0.04, 0.0]
    events = Tracker(12.7).follow([Place(k / 10, 10.0, 0.0, f) for k, f in enumerate(forces)])
    assert [(event.kind, round(event.start, 1)) for event in events] == [("touch", 0.2), ("lift", 0.6)]


def test_unknown_places_are_passed_over() -> None:
    places = path(lambda t: 10.0)
    places[5] = Place(places[5].time, math.nan, math.nan, 1.0)
    assert follow(places) == ["touch"]


def test_a_new_contact_elsewhere_is_no_slip() -> None:
    places = path(lambda t: 5.0 if t < 1 else 20.0)
    places[10] = Place(1.0, math.nan, math.nan, 0.0)
    assert follow(places) == ["touch", "lift", "touch"]


def test_centre_of_pressure() -> None:
    Z = np.zeros((8, 8))
    Z[3, 0], Z[4, 7], Z[0, 4] = 1.0, 1.0, 0.2  # the last is far from the highest, and is left out
    assert centre_of_pressure(Z, Geometry()) == pytest.approx((3.5 * 3.7, -math.pi / 8))
    assert math.isnan(centre_of_pressure(np.full((8, 8), np.nan), Geometry())[0])


def test_events_are_matched_once() -> None:
    true = [Event("slip", 1.0, 1.2), Event("slip", 3.0, 3.2)]
    assert matched_events(true, [Event("slip", 1.1, 1.2), Event("slip", 1.15, 1.3), Event("roll", 3.0, 3.1)], slack=0.1) == [(0, 0)]


def test_twirling_as_the_seed_did() -> None:
    ours, published = twirls(range(4), published=False), twirls(range(4), published=True)
    for kind, each in ours.items():
        assert each.true > 0 and each.right == each.true == each.found, kind
        assert each.off_mm < 0.7  # of a roll of 5 to 15 mm
    assert published["slip"].found > published["slip"].true  # aliasing makes it jump while it rolls
