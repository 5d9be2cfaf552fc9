"""Rows: shuffled ones are refused, a restart becomes a hole, and a spike is told from a movement."""

import numpy as np
import pytest

from calibration.strain.rows import RESTART_S, in_order, spikes
from skinfab.errors import InputError


def test_what_is_in_order_stays() -> None:
    time = np.arange(100) / 100
    anew, notes = in_order(time, "a.csv")
    assert np.array_equal(anew, time) and not notes


def test_a_single_late_row_is_no_restart() -> None:
    time = np.arange(100) / 100
    time[50] = 0.3
    anew, notes = in_order(time, "a.csv")
    assert np.array_equal(anew, time) and not notes


def test_two_restarts() -> None:
    time = np.concatenate([np.arange(300) / 100, np.arange(200) / 100, 0.5 + np.arange(400) / 100])
    anew, notes = in_order(time, "a.csv")
    steps = np.diff(anew)
    assert np.flatnonzero(steps > 0.5).tolist() == [299, 499] and np.allclose(steps[[299, 499]], RESTART_S) and steps.min() > 0
    assert [note.partition(":")[0] for note in notes] == ["a.csv, row 301", "a.csv, row 501"]


@pytest.mark.parametrize("order", ["shuffled", "reversed"])
def test_rows_out_of_order_are_refused(order: str) -> None:
    time = np.arange(1000) / 100
    time = np.random.default_rng(0).permutation(time) if order == "shuffled" else time[::-1]
    first = int(np.argmax(np.diff(time) < 0)) + 2
    with pytest.raises(InputError, match=rf"not in the order of time: row {first} is of .* sort the rows by time"):
        in_order(time, "a.csv")


def test_spikes_of_a_few_rows_alone() -> None:
    rng = np.random.default_rng(0)
    # A joint that rests nearly all the time: its one movement is a thousand times the noise, and no spike.
    values = 1 + 1e-4 * rng.standard_normal(2000)
    values[900:940] += 0.5 * np.sin(np.linspace(0, np.pi, 40))
    assert not spikes(values).any()
    values[[300, 301, 302]], values[1500] = 40.0, -3e30
    values[700] = np.nan
    assert np.flatnonzero(spikes(values)).tolist() == [300, 301, 302, 1500]
    assert not spikes(np.full(50, 3.0)).any() and not spikes(np.array([1.0, 9e9])).any()
