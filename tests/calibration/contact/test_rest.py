"""A channel at rest: its own noise, whatever its colour, and what is no rest."""

import numpy as np
import pytest
from scipy.signal import lfilter

from calibration.contact.rest import NOISE_FLOOR, at_rest, patience

NOISE = np.random.default_rng(3).standard_normal(3000)


def test_level_and_noise_of_white_noise() -> None:
    found = at_rest(200 + 0.8 * NOISE)
    assert found is not None and found.level == pytest.approx(200, abs=0.05) and found.noise == pytest.approx(0.8, rel=0.05)


def test_a_drift_is_no_noise() -> None:
    found = at_rest(200 + 0.8 * NOISE + np.linspace(-2, 2, 3000))
    assert found is not None and found.noise == pytest.approx(0.8, rel=0.05)


def test_sums_of_coloured_noise_vary_more() -> None:
    coloured = lfilter([np.sqrt(1 - 0.5**2)], [1, -0.5], NOISE)
    found = at_rest(200 + 0.8 * coloured)
    assert found is not None and found.noise == pytest.approx(0.8 * np.sqrt(3), rel=0.1)


@pytest.mark.parametrize("step", [0.0, 0.01])
def test_a_quiet_channel_has_the_least_noise(step: float) -> None:
    found = at_rest(np.full(300, 200.0) + step * np.round(NOISE[:300]))
    assert found is not None and found.noise == pytest.approx(200 * NOISE_FLOOR)


@pytest.mark.parametrize(
    "moved",
    [
        np.where(np.arange(300) > 150, 30.0, 0.0),  # touched, and held
        np.where(abs(np.arange(300) - 150) < 10, 30.0, 0.0),  # tapped
        20 * np.sin(np.arange(300) / 20),
        3.0 * np.exp(-np.arange(300) / 100),  # creeps back from a touch before
    ],
)
def test_motion_is_no_rest(moved: np.ndarray) -> None:
    assert at_rest(200 + 0.8 * NOISE[:300] + moved) is None


def test_nothing_but_zero_has_no_change() -> None:
    assert at_rest(np.zeros(300)) is None


def test_a_coarse_converter_rests() -> None:
    for step in (1.0, 2.0, 4.0):
        found = at_rest(np.round((200 + 0.8 * NOISE) / step) * step)
        assert found is not None and 0.2 < found.noise < 1.5


def test_white_noise_is_at_rest() -> None:
    windows = np.random.default_rng(8).standard_normal((2000, 300))
    assert sum(at_rest(200 + 0.8 * window) is None for window in windows) <= 3


def test_the_wait_for_a_frozen_channel_grows_with_its_steps_and_its_colour() -> None:
    waits = []
    for step in (0.01, 1.4, 1.6):
        window = np.round((200 + 0.8 * NOISE[:300]) / step) * step
        found = at_rest(window)
        assert found is not None
        waits.append(patience(window, found, rate_hz=100.0).frames)
    assert waits[0] == 100 < waits[1] < waits[2]
    still = at_rest(np.full(300, 5.0))
    assert still is not None and patience(np.full(300, 5.0), still, rate_hz=100.0).frames == np.inf
