"""The slow baseline: how far behind it stays, that it can be held, and that a spike does not move it."""

import numpy as np
import pytest

from skinfab.readout.drift import follow


def run(readings: np.ndarray, *, held: np.ndarray | None = None, reach: float = 1.0) -> np.ndarray:
    line = [float(readings[0])]
    hold = np.zeros(len(readings), bool) if held is None else held
    for x, h in zip(readings, hold, strict=True):
        line.append(line[-1] if h else follow(line[-1], x, 0.01, 1.0, reach))
    return np.array(line[1:])


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
