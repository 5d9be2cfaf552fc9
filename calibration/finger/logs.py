"""Calibration logs of the simulated fingers, as a lab would record them of real ones: bend, stretch, bend, beside a true angle."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray

from calibration.finger.simulated import HUMAN, RATE_HZ, ROBOT, FingerSensor, Reader
from calibration.strain.calibrate import Calibration, calibrate
from calibration.strain.document import SensorCalibration
from calibration.strain.prepare import Prepared, prepare
from skinfab.readout.table import Table

FloatArray = NDArray[np.float64]

#: Degree of the paper's curves.
DEGREE = {HUMAN.name: 3, ROBOT.name: 4}
#: Cycles of a log and the highest angle, deg: with as many samples in range the paper's sums of squares come out too.
CYCLES = {HUMAN.name: 9, ROBOT.name: 3}
TOP_DEG = {HUMAN.name: 88.0, ROBOT.name: 85.0}

PERIOD_S = 8.0
LOW_DEG = 10.0
STILL_S = 0.5
#: Of the logs beside the scripts: one whose robot curve, like the paper's, hardly turns (others turn at 75 to 80 degrees).
SEED = 7
#: Nobody bends a finger to the same angle twice: standard deviation of the turning points, deg.
SCATTER_DEG = 1.0


def finger_log(sensor: FingerSensor, *, seed: int = SEED) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Time (s), true angle (deg) and reading (V), of a finger at rest, then of its cycles, then at rest.

    Examples
    --------
    >>> time, angle, volts = finger_log(ROBOT)
    >>> len(time), float(angle[0]), round(float(angle.max()))
    (2500, 10.89, 85)
    """
    rng = np.random.default_rng([seed, 0])
    n = CYCLES[sensor.name]
    tops = TOP_DEG[sensor.name] + SCATTER_DEG * rng.standard_normal(n)
    lows = LOW_DEG + np.abs(SCATTER_DEG * rng.standard_normal(n + 1))
    still = round(STILL_S * RATE_HZ)
    k, part = np.divmod(np.arange(round(n * PERIOD_S * RATE_HZ)) / RATE_HZ / PERIOD_S, 1.0)
    cycle = k.astype(int)
    low = np.where(part < 0.5, lows[cycle], lows[cycle + 1])
    moving = low + (tops[cycle] - low) * (1 - np.cos(2 * np.pi * part)) / 2
    # Logs hold a hundredth of a degree, and what is read must belong to what is written.
    angle = np.concatenate([np.full(still, lows[0]), moving, np.full(still, lows[n])]).round(2)
    time = np.arange(len(angle)) / RATE_HZ
    reader = Reader(sensor, 0.0, np.random.default_rng([seed, 1]))
    volts = np.array([reader.arrives(t, a)[1] for t, a in zip(time.tolist(), angle.tolist(), strict=True)])
    return time, angle, volts


def log_text(sensor: FingerSensor, *, seed: int = SEED) -> str:
    """The log as a CSV file that says what it is."""
    text = io.StringIO()
    text.write("# simulated: true\n")
    text.write(f"# made by: calibration/scripts/make_finger_logs.py, {sensor.name} finger of calibration/finger, seed {seed}\n")
    text.write(f"time_s,PIP_deg,{sensor.name}_V\n")
    for t, a, u in zip(*(each.tolist() for each in finger_log(sensor, seed=seed)), strict=True):
        text.write(f"{t:.2f},{a:.2f},{u:.5f}\n")
    return text.getvalue()


def prepared(sensor: FingerSensor, *, seed: int = SEED) -> Prepared:
    """A log ready to be fitted, without the way through a file."""
    time, angle, volts = finger_log(sensor, seed=seed)
    columns = {"PIP_deg": angle, f"{sensor.name}_V": volts.round(5)}
    table = Table(f"{sensor.name}_finger.csv", "", time, columns, {"simulated": "true"})
    return prepare(table, signal=f"{sensor.name}_V", angle="PIP_deg", limits=(10.0, 80.0))


def calibrated(sensor: FingerSensor, model: str, *, seed: int = SEED, log: Prepared | None = None) -> SensorCalibration:
    """A simulated finger's calibration with the paper's degree, as `skinfab calibrate` makes it of the log.

    Parameters
    ----------
    sensor : FingerSensor
        `HUMAN`, `ROBOT`, or one of them with a term left out.
    model : str
        One of `calibration.strain.models.MODELS`.
    seed : int
        Of the log.
    log : Prepared, optional
        What `prepared` gives, where that is there already.
    """
    log = log or prepared(sensor, seed=seed)
    found: Calibration = calibrate(log, model=model, degree=DEGREE[sensor.name])
    return SensorCalibration(
        found.model,
        f"{sensor.name}_V",
        "PIP_deg",
        log.u0,
        log.low,
        log.high,
        {"file": f"{sensor.name}_finger.csv", "simulated": True, "n": found.n, "seed": seed},
        "simulated",
        {"rms_deg": found.rms_deg, "held_out_rms_deg": found.scores[model].held_out_rms_deg},
    )
