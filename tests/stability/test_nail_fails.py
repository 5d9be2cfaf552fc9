"""Where reading a shaken nail fails: what the naive way (histograms, one lock-in, zeros for a wire) does there, and what is done here."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.fingertip.nail.histogram_model import fit_histograms
from skinfab.fingertip.nail.improved import asked, frequency, learn
from skinfab.fingertip.nail.live import decide_log
from skinfab.fingertip.nail.phasors import find_drive, lock_in, lock_in_weights, turns
from skinfab.fingertip.nail.protocol import Protocol, Session, sessions
from skinfab.fingertip.nail.reader import Reader
from skinfab.fingertip.nail.simulator import RATE_HZ, Scene, nail_stream, readings
from skinfab.readout.frame import Recording

SMALL = Protocol(participants=3, training=5, rounds=5, estimates=1, samples=256)
CHANCE = 1 / 12


def people(protocol: Protocol = SMALL, scene: Scene | None = None) -> list[Session]:
    return list(sessions("edges12", protocol=protocol, scene=scene, seed=11))


@pytest.fixture(scope="module")
def usual() -> list[Session]:
    return people()


def published(each: Session, windows: np.ndarray | None = None, *, samples: int = 256) -> float:
    model = fit_histograms(learn(each).names, each.training.classes, each.training.readings[:, 0, :samples], rate_hz=RATE_HZ)
    return float((model.decide(each.rounds.readings[:, 0, :samples] if windows is None else windows) == each.rounds.classes).mean())


def improved(each: Session, samples: int = 256) -> float:
    model, windows = learn(each), asked(each, samples)
    return float((model.decide(windows, drive_hz=frequency(windows, model)).classes == each.rounds.classes).mean())


def mean(of: list[float]) -> float:
    return float(np.mean(of))


def test_one_turn_of_the_motor_is_too_little_for_a_histogram(usual: list[Session]) -> None:
    naive, whole = mean([published(each, samples=8) for each in usual]), mean([published(each) for each in usual])
    assert naive < whole - 0.08  # eight points in 36 bins
    assert mean([improved(each, 8) for each in usual]) > max(naive + 0.08, mean([improved(each) for each in usual]) - 0.08)


@pytest.mark.parametrize("hz", [175.0, RATE_HZ / 6])
def test_a_drive_that_divides_the_sampling_rate_leaves_few_phases(usual: list[Session], hz: float) -> None:
    there = people(scene=Scene(drive_hz=hz))
    period = round(RATE_HZ / hz)
    gyro = there[0].rounds.readings[0, 0, :, 3:]
    assert np.abs(gyro[period:] - gyro[:-period]).max() < 0.4 * np.abs(gyro).max()  # the same points again, but for noise
    naive = mean([published(each) for each in there])
    assert naive < mean([published(each) for each in usual]) - 0.03
    assert mean([improved(each) for each in there]) > max(naive + 0.08, mean([improved(each) for each in usual]) - 0.06)


def test_a_motor_that_drifts_leaves_a_lock_in_of_fixed_frequency(usual: list[Session]) -> None:
    fixed, followed = [], []
    for each in usual:
        model = learn(each)
        windows = readings(each.finger, each.rounds.touches, np.random.default_rng(0), samples=1024, drift_hz_per_s=5.0)
        naive = model.decide_phasors(lock_in(windows, RATE_HZ, model.drive_hz).drive, 1024)
        fixed.append(float((naive.classes == each.rounds.classes).mean()))
        followed.append(float((model.decide(windows, drive_hz=find_drive(windows, RATE_HZ)).classes == each.rounds.classes).mean()))
    assert mean(fixed) < 0.5 < mean([improved(each) for each in usual]) - 0.06 < mean(followed)


def test_a_dead_channel_read_as_zeros_spoils_all_the_others(usual: list[Session]) -> None:
    zeros, histograms, without = [], [], []
    for each in usual:
        model = learn(each)
        windows = each.rounds.readings[:, 0].copy()
        windows[..., 5] = 0.0
        histograms.append(published(each, windows))
        zeros.append(float((model.decide(windows[:, :33]).classes == each.rounds.classes).mean()))
        windows[..., 5] = np.nan  # what a frame without it says
        reader = Reader(model, 33)
        said = [reader.decide(window[:33]) for window in windows]
        assert {one.missing for one in said} == {("Gz",)}
        without.append(mean([one.label == model.names[k] for one, k in zip(said, each.rounds.classes, strict=True)]))
    assert mean(histograms) < 0.35 and mean(zeros) < mean(without) - 0.15
    assert mean(without) > mean([improved(each, 33) for each in usual]) - 0.1


def test_a_wave_cut_at_the_end_of_the_range_is_too_small() -> None:
    wave = 3.0 * np.cos(2 * np.pi * 169.0 * (np.arange(64) - 31.5) / RATE_HZ + 0.7)
    cut = np.clip(wave, -2.0, 2.0)
    naive = lock_in_weights(64, RATE_HZ, 169.0) @ cut
    assert abs(naive) < 0.87 * 3.0
    left = np.where(np.abs(cut) < 2.0, cut, np.nan)
    found = lock_in(np.repeat(left[None, :, None], 6, axis=2), RATE_HZ, 169.0).drive[0, 0]
    assert found == pytest.approx(3.0 * np.exp(0.7j), abs=1e-9)


def test_a_sensor_of_narrower_range_than_the_one_learned_with(usual: list[Session]) -> None:
    naive, left_out = [], []
    for each in usual:
        model, windows = learn(each), asked(each, 33)
        ends = 0.45 * np.abs(windows).max(axis=(0, 1))
        cut = np.clip(windows, -ends, ends)
        naive.append(float((model.decide(cut).classes == each.rounds.classes).mean()))
        reader = Reader(model, 33)
        said = [reader.decide(np.where(np.abs(one) < ends, one, np.nan)).label for one in cut]
        left_out.append(mean([name == model.names[k] for name, k in zip(said, each.rounds.classes, strict=True)]))
    assert mean(naive) < mean(left_out) - 0.05 and mean(left_out) > mean([improved(each, 33) for each in usual]) - 0.06


@pytest.mark.parametrize("training", [1, 2])
def test_few_trials(training: int) -> None:
    there = people(replace(SMALL, training=training))
    naive, done = mean([published(each) for each in there]), mean([improved(each) for each in there])
    assert 3 * CHANCE < naive < done - 0.03
    for each in there:  # with so few it must not be sure
        model = learn(each)
        sure = model.decide(asked(each), drive_hz=frequency(asked(each), model)).confidence
        assert sure.mean() < done + 0.25


def test_a_short_windows_noise_is_more_than_what_long_ones_were_learned_with() -> None:
    noisy = people(scene=replace(Scene(), noise_g=0.25, noise_dps=30.0))
    told, untold = [], []
    for each in noisy:
        model, windows = learn(each), asked(each, 8)
        deaf = replace(model, noise=np.zeros(6))
        told.append(float((model.decide(windows).classes == each.rounds.classes).mean()))
        untold.append(float((deaf.decide(windows).classes == each.rounds.classes).mean()))
    assert mean(untold) < mean(told) - 0.02


def test_a_second_harmonic_that_is_not_fitted_leaks_into_the_drive() -> None:
    time = (np.arange(14) - 6.5) / RATE_HZ
    turn = np.exp(2j * np.pi * 169.0 * time)
    wave = np.real(turn * np.exp(0.4j) + 0.1 * turn**2)  # 14 readings are 1.7 turns
    A = np.column_stack([np.ones(14), turn.real, -turn.imag])
    _, a, b = np.linalg.lstsq(A, wave, rcond=None)[0]
    assert abs((a + 1j * b) - np.exp(0.4j)) > 0.02
    assert lock_in_weights(14, RATE_HZ, 169.0) @ wave == pytest.approx(np.exp(0.4j), abs=1e-9)


def test_lost_frames_that_are_closed_up_make_the_phase_jump(usual: list[Session]) -> None:
    closed, kept_places = [], []
    for each in usual:
        model, windows = learn(each), asked(each, 256)
        kept = np.random.default_rng(0).uniform(size=256) > 0.15
        closed.append(
            float((model.decide(windows[:, kept], drive_hz=frequency(windows[:, kept], model)).classes == each.rounds.classes).mean())
        )
        holed = np.where(kept[:, None], windows, np.nan)
        kept_places.append(float((model.decide(holed, drive_hz=frequency(holed, model)).classes == each.rounds.classes).mean()))
    assert mean(closed) < mean(kept_places) - 0.15 and mean(kept_places) > mean([improved(each) for each in usual]) - 0.06


def test_a_motor_that_is_off_is_not_read_as_a_touch(usual: list[Session]) -> None:
    model = learn(usual[0])
    still = np.random.default_rng(0).normal(scale=0.02 * np.abs(usual[0].training.readings).max(axis=(0, 1, 2)), size=(60, 256, 6))
    assert model.decide(still).contact.mean() > 0.5  # what a model that only compares says of noise
    assert np.isnan(find_drive(still, RATE_HZ)).all() and np.isfinite(find_drive(asked(usual[0]), RATE_HZ)).all()


@pytest.mark.parametrize("samples", [200, 233])
def test_trials_put_together_to_one_log_jump_in_phase(usual: list[Session], samples: int) -> None:
    trials = usual[0].training.readings[:24, 0, :samples]  # each begins at a phase of its own
    values = trials.reshape(-1, 6)
    joints = np.array([values[k * samples - 32 : k * samples + 32] for k in range(1, 24)])
    assert turns(trials[:, :64], RATE_HZ, 169.0).all() and not turns(joints, RATE_HZ, 169.0).all()  # naive: it was switched off
    log = Recording.of_values(nail_stream(), values, device_time=np.arange(len(values)) / RATE_HZ)
    told, _ = decide_log(learn(usual[0]), log, samples=33, every=8)
    assert len(told) > 500 and all(each.turning is not False and each.decision is not None for each in told)
