"""The slow baseline: how far behind it stays, that it can be held, and that a spike or a hole does not move it."""

import numpy as np
import pytest

from skinfab.readout.drift import Baseline


def run(readings: np.ndarray, *, held: np.ndarray | None = None, reach: float = 1.0) -> np.ndarray:
    line = Baseline(readings[:1], time_constant=1.0, reach=np.array([reach]))
    hold = np.zeros(len(readings), bool) if held is None else held
    return np.array([line.step(np.array([x]), 0.01, held=np.array([h]))[0] for x, h in zip(readings, hold, strict=True)])


def test_a_drift_is_followed_by_rate_times_time_constant() -> None:
    time = np.arange(2000) / 100
    assert (0.05 * time - run(0.05 * time))[-1] == pytest.approx(0.05, rel=0.01)


def test_a_held_contact_is_not_followed_and_a_plain_high_pass_forgets_it() -> None:
    time = np.arange(4000) / 100
    touch = np.where((time > 5) & (time < 35), 0.5, 0.0)
    assert np.all((touch - run(touch, held=touch > 0))[touch > 0] == pytest.approx(0.5))
    assert (touch - run(touch))[3400] < 1e-9  # not held, it is a high-pass


def test_a_spike_moves_it_by_no_more_than_its_reach() -> None:
    readings = np.zeros(100)
    readings[50] = 1e6
    assert 0 < run(readings).max() < 0.011


def test_nothing_read_nothing_moved() -> None:
    assert np.all(run(np.concatenate([[2.0], np.full(50, np.nan)])) == 2.0)
