"""Fingerprints of readings: those of a copy are alike whatever saved it, and those of two touches are not."""

import numpy as np
import pytest

from skinfab.fingertip.nail.prints import KEPT, kept_of, known, prints_of, shared
from skinfab.fingertip.nail.protocol import Protocol, session


@pytest.fixture(scope="module")
def trials() -> np.ndarray:
    return session("edges4", 1, protocol=Protocol(training=3, rounds=2, estimates=1, samples=256)).rounds.readings[:, 0]


@pytest.mark.parametrize("decimals", [3, 4, 6])
def test_a_copy_is_known_and_another_touch_is_not(trials: np.ndarray, decimals: int) -> None:
    kept = [view for each in trials[:4] for view in kept_of(each)]
    assert {len(each) for each in kept} == {KEPT}
    saved_anew = np.round(trials, decimals)
    assert [known(each, kept) for each in saved_anew] == [True] * 4 + [False] * 4
    assert known(saved_anew[0, 100:200], kept) and not known(saved_anew[5, 100:200], kept)  # a part of it, at other times


@pytest.mark.parametrize("put", [np.nan, 0.0, 1.25], ids=["blank", "zeros", "stuck"])
def test_a_copy_with_a_channel_that_differs_is_known(trials: np.ndarray, put: float) -> None:
    kept = [view for each in trials[:4] for view in kept_of(each)]
    for channel in range(6):
        changed = np.where(np.arange(6) == channel, put, trials)
        assert len(np.intersect1d(prints_of(changed[0]), prints_of(trials[0]))) < 5  # of 256, where all six are looked at together
        assert [known(each, kept) for each in changed] == [True] * 4 + [False] * 4


def test_pairs_that_share_readings(trials: np.ndarray) -> None:
    assert shared(list(trials)) == {}
    found = shared([trials[0], np.round(trials[1], 4), trials[1], trials[0, 128:], trials[2]])
    assert list(found) == [(0, 3), (1, 2)] and found[0, 3] == 0.5 and 0.8 < found[1, 2] <= 1


def test_a_sensor_that_hangs_makes_no_trials_alike() -> None:
    still = np.tile([0.0, 0.1, 0.9, 1.0, 2.0, 3.0], (100, 1))
    assert len(prints_of(still)) == 1 and not known(still, kept_of(still)) and shared([still, still]) == {}


def test_missing_readings() -> None:
    values = np.random.default_rng(0).normal(size=(50, 6))
    values[:10] = np.nan
    values[10:, 2] = np.nan
    assert len(prints_of(values)) == 40 and known(values, kept_of(values)) and len(prints_of(np.full((5, 6), np.nan))) == 0
