"""Probabilities from distances: what is held out decides how sure, a lapse leaves something for every class."""

import numpy as np
import pytest

from skinfab.fingertip.nail.confidence import LAPSE, UNKNOWN, probabilities, temperature_of


def drawn(spread: float, *, count: int = 300, outliers: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Squared distances from six classes, by a scatter of 1, of trials that scatter by `spread`."""
    rng = np.random.default_rng(4)
    means, column = 2.2 * np.eye(6), rng.integers(6, size=count)
    x = means[column] + spread * rng.standard_normal((count, 6))
    x[:outliers] += 40.0 * np.eye(6)[(column[:outliers] + 1) % 6]  # far off, towards another class
    return ((x[:, None] - means) ** 2).sum(axis=2), column


def test_each_class_keeps_something_and_all_add_up() -> None:
    squared, _ = drawn(1.0)
    found = probabilities(np.vstack([squared, [0.0, *[1e9] * 5]]), 1.0)
    np.testing.assert_allclose(found.sum(axis=1), 1)
    assert found.min() == pytest.approx(LAPSE / 6) and found[-1, 0] == pytest.approx(1 - LAPSE + LAPSE / 6)
    np.testing.assert_array_equal(found.argmax(axis=1)[:-1], squared.argmin(axis=1))


@pytest.mark.parametrize("spread", [1.0, 1.5, 2.0])
def test_as_wide_as_the_trials_scatter(spread: float) -> None:
    assert temperature_of(*drawn(spread)) == pytest.approx(spread**2, rel=0.25)


def test_a_few_that_lie_far_off_do_not_make_it_unsure_of_all_others() -> None:
    without, with_them = temperature_of(*drawn(1.0)), temperature_of(*drawn(1.0, outliers=6))
    assert with_them < 1.6 * without
    squared, column = drawn(1.0, outliers=6)
    rows = np.arange(len(column))
    tried = np.geomspace(0.7, 12, 25)

    def plain(temperature: float) -> float:  # likelihood without a lapse
        weight = np.exp((squared.min(axis=1, keepdims=True) - squared) / (2 * temperature))
        return float(-np.log(weight[rows, column] / weight.sum(axis=1) + 1e-300).sum())

    assert tried[np.argmin([plain(t) for t in tried])] > 2.5 * without


def test_nothing_known_is_least_sure() -> None:
    squared, column = drawn(30.0)
    assert 0.6 * UNKNOWN < temperature_of(squared, column) <= UNKNOWN
