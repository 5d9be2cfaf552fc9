"""Intervals hold what they say."""

import numpy as np

from skinfab.rates import by_trial, wilson


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    right = np.random.default_rng(0).binomial(60, 0.95, 2000)
    rates = [wilson(int(k), 60) for k in right]
    assert 0.93 < np.mean([rate.low <= 0.95 <= rate.high for rate in rates]) < 0.98


def test_trials_that_differ_widen_the_interval() -> None:
    even, uneven = by_trial([9] * 10, [10] * 10), by_trial([10] * 5 + [8] * 5, [10] * 10)
    assert even.value == uneven.value == 0.9 and uneven.low <= even.low
    assert by_trial([10] * 5, [10] * 5).low < 0.95  # no error seen is not no error


def test_nothing_is_known_of_nothing() -> None:
    rate = by_trial([0, 0], [0, 0])
    assert np.isnan(rate.value) and (rate.low, rate.high) == (0, 1)
