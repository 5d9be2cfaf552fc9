"""A channel at rest: its own noise, whatever its colour, and what is no rest."""

import numpy as np
import pytest
from scipy.signal import lfilter

from calibration.contact.rest import NOISE_FLOOR, at_rest

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
    ],
)
def test_motion_is_no_rest(moved: np.ndarray) -> None:
    assert at_rest(200 + 0.8 * NOISE[:300] + moved) is None


def test_nothing_but_zero_has_no_change() -> None:
    assert at_rest(np.zeros(300)) is None
