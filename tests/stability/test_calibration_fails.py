"""Where fitting a strain sensor fails in the hands of the usual script, and what happens here instead."""

import numpy as np
import pytest

from calibration.strain.calibrate import calibrate, require_useful
from calibration.strain.clock import clock_facts
from calibration.strain.curve import fit_curve
from calibration.strain.models import MODELS, Samples
from calibration.strain.play import play
from calibration.strain.prepare import prepare
from skinfab.errors import InputError, RefusedError
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


def test_noise_alone_is_no_sensor_and_is_refused() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 0.01 * np.random.default_rng(0).standard_normal(len(TIME))
    log = prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80))
    found = calibrate(log)
    assert found.r2 < 0.05 and found.scores[found.model.name].held_out_rms_deg > 15
    with pytest.raises(RefusedError, match=r"is useless: on the half held out .* is it this joint's sensor"):
        require_useful(log, found)


@pytest.mark.parametrize(("late_s", "useful"), [(0.0, True), (0.3, True), (6.0, False)])
def test_clocks_that_are_seconds_apart_make_no_sensor(late_s: float, useful: bool) -> None:
    """The usual script writes down a curve with R2 0.2, and the joint is wrong from then on."""
    time = np.arange(6000) / 100
    angle = 45 + 25 * np.sin(1.1 * time + np.sin(0.7 * time)) + 15 * np.sin(2.1 * time)
    log = prepare(table(angle, 1 + 2e-3 * np.interp(time - late_s, time, angle), time), signal="U", angle="angle", limits=(10, 80))
    found = calibrate(log)
    if useful:
        require_useful(log, found)
    else:
        assert found.r2 < 0.5
        with pytest.raises(RefusedError, match="useless"):
            require_useful(log, found)


def test_an_open_wire_of_50_ms_ruins_the_usual_fit() -> None:
    time = np.arange(6000) / 100
    angle = 45 - 40 * np.cos(time)
    reading = 1 + 2e-3 * angle
    reading[1000:1005] = 60.0
    assert np.corrcoef(np.polyval(np.polyfit(angle, reading, 3), angle), reading)[0, 1] ** 2 < 0.1
    log = prepare(table(angle, reading, time), signal="U", angle="angle", limits=(10, 80))
    assert calibrate(log).r2 > 0.999 and any("row 1001" in note and "5 such rows are left out" in note for note in log.notes)


def test_one_way_back_in_a_fold_does_not_cost_a_model() -> None:
    """Half a log holds a single descent within the range: folds by time hold it out whole, and curves for both ways cannot be fitted."""
    time = np.arange(4000) / 100
    angle = np.interp(time, [0, 8, 9, 17, 20, 28, 29, 37, 40], [0, 90, 0, 90, 90, 0, 90, 0, 0])
    log = prepare(table(angle, 1 + 2e-3 * play(angle, 4.0), time), signal="U", angle="angle", limits=(10, 80))
    one_way = 0
    for fitted, _ in log.folds:
        try:
            MODELS["branches"].fit(fitted, degree=1)
        except InputError:
            one_way += 1
    assert one_way == 1
    found = calibrate(log)
    assert set(found.scores) == set(MODELS) and not any("left out" in note for note in found.notes)
    assert calibrate(log, model="branches").model.name == "branches"


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


def test_a_wrong_shift_looks_like_a_good_calibration_and_is_told() -> None:
    """0.3 s between the clocks of camera and board: models absorb it, R2 and the held-out error look well."""
    angle = 45 - 40 * np.cos(TIME + 0.6 * np.sin(TIME / 5))
    reading = 1 + 2e-3 * np.interp(TIME - 0.3, TIME, angle)
    log = prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80), u0=1.0)
    found = calibrate(log)
    assert found.r2 > 0.8 and min(score.held_out_rms_deg for score in found.scores.values()) < 2
    facts, notes = clock_facts(log)
    assert facts is not None and facts["lag_s"] == pytest.approx(0.3, abs=0.015)
    assert "the readings come 0.30 s after the angles" in notes[0] and "add 0.30 s to --shift of skinfab angle" in notes[0]


def test_a_sample_of_4e30_does_not_turn_the_curve() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 2e-3 * angle
    reading[100] = 4e30
    assert abs(np.polyfit(angle, reading, 1)[0]) > 1e20  # what a plain fit makes of it
    log = prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80))
    assert any("row 101: 'U' is 4e+30" in note and "the row is left out" in note for note in log.notes)
    assert calibrate(log).rms_deg < 0.5


def test_absurd_readings_for_a_while_are_refused() -> None:
    angle = 45 - 40 * np.cos(TIME)
    reading = 1 + 2e-3 * angle
    reading[1000:1100] = 4e30
    with pytest.raises(InputError, match=r"4e\+30 in row 1\d\d\d, a relative change of .*, which no sensor has"):
        prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80), u0=1.0)


@pytest.mark.parametrize(("rest", "refused"), [(0.004, False), (1e-4, True)])
def test_a_zeroed_log_is_told(rest: float, refused: bool) -> None:
    """Relative to next to nothing: 1 mV of drift of the reading at rest would move all angles by tens of degrees."""
    angle = np.maximum(45 - 45 * np.cos(TIME), 0)
    reading = rest + 2e-3 * angle
    if refused:
        with pytest.raises(InputError, match="which no sensor has; if the log was zeroed, add the reading at rest again"):
            prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80))
    else:
        log = prepare(table(angle, reading), signal="U", angle="angle", limits=(10, 80))
        assert any("was the log zeroed?" in note for note in log.notes)


def test_shuffled_rows_are_not_sorted_out_by_leaving_most_of_them_out() -> None:
    angle = 45 - 40 * np.cos(TIME)
    order = np.random.default_rng(0).permutation(len(TIME))
    rising = np.count_nonzero(TIME[order] >= np.maximum.accumulate(TIME[order]))
    assert rising < 20  # what leaving out rows that go back would keep of 3200
    with pytest.raises(InputError, match=r"rows are not in the order of time: row .* sort the rows by time"):
        prepare(table(angle[order], 1 + 2e-3 * angle[order], TIME[order]), signal="U", angle="angle", limits=(10, 80))


def test_a_board_that_restarts_loses_nothing() -> None:
    angle = 45 - 40 * np.cos(TIME)
    time = np.concatenate([TIME[:1600], TIME[:1600]])
    assert np.count_nonzero(time > np.r_[-1, np.maximum.accumulate(time)[:-1]]) == 1600  # rows that go back, left out: half of them
    log = prepare(table(angle, 1 + 2e-3 * angle, time), signal="U", angle="angle", limits=(10, 80))
    assert [len(run.time) for run in log.runs] == [1600, 1600]
    assert any("row 1601: times begin anew (15.99 to 0 s), as when the device restarts" in note for note in log.notes)
    assert calibrate(log).rms_deg < 0.5
