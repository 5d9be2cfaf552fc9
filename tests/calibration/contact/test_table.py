"""Table II from one's own data, and the scale of fig. 6."""

import math

import numpy as np
import pytest

from calibration.contact.detector import detect
from calibration.contact.objects import OBJECTS, pads
from calibration.contact.simulator import Scene, simulate
from calibration.contact.table import contact_table, normalised
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
