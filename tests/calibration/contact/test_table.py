"""Table II from one's own data, and the scale of fig. 6."""

import math

import numpy as np
import pytest

from calibration.contact.detector import detect
from calibration.contact.objects import OBJECTS, pads
from calibration.contact.simulator import Scene, simulate
from calibration.contact.table import contact_table, normalised, unwatched
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream

#: As the paper's: one finger on a pad, and wires that hold.
STEADY = Scene(second=0, drop_outs_per_minute=0, creep=0, drift_per_minute=0)


@pytest.mark.parametrize("name", OBJECTS)
def test_the_table_is_the_seeds(name: str) -> None:
    logs = [simulate(name, seed=seed, scene=STEADY).recording for seed in range(5)]
    rows = contact_table([(each, detect(each)) for each in logs])
    for row, pad in zip(rows, pads(name), strict=True):
        assert row.r0 == pytest.approx(pad.r0, rel=2e-3) and (row.unit, row.trials) == ("kohm", 5)
        assert pad.touched is not None and pad.scatter is not None
        # Means of five or more touches a trial: their standard error, three times.
        assert row.touched == pytest.approx(pad.touched, abs=3 * pad.scatter / math.sqrt(row.contacts) + 0.02 * pad.r0)
        assert row.change == pytest.approx(row.touched / row.r0 - 1, abs=0.01) and 0 < row.scatter < 1.5 * pad.scatter + 0.02 * pad.r0


def made(*columns: np.ndarray) -> Recording:
    noise = np.random.default_rng(0).standard_normal((len(columns[0]), len(columns)))
    stream = Stream("skin", tuple(Channel(f"S{j + 1}", "V") for j in range(len(columns))), 100.0)
    return Recording.of_values(stream, np.column_stack(columns) + 0.01 * noise, device_time=np.arange(len(columns[0])) / 100)


def test_every_channel_goes_from_0_to_1() -> None:
    k = np.arange(1500)
    log = made(np.where((k > 500) & (k < 800), 3.0, 2.0), np.where((k > 600) & (k < 900), 1.5, 2.0), np.full(1500, 2.0))
    log.values[1000:1010, 0] = np.nan
    log.valid[1000:1010, 0] = False
    levels = normalised(log, detect(log))
    assert np.nanmin(levels) == 0 and np.nanmax(levels, axis=0).tolist() == [1, 1, 0]
    assert np.median(levels[510:790, 0]) == pytest.approx(1, abs=0.05) and np.median(levels[610:890, 1]) == pytest.approx(1, abs=0.1)
    assert np.isnan(levels[1000:1010, 0]).all() and not levels[:, 2].any()


def test_one_trial_has_no_scatter_and_no_contact_no_mean() -> None:
    k = np.arange(1500)
    log = made(np.where((k > 500) & (k < 800), 3.0, 2.0), np.full(1500, 2.0))
    touched, never = contact_table([(log, detect(log))])
    assert touched.touched == pytest.approx(3, abs=0.01) and math.isnan(touched.scatter) and touched.unit == "V"
    assert never.r0 == pytest.approx(2, abs=0.01) and math.isnan(never.touched) and (never.contacts, never.trials) == (0, 0)


def test_trials_of_two_objects_are_no_table() -> None:
    logs = [simulate(name).recording for name in ("cube", "cup")]
    with pytest.raises(InputError, match="cube has S1, S2, S3, S4, S5, S6 and cup has S1, S2, S3, S4"):
        contact_table([(each, detect(each)) for each in logs])


def test_a_channel_that_froze_is_in_the_table_and_not_in_the_picture() -> None:
    k = np.arange(1500)
    frozen = made(np.where((k > 500) & (k < 800), 3.0, 2.0), np.full(1500, 2.0))
    frozen.values[1000:, 0] = 2.0
    found = detect(frozen)
    well = made(np.where((k > 500) & (k < 800), 3.0, 2.0), np.full(1500, 2.0))
    first, second = contact_table([(frozen, found), (well, detect(well))])
    assert (first.state, second.state) == ("frozen in 1 of 2", "") and (first.contacts, first.trials) == (2, 2)
    assert (first.watched, second.watched) == (pytest.approx((0.467 + 0.8) / 2, abs=0.01), pytest.approx(0.8, abs=0.01))
    levels = normalised(frozen, found)
    assert np.isnan(levels[1005:, 0]).all() and np.isfinite(levels[:1000, 0]).all() and np.isfinite(levels[:, 1]).all()
    start, rest = unwatched(frozen, found, "S1")
    assert start == (0.0, pytest.approx(2.99)) and rest == (pytest.approx(10, abs=0.05), pytest.approx(14.99))
    assert unwatched(frozen, found, "S2") == [start]


def test_a_channel_of_no_use_is_never_watched_and_holes_are_not_either() -> None:
    k = np.arange(1500)
    log = made(np.full(1500, 2.0), np.full(1500, 2.0))
    log.values[:, 0] = 7.0
    log.device_time[k >= 800] += 5
    found = detect(log)
    assert unwatched(log, found, "S1") == [(0.0, pytest.approx(19.99))]
    assert unwatched(log, found, "S2") == [(0.0, pytest.approx(2.99)), (pytest.approx(7.99), pytest.approx(13.0))]
