"""Periods counted by a clock that shakes, runs off its rate, stops and runs back."""

import numpy as np
import pytest

from calibration.control.lead import Lead
from calibration.control.pace import Pace


@pytest.mark.parametrize("late", [0.2, 0.45])
@pytest.mark.parametrize("rate", [98.0, 100.0, 102.0])
def test_frames_that_come_late_by_chance_are_one_period_each(rate: float, late: float) -> None:
    pace, rng = Pace(0.01, 0.1), np.random.default_rng(0)
    steps = [pace.steps(t) for t in np.arange(2000) / rate + 0.01 * late * rng.uniform(-1, 1, 2000)]
    assert steps[0] is None and set(steps[1:]) == {1}


def test_over_a_long_time_no_period_is_lost() -> None:
    """Every third frame is missing, and some come in twos."""
    pace = Pace(0.01, 0.1)
    times = [t for k in range(900) for t in ((k, k + 1e-3) if k % 7 == 0 else (k,)) if k % 3]
    steps = [pace.steps(0.01 * t) for t in times]
    assert steps[0] is None and 0 in steps and 2 in steps
    assert sum(each or 0 for each in steps) == pytest.approx(times[-1] - times[0], abs=1.5)


def test_a_hole_and_a_clock_that_runs_back_are_no_count() -> None:
    pace = Pace(0.01, 0.1)
    assert [pace.steps(t) for t in (0.0, 0.01, 0.2, 0.21, -5.0, -4.99)] == [None, 1, None, 1, None, 1]


def test_the_lead_takes_what_is_missing_for_straight() -> None:
    """Of a steady motion nothing is lost in a hole of eight frames; counted as one period it is a jerk."""
    whole, holed, blind = (Lead(0.05, 0.01) for _ in range(3))
    for k in range(100):
        for lead in (whole, holed, blind):
            lead.step(20.0 * k / 100)
    for k in range(100, 108):
        last = whole.step(20.0 * k / 100)
    assert holed.step(20.0 * 1.07, steps=8) == pytest.approx(last, abs=1e-9)
    assert blind.step(20.0 * 1.07)[1] > 40
    assert holed.step(99.0, steps=0) == pytest.approx(last, abs=1e-9)
    holed.restart()
    assert holed.step(50.0) == pytest.approx((50.0, 0.0, 0.0), abs=1e-9)
