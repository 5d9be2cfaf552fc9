"""The rule by which a found contact is right, and an interval that holds what it says."""

import numpy as np
import pytest

from calibration.contact.detector import Contact
from calibration.contact.score import poisson, score


def made(*spans: tuple[float, float], channel: str = "S1", sign: int = 1) -> list[Contact]:
    return [Contact(channel, a, b, sign, 0.3) for a, b in spans]


def test_half_of_the_time_together_is_needed() -> None:
    truth = made((10, 12))
    assert score(made((10, 11.01)), truth, end=60).right == 1
    short = score(made((10, 10.99)), truth, end=60)
    assert short.right == 0 and short.false_alarms == 0  # wrong, but something was touched
    assert score(made((20, 21)), truth, end=60).false_alarms == 1
    assert score(made((10, 12), channel="S2"), truth, end=60).false_alarms == 1


def test_each_is_matched_once_and_the_best_first() -> None:
    found = score(made((10, 12.2), (10.3, 12)), made((10, 12)), end=60)
    assert (found.right, found.found, found.true) == (1, 2, 1) and found.end_errors == pytest.approx(
        (0.2,)
    )  # 0.91 against 0.85 of the time


def test_what_lasts_ends_with_the_trial() -> None:
    found = score(made((10, float("nan"))), made((10, 59)), end=60)
    assert found.right == 1 and found.end_errors == pytest.approx((1.0,))


def test_the_sign_is_judged_apart() -> None:
    found = score(made((10, 12), sign=-1), made((10, 12)), end=60)
    assert (found.right, found.right_sign) == (1, 0)


def test_the_interval_of_a_count_holds_the_truth_as_often_as_it_says() -> None:
    rates = [poisson(int(k), 30.0) for k in np.random.default_rng(0).poisson(3.0, 2000)]
    assert np.mean([rate.low <= 0.1 <= rate.high for rate in rates]) > 0.95
