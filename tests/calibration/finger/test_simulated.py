"""The simulated finger: each term does what it says, and its logs give the paper's figures back."""

import hashlib
import runpy
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibration.finger.logs import DEGREE, prepared
from calibration.finger.simulated import HUMAN, RATE_HZ, ROBOT, Finger, FingerSensor, Plant, Reader
from calibration.strain.calibrate import calibrate
from calibration.strain.curve import fit_curve
from calibration.strain.prepare import Prepared, prepare
from skinfab.readout.table import read_table

ROOT = Path(__file__).resolve().parents[3]

#: As printed, section III.A: SSE, R2, least, mean and greatest sensitivity, 1/deg.
PAPER = {"human": (0.04, 0.94, 1.60e-4, 5.33e-4, 1.60e-3), "robot": (5.40, 0.86, 8.5e-5, 4.7e-3, 7.7e-3)}
#: To how many of its printed digits a figure is known.
ROUNDING = {"human": (0.005, 0.005, 5e-7, 5e-7, 5e-6), "robot": (0.005, 0.005, 5e-7, 5e-5, 5e-5)}


def figures(sensor: FingerSensor, seed: int) -> list[float]:
    found = calibrate(prepared(sensor, seed=seed), model="poly", degree=DEGREE[sensor.name])
    return [found.sse, found.r2, *found.sensitivity_per_deg]


@pytest.mark.parametrize("sensor", [HUMAN, ROBOT], ids=lambda sensor: sensor.name)
def test_logs_give_the_papers_figures(sensor: FingerSensor) -> None:
    """Each within two of the standard deviations that eight logs of the simulator have, or of its last printed digit."""
    found = np.array([figures(sensor, seed) for seed in range(8)])
    scatter = np.maximum(2 * found.std(axis=0, ddof=1), ROUNDING[sensor.name])
    np.testing.assert_array_less(np.abs(found.mean(axis=0) - PAPER[sensor.name]), scatter)
    log = prepared(sensor)
    assert max(float(run.signal.max()) for run in log.runs) == pytest.approx({"human": 0.04, "robot": 0.40}[sensor.name], rel=0.05)


def by_trial(log: Prepared, degree: int) -> np.ndarray:
    """Squared errors in dU/U0 of each trial's samples, of curves fitted to the other trials."""

    def samples(labels: list[int]) -> tuple[np.ndarray, np.ndarray]:
        runs = log.only(labels)
        return np.concatenate([run.angle[run.fit] for run in runs]), np.concatenate([run.signal[run.fit] for run in runs])

    errors = []
    for k in log.labels:
        angle, signal = samples([k])
        curve = fit_curve(*samples([j for j in log.labels if j != k]), degree=degree)
        errors.append(np.mean((signal - curve.signal(angle)) ** 2))
    return np.array(errors)


def errors_by_degree(name: str) -> dict[int, np.ndarray]:
    table = read_table(ROOT / f"calibration/logs/{name}_finger.csv")
    cycle = np.floor(np.maximum(table.time - 0.5, 0) / 8.0)
    marked = replace(table, columns=table.columns | {"trial": np.minimum(cycle, cycle[-60])})
    log = prepare(marked, signal=f"{name}_V", angle="PIP_deg", limits=(10.0, 80.0))
    return {degree: by_trial(log, degree) for degree in range(1, 7)}


def test_the_papers_degree_of_the_human_finger() -> None:
    """Two is not enough by far, and no higher one gains two per cent."""
    rms = {degree: float(np.sqrt(each.mean())) for degree, each in errors_by_degree("human").items()}
    assert rms[3] < 0.95 * rms[2] and min(rms.values()) > 0.98 * rms[3], rms


def test_the_papers_degree_of_the_robot_finger() -> None:
    """Of the least error on trials left out, in dU/U0, which is what the paper's R2 speaks of."""
    errors = errors_by_degree("robot")
    assert min(errors, key=lambda degree: errors[degree].mean()) == 4, errors


def test_logs_are_reproduced_byte_for_byte(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = ROOT / "calibration/scripts/make_finger_logs.py"
    monkeypatch.setattr(sys, "argv", [str(script), str(tmp_path)])
    runpy.run_path(str(script), run_name="__main__")
    for name in ("human", "robot"):
        made, kept = (folder / f"{name}_finger.csv" for folder in (tmp_path, ROOT / "calibration/logs"))
        assert hashlib.sha256(made.read_bytes()).digest() == hashlib.sha256(kept.read_bytes()).digest()
        assert kept.read_bytes().startswith(b"# simulated: true\n") and read_table(kept).simulated
        assert kept.stat().st_size < 200_000


def test_the_joint_lags_and_stops() -> None:
    finger = Finger(Plant(), seed=0)
    speeds = []
    for k in range(200):
        finger.step(k / RATE_HZ, 100.0)
        speeds.append(finger.speed)
    assert speeds[9] == pytest.approx(100 * (1 - np.exp(-1)))  # after one time constant
    assert finger.angle == 95.0 and finger.speed == 0.0
    at_once = Finger(Plant(lag_s=0.0), seed=0)
    at_once.step(0.0, 100.0)
    assert at_once.angle == pytest.approx(11.0)


def test_readings_are_late() -> None:
    reader = Reader(replace(ROBOT, noise=0.0, play_deg=0.0), 0.05, np.random.default_rng(0))
    frames = [reader.read(k / RATE_HZ, 20.0 + k) for k in range(12)]
    for k in (6, 11):
        assert frames[k].device_time == pytest.approx((k - 5) / RATE_HZ) and frames[k].host_time == k / RATE_HZ
        assert frames[k].values[0] == pytest.approx(1.5 * (1 + float(ROBOT.curve.signal(20.0 + k - 5))))
    assert [frame.sequence for frame in frames] == list(range(12)) and reader.stream.simulated


def test_slack_and_range() -> None:
    reader = Reader(replace(ROBOT, noise=0.0), 0.0, np.random.default_rng(0))
    volts = [float(reader.read(0.0, angle).values[0]) for angle in (40.0, 49.0, 31.0, 31.0 - 1e-3, 200.0, 300.0)]
    assert volts[0] == volts[1] == volts[2] > volts[3] and volts[4] == volts[5]


def test_a_reading_at_the_rail_is_saturated() -> None:
    frame = Reader(replace(ROBOT, u0=3.2), 0.0, np.random.default_rng(0)).read(0.0, 75.0)
    assert frame.saturated[0] and frame.values[0] == 3.3


def test_noise_is_of_its_size_and_of_its_seed() -> None:
    def noise(seed: int) -> np.ndarray:
        finger = Finger(Plant(delay_s=0.0), seed=seed, angle=45.0)
        return np.array([finger.step(k / RATE_HZ, 0.0).values[0] for k in range(2000)])

    assert float(noise(0).std()) / 1.5 == pytest.approx(ROBOT.noise, rel=0.05)
    assert (noise(0) == noise(0)).all() and (noise(0) != noise(1)).all()
