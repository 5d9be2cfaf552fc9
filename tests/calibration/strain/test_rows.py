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


def test_a_second_restart_is_said_in_the_logs_own_times() -> None:
    time = np.concatenate([np.arange(2000) / 100] * 3)
    assert all("begin anew (19.99 to 0 s)" in note for note in in_order(time, "a.csv")[1])


def rested() -> np.ndarray:
    """A joint that rests nearly all the time: its one movement is a thousand times the noise, and no spike."""
    values = 1 + 1e-4 * np.random.default_rng(0).standard_normal(2000)
    values[900:940] += 0.5 * np.sin(np.linspace(0, np.pi, 40))
    return values


def test_spikes_of_a_few_rows_alone() -> None:
    time, values = np.arange(2000) / 100, rested()
    assert not spikes(time, values).any()
    values[[300, 301, 302]], values[1500] = 40.0, -3e30
    values[700] = np.nan
    assert np.flatnonzero(spikes(time, values)).tolist() == [300, 301, 302, 1500]
    assert not spikes(time[:50], np.full(50, 3.0)).any() and not spikes(time[:2], np.array([1.0, 9e9])).any()


@pytest.mark.parametrize("rows", [1, 4, 5, 20, 50])
@pytest.mark.parametrize("reads", [60.0, -60.0])
def test_a_wire_open_for_up_to_half_a_second(rows: int, reads: float) -> None:
    time = np.arange(6000) / 100
    values = 1.5 + 0.1 * np.sin(time)
    values[1000 : 1000 + rows] = reads
    values[4000 : 4000 + rows] = -reads
    expected = [*range(1000, 1000 + rows), *range(4000, 4000 + rows)]
    assert np.flatnonzero(spikes(time, values)).tolist() == expected


def test_bursts_go_by_time_not_by_rows() -> None:
    """The same 0.4 s, recorded at 20 and at 1000 Hz; 2 s are none, for nobody would know what the log then is."""
    for rate in (20, 1000):
        time = np.arange(60 * rate) / rate
        open_wire = (time >= 10) & (time < 10.4)
        values = np.where(open_wire, 60.0, 1.5 + 0.1 * np.sin(time))
        assert np.array_equal(spikes(time, values), open_wire)
        long = (time >= 10) & (time < 12)
        assert not spikes(time, np.where(long, 60.0, 1.5 + 0.1 * np.sin(time)))[long].any()


def test_a_quick_movement_is_no_burst() -> None:
    """A joint that rests, and bends for 0.2 to 1 s by a thousand times the noise: it comes and goes by degrees."""
    time = np.arange(2000) / 100
    for length in (20, 50, 100):
        values = 1 + 1e-4 * np.random.default_rng(length).standard_normal(2000)
        values[900 : 900 + length] += 0.5 * np.sin(np.linspace(0, np.pi, length)) ** 2
        assert not spikes(time, values).any()
