"""The clocks of a log: real knees are normal, a shift planted in them is found, and a short log says that it cannot be told."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibration.strain.clock import NORMAL_S, clock_facts, log_lag
from calibration.strain.models import Samples
from calibration.strain.prepare import Prepared, prepare
from skinfab.readout.table import Table, read_table

KNEES = Path(__file__).resolve().parents[4] / "shared/data/knee_stretch_sensor"


def ready(run: Samples) -> Prepared:
    return prepare(
        Table("log.csv", "", run.time, {"U": 1 + run.signal, "angle": run.angle}, {}), signal="U", angle="angle", limits=(10, 80), u0=1.0
    )


def knee(name: str, shift: float = 0.0) -> Prepared:
    path = KNEES / f"{name}.csv"
    if not path.exists():
        pytest.skip(f"{path} is not here")
    table = read_table(path)
    late = np.interp(table.time - shift, table.time, table.columns["Channel 0"])
    table = replace(table, columns=table.columns | {"Channel 0": late})
    return prepare(table, signal="Channel 0", angle="R_KNEE_FLX", limits=(-200, 200), u0=400.0)


@pytest.mark.parametrize("name", ["P001_FLEX", "P001_SQUAT", "P002_FLEX", "P002_SQUAT", "P005_FLEX", "P005_WALK1"])
def test_real_knees_are_normal(name: str) -> None:
    """Their readings come 0.06 to 0.01 s before the markers."""
    facts, notes = clock_facts(knee(name))
    assert facts is not None and not notes and NORMAL_S[0] < -0.07 < facts["lag_s"] < 0.0 < NORMAL_S[1]


@pytest.mark.parametrize(("name", "shift"), [("P001_FLEX", 0.3), ("P002_SQUAT", -0.3), ("P005_FLEX", -0.3)])
def test_a_shift_planted_in_real_knees_is_found_and_told(name: str, shift: float) -> None:
    own = log_lag(knee(name)).lag_s
    facts, notes = clock_facts(knee(name, shift))
    assert facts is not None and facts["lag_s"] - own == pytest.approx(shift, abs=0.03)
    assert "the clocks of camera and board do not agree" in notes[0]


@pytest.mark.parametrize("width", [0.0, 6.0])
def test_slack_is_no_lag(log: Callable[..., Samples], width: float) -> None:
    facts, notes = clock_facts(ready(log(width=width, noise=0.002, cycles=8, seconds=64, gait=0.8)))
    assert facts is not None and not notes
    assert abs(facts["lag_s"]) < 0.02 and facts["slack_deg"] == pytest.approx(width, abs=1)


def test_even_cycles_are_said_to_repeat(log: Callable[..., Samples]) -> None:
    facts, notes = clock_facts(ready(log(noise=0.002, cycles=16, seconds=32)))
    assert facts is not None and len(notes) == 1 and "the movement repeats" in notes[0] and facts["others_s"]


def test_too_short_to_tell_is_said(log: Callable[..., Samples]) -> None:
    facts, notes = clock_facts(ready(log(cycles=0.5)))
    assert facts is None and "could not be judged" in notes[0] and "strokes" in notes[0]
