"""The logs beside the scripts: what the script writes, labelled, and fit for what they show."""

import csv
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from calibration.contact.detector import Contact, detect
from calibration.contact.score import score
from skinfab.readout.logs.log import read_log

ROOT = Path(__file__).resolve().parents[3]
LOGS = ROOT / "calibration/logs"


def test_the_script_writes_them_again(tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, str(ROOT / "calibration/scripts/make_contact_logs.py"), str(tmp_path)],
        check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    for seed in (1, 2):
        again, there = (read_log(folder / f"contact_cube_{seed}.csv").recording for folder in (tmp_path, LOGS))
        assert again.stream == there.stream and np.array_equal(again.valid, there.valid)
        np.testing.assert_allclose(again.values[again.valid], there.values[there.valid], rtol=2e-3)
        assert (tmp_path / f"contact_cube_{seed}_truth.csv").read_text() == (LOGS / f"contact_cube_{seed}_truth.csv").read_text()


@pytest.mark.parametrize("seed", [1, 2])
def test_they_say_simulated_and_are_found(seed: int) -> None:
    log = read_log(LOGS / f"contact_cube_{seed}.csv").recording
    assert log.stream.simulated and "# simulated: true" in (LOGS / f"contact_cube_{seed}.csv").read_text()[:60]
    text = (LOGS / f"contact_cube_{seed}_truth.csv").read_text().splitlines()
    truth = [
        Contact(row["channel"], float(row["start_s"]), float(row["end_s"]), int(row["sign"]), float(row["strength"]))
        for row in csv.DictReader(text)
        if row["simulated"] == "1"
    ]
    found = score(detect(log).contacts, truth, end=float(log.device_time[-1]))
    assert found.right >= 0.9 * found.true and found.right >= 0.9 * found.found
