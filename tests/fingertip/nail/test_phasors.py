"""The lock-in against sines that are known, at every length, with gaps, at every frequency, and without the motor's phase."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.nail.phasors import blocks_of, find_drive, lock_in, reference_of, turned, turned_phasors

RATE = 1400.0


def wave(drive: np.ndarray, harmonic: np.ndarray, hz: float, samples: int, *, phase: float = 0.0, offset: float = 1.0) -> np.ndarray:
    """One window (1, samples, 6) whose phasors, from its middle, are these."""
    turn = np.exp(1j * (2 * np.pi * hz * (np.arange(samples) - (samples - 1) / 2) / RATE + phase))
    return (offset + np.real(turn[:, None] * drive + turn[:, None] ** 2 * harmonic))[None]


def phasor(rng: np.random.Generator) -> np.ndarray:
    return rng.standard_normal(6) + 1j * rng.standard_normal(6)


@settings(deadline=None)
@given(st.integers(8, 200), st.floats(100, 320), st.integers(0, 100))
def test_a_clean_wave_gives_its_phasors_at_any_length(samples: int, hz: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    drive, harmonic = phasor(rng), phasor(rng)
    found = lock_in(wave(drive, harmonic, hz, samples), RATE, hz)
    told_apart = np.abs(found.harmonic).max() > 0
    if told_apart:  # else the harmonic is left to the noise, and the drive is off by some of it
        np.testing.assert_allclose(found.drive[0], drive, atol=1e-8)
        np.testing.assert_allclose(found.harmonic[0], harmonic, atol=1e-8)
        assert found.noise.max() < 1e-6
    assert told_apart or samples < 14 or abs(hz - RATE / 4) < 3


def test_readings_that_are_left_out_change_nothing() -> None:
    rng = np.random.default_rng(0)
    drive, harmonic = phasor(rng), 0.1 * phasor(rng)
    values = wave(drive, harmonic, 169.0, 60)
    values[0, rng.uniform(size=(60, 6)) < 0.5] = np.nan
    np.testing.assert_allclose(lock_in(values, RATE, 169.0).drive[0], drive, atol=1e-9)


def test_a_channel_without_readings_is_nan_and_the_others_are_not() -> None:
    values = wave(np.ones(6) + 0j, np.zeros(6), 169.0, 33)
    values[0, :, 2] = np.nan
    values[0, 3:, 4] = np.nan
    found = lock_in(values, RATE, 169.0).drive[0]
    assert np.isnan(found[[2, 4]]).all() and np.allclose(found[[0, 1, 3, 5]], 1)


def test_noise_is_what_it_is_and_spreads_as_it_should() -> None:
    rng = np.random.default_rng(1)
    values = wave(np.ones(6) + 0j, np.zeros(6), 169.0, 64) + 0.1 * rng.standard_normal((2000, 64, 6))
    found = lock_in(values, RATE, 169.0)
    assert np.sqrt((found.noise**2).mean()) == pytest.approx(0.1, rel=0.01)
    assert found.drive.real.std() == pytest.approx(0.1 * np.sqrt(2 / 64), rel=0.03)


@pytest.mark.parametrize("hz", [100.0, 140.0, 169.0, 169.37, 175.0, 233.4, 280.0, 330.0])
@pytest.mark.parametrize("samples", [64, 100, 256, 1024])
def test_the_drive_is_found(hz: float, samples: int) -> None:
    rng = np.random.default_rng(2)
    scale = np.array([1, 1, 1, 100, 100, 100])  # units must not matter
    values = scale * wave(phasor(rng), 0.06 * phasor(rng), hz, samples, phase=1.0, offset=5.0)
    noisy = values + 0.1 * scale * rng.standard_normal(values.shape)
    assert find_drive(noisy, RATE)[0] == pytest.approx(hz, abs=60 / samples)


def test_the_drive_is_found_with_gaps_and_a_dead_channel() -> None:
    rng = np.random.default_rng(3)
    values = wave(phasor(rng), np.zeros(6), 171.0, 256)
    values[0, rng.uniform(size=(256, 6)) < 0.2] = np.nan
    values[..., 1] = np.nan
    assert find_drive(values, RATE)[0] == pytest.approx(171.0, abs=0.5)


def test_where_nothing_vibrates_no_frequency_is_found() -> None:
    assert np.isnan(find_drive(np.ones((1, 128, 6)), RATE)[0])
    assert np.isnan(find_drive(np.full((1, 128, 6), np.nan), RATE)[0])


def test_too_few_readings() -> None:
    with pytest.raises(InputError, match="7 readings is too short; 8"):
        lock_in(np.zeros((1, 7, 6)), RATE, 169.0)
    with pytest.raises(InputError, match="63 readings are too few to find"):
        find_drive(np.zeros((1, 63, 6)), RATE)
    with pytest.raises(InputError, match="sample faster"):
        find_drive(np.zeros((1, 64, 6)), 150.0)


@given(st.integers(0, 50), st.floats(0, 6.3))
def test_the_motors_phase_goes(seed: int, phase: float) -> None:
    rng = np.random.default_rng(seed)
    drive = phasor(rng)
    reference = reference_of(np.array([drive, phasor(rng), phasor(rng)]))
    np.testing.assert_allclose(turned(drive * np.exp(1j * phase), reference), turned(drive, reference), atol=1e-9)


def test_a_long_window_is_the_mean_of_its_blocks() -> None:
    rng = np.random.default_rng(4)
    drive = phasor(rng)
    values = wave(drive, np.zeros(6), 169.0, 1024)
    reference = reference_of(drive[None])
    found, _ = turned_phasors(values, RATE, 169.0, reference)
    np.testing.assert_allclose(found[0], turned(drive, reference), atol=1e-9)
    values[0, :500, 3] = np.nan  # three blocks are without it, the fourth almost
    found, _ = turned_phasors(values, RATE, 169.0, reference)
    assert np.isfinite(found).all()
    values[..., 3] = np.nan
    found, _ = turned_phasors(values, RATE, 169.0, reference)
    assert np.isnan(found[0, 3]) and np.isfinite(found[0, [0, 1, 2, 4, 5]]).all()


@given(st.integers(8, 2000))
def test_blocks_hold_nearly_all(samples: int) -> None:
    blocks = blocks_of(np.zeros((1, samples, 6)))
    assert blocks.shape[1] * blocks.shape[2] > samples - blocks.shape[1] and blocks.shape[2] >= min(samples, 128)
