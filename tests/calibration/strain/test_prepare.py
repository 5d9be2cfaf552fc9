"""Preparing a log: filter, gaps, rest, range and groups, and a sentence for whatever is left out."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibration.strain.models import Samples
from calibration.strain.prepare import PARTS, prepare
from skinfab.errors import InputError
from skinfab.readout.table import Table


def table(run: Samples, **more: np.ndarray) -> Table:
    return Table("log.csv", "0" * 64, run.time, {"U": 2.0 * (1 + run.signal), "angle": run.angle, **more}, {})


def test_relative_change_range_and_rate(log: Callable[..., Samples]) -> None:
    run = log()
    done = prepare(table(run), signal="U", angle="angle", limits=(20, 60))
    (only,) = done.runs
    assert done.rate_hz == pytest.approx(100) and done.n == np.count_nonzero(only.fit) and not done.notes
    assert only.angle[only.fit].min() >= 20 and only.angle[only.fit].max() <= 60
    u0 = 2.0 * (1 + run.signal[:20].mean())
    assert done.u0 == pytest.approx(u0, rel=1e-4)
    middle = slice(100, -100)
    np.testing.assert_allclose(only.signal[middle], (2 * (1 + run.signal[middle]) - u0) / u0, atol=2e-4)


def test_noise_is_filtered_without_delay(log: Callable[..., Samples]) -> None:
    clean, noisy = log(), log(noise=0.01)
    done = prepare(table(noisy), signal="U", angle="angle", limits=(10, 80), u0=2.0).runs[0]
    left = (done.signal - clean.signal)[100:-100]
    assert np.std(left) < 0.01 / 2.5  # 5 of 50 Hz are kept
    assert abs(np.mean(left * np.gradient(clean.signal)[100:-100])) < 1e-6


def test_the_log_is_cut_where_it_has_a_hole(log: Callable[..., Samples]) -> None:
    run = log()
    keep = np.ones(len(run.time), bool)
    keep[1000:1005] = False  # 0.06 s: bridged
    keep[2000:2100] = False  # 1 s: cut
    holed = Samples(run.time[keep], run.signal[keep], run.angle[keep], run.fit[keep])
    done = prepare(table(holed), signal="U", angle="angle", limits=(10, 80))
    assert [len(each.time) for each in done.runs] == [2000, 1100]


def test_empty_cells_and_rows_that_go_back_are_said(log: Callable[..., Samples]) -> None:
    run = log()
    time, signal = run.time.copy(), run.signal.copy()
    signal[500:503] = np.nan
    time[700] = time[600]
    done = prepare(table(replace(run, time=time, signal=signal)), signal="U", angle="angle", limits=(10, 80))
    assert any("1 of 3200 rows stand still or go back in time (row 701 first)" in note for note in done.notes)
    assert any("3 of 3200 rows have no reading or no angle" in note for note in done.notes)
    assert len(done.runs) == 1


def test_trials_are_kept_apart(log: Callable[..., Samples]) -> None:
    run = log()
    done = prepare(table(run, trial=np.repeat([1.0, 2, 3, 4], 800)), signal="U", angle="angle", limits=(10, 80))
    assert done.marked and len(done.runs) == 4 and done.halves == ((0, 1), (2, 3))
    assert [len(each.time) for each in done.only([1])] == [800] * 4
    assert [bool(each.fit.any()) for each in done.only([1])] == [False, True, False, False]


def test_halves_of_an_unmarked_log(log: Callable[..., Samples]) -> None:
    run = log()
    done = prepare(table(run), signal="U", angle="angle", limits=(10, 80))
    first, second = done.halves
    assert not done.marked and first == tuple(range(PARTS)) and second == tuple(range(PARTS, 2 * PARTS))
    (part,) = done.only(first)
    assert part.time[part.fit].max() < run.time[len(run.time) // 2]


def test_the_usual_range_where_there_is_one(log: Callable[..., Samples]) -> None:
    run = log()
    done = prepare(table(run), signal="U", angle="angle", limits=None)
    assert (done.low, done.high) == (10.0, 80.0)
    short = replace(run, angle=-run.angle)
    other = prepare(table(short), signal="U", angle="angle", limits=None)
    assert other.low == pytest.approx(-85, abs=0.2) and "not over the usual 10 to 80; all of them are fitted" in other.notes[0]


def test_a_joint_that_never_rests_is_said(log: Callable[..., Samples]) -> None:
    run = log(cycles=40)
    shifted = replace(run, time=run.time[:-55], signal=run.signal[55:], angle=run.angle[55:], fit=run.fit[55:])
    done = prepare(table(shifted), signal="U", angle="angle", limits=(10, 80))
    assert any("the joint never rests for 0.2 s" in note for note in done.notes)


@pytest.mark.parametrize(
    ("change", "options", "says"),
    [
        ({}, {"signal": "V"}, "no column 'V'; it has 'U', 'angle'"),
        ({}, {"angle": "U"}, "must be two columns"),
        ({"signal": np.zeros(3200)}, {}, "'U' never changes"),
        ({"angle": np.full(3200, 5.0)}, {}, "'angle' never changes"),
        ({}, {"limits": (100, 120)}, r"nothing of it lies within 100 to 120; give --range 5 85"),
        ({}, {"u0": 0.0}, "is 0 at rest"),
        ({"time": np.arange(3200) * 0.15}, {}, "sample faster or lower the cut-off"),
        ({"time": np.repeat(np.arange(320), 10) * 1.0 + np.tile(np.arange(10), 320) / 100}, {}, "long enough to be filtered at 5 Hz"),
        ({"signal": np.append([0.1, 0.2], np.full(3198, np.nan))}, {}, "fewer than 3 rows"),
    ],
)
def test_what_cannot_be_used(change: dict[str, np.ndarray], options: dict[str, object], says: str, log: Callable[..., Samples]) -> None:
    named = {"signal": "U", "angle": "angle", "limits": (10, 80)} | options
    with pytest.raises(InputError, match=says):
        prepare(table(replace(log(), **change)), **named)  # type: ignore[arg-type]
