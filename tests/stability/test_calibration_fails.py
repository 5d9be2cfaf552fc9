"""Where fitting a strain sensor fails in the hands of the usual script, and what happens here instead."""

import numpy as np
import pytest

from calibration.strain.calibrate import calibrate
from calibration.strain.curve import fit_curve
from calibration.strain.models import MODELS, Samples
from calibration.strain.prepare import prepare
from skinfab.errors import InputError
from skinfab.readout.table import Table

TIME = np.arange(3200) / 100


def table(angle: np.ndarray, reading: np.ndarray, time: np.ndarray = TIME) -> Table:
    return Table("log.csv", "", time, {"U": reading, "angle": angle}, {})


def saturating(angle: np.ndarray) -> np.ndarray:
    """A sensor that stops short of the end of the range, as the paper's robot finger does above 80 degrees."""
    return 1 + 0.4 * np.minimum(angle, 55.0) / 80


def test_a_quartic_that_turns_has_two_angles_for_a_reading() -> None:
    angle = 45 - 35 * np.cos(TIME)
    signal = saturating(angle) - 1
    powers = np.polyfit(angle, signal, 4)
    roots = np.roots(np.polysub(powers, [0.278]))
    real = roots[(abs(roots.imag) < 1e-9) & (roots.real > 10) & (roots.real < 90)].real
    assert len(real) == 2 and np.ptp(real) > 8  # the plain inverse is anyone's guess
    curve = fit_curve(angle, signal, degree=4, monotone=True)
    estimate, outside = curve.angle(curve.signal(np.linspace(10, 60, 51)))
    np.testing.assert_allclose(estimate, np.linspace(10, 60, 51), atol=0.1)
    assert not outside[1:].any()


def test_the_user_is_told_where_it_turns() -> None:
    angle = 45 - 40 * np.cos(TIME)
    found = calibrate(prepare(table(angle, saturating(angle)), signal="U", angle="angle", limits=(10, 80)), degree=4)
    assert any("turns outside" in note and "two angles" in note for note in found.notes)
    assert found.model.curve.monotone


@pytest.mark.parametrize("name", MODELS)
def test_readings_beyond_the_curve_are_flagged_and_stay_finite(name: str) -> None:
    """A cubic goes off to any angle at all; this stays at the end of its range and says so."""
    angle = 45 - 40 * np.cos(TIME)
    run = Samples(TIME, 2e-3 * angle, angle, (angle >= 10) & (angle <= 80))
    model = MODELS[name].fit([run], degree=3)
    estimate, outside = model.estimate(TIME[:4], np.array([0.1, 5.0, -5.0, 0.1]))
    assert outside.tolist() == [False, True, True, False]
    assert np.all(estimate > -40) and np.all(estimate < 130)
    cubic = np.polyval(np.polyfit(run.signal, angle + 0.5 * np.sin(9 * TIME), 3), 5.0)
    assert not -40 < cubic < 130


def test_a_hole_in_the_log_does_not_become_a_motion() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 2e-3 * angle
    reading[1150:1400] = np.nan
    bridged = np.interp(TIME, TIME[np.isfinite(reading)], reading[np.isfinite(reading)])
    assert np.abs((bridged - 1) / 2e-3 - angle)[1150:1400].max() > 10  # what a straight line over 2.5 s says
    log = prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80), u0=1.0)
    for run in log.runs:
        np.testing.assert_allclose(run.signal[60:-60] / 2e-3, run.angle[60:-60], atol=0.5)
    assert len(log.runs) == 2


def test_noise_alone_is_no_sensor_and_the_figures_say_so() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 0.01 * np.random.default_rng(0).standard_normal(len(TIME))
    found = calibrate(prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80)))
    assert found.r2 < 0.05 and found.scores[found.model.name].held_out_rms_deg > 15


def test_spikes_that_are_not_finite_are_left_out() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 2e-3 * angle
    reading[[100, 900]] = np.inf
    found = calibrate(prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80)))
    assert found.rms_deg < 1 and any("2 of 3200 rows have no reading" in note for note in found.notes)


def test_a_log_of_one_cycle_is_not_overfitted_in_silence() -> None:
    angle = 45 - 40 * np.cos(2 * np.pi * TIME / 32)
    reading = 1 + 2e-3 * angle
    with pytest.raises(InputError, match=r"hardly ever (rise|fall)"):
        calibrate(prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80)), model="branches")
