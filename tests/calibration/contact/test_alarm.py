"""The threshold: the chain against sums that are run, and the rate of false alarms that was asked for against the one counted."""

import numpy as np
import pytest

from calibration.contact.alarm import ALLOWANCE, MOST_OF_THRESHOLD, alarm_for, run_length
from calibration.contact.detector import detect
from calibration.contact.score import poisson
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream

EIGHT = Stream("noise", tuple(Channel(f"S{j}") for j in range(8)), 100.0)


@pytest.mark.parametrize(("threshold", "scale", "shift"), [(1.0, 1.0, 0.0), (1.5, 1.2, 0.0), (2.0, 1.0, 0.3)])
def test_the_chain_is_what_sums_do(threshold: float, scale: float, shift: float) -> None:
    noise = shift + scale * np.random.default_rng(0).standard_normal((10_000, 200))
    cap = ALLOWANCE + MOST_OF_THRESHOLD * threshold
    total, alarms = np.zeros(200), 0
    for row in np.minimum(noise, cap) - ALLOWANCE:
        total = np.maximum(total + row, 0)
        alarms += int(np.count_nonzero(total >= threshold))
        total[total >= threshold] = 0
    counted = poisson(alarms, noise.size)
    expected = 1 / run_length(threshold, scale=scale, shift=shift)
    assert 0.9 * counted.low < expected < 1.1 * counted.high  # the chain's cells are good to a few per cent


def count(per_minute: float, noises: list[np.ndarray]) -> tuple[int, float]:
    found = [
        detect(Recording.of_values(EIGHT, 50 + 0.3 * each, device_time=np.arange(len(each)) / 100), false_alarms=per_minute)
        for each in noises
    ]
    return sum(len(each.contacts) for each in found), sum(len(each) / 6000 - 0.05 for each in noises)


@pytest.mark.parametrize("per_minute", [6.0, 0.5])
def test_false_alarms_as_stated(per_minute: float) -> None:
    noises = [np.random.default_rng(k).standard_normal((12_000, 8)) for k in range(60)]
    rate = poisson(*count(per_minute, noises))
    assert rate.low <= per_minute, f"stated {per_minute}, counted {rate}"
    assert rate.high >= per_minute / 2, f"stated {per_minute}, counted {rate}: more contacts than needed are missed"


def test_coloured_noise_alarms_no_more_often() -> None:
    from scipy.signal import lfilter

    white = [np.random.default_rng(k).standard_normal((12_000, 8)) for k in range(30)]
    coloured = [lfilter([0.8], [1, -0.6], each, axis=0) for each in white]
    assert poisson(*count(6.0, coloured)).low <= 6.0


def test_fewer_false_alarms_ask_for_more() -> None:
    thresholds = [alarm_for(rate, channels=8, rate_hz=100, still_frames=300).threshold for rate in (10, 1, 0.1, 0.01)]
    assert thresholds == sorted(thresholds) and thresholds[-1] < 6
    more = alarm_for(1, channels=32, rate_hz=100, still_frames=300).threshold
    assert more > thresholds[1]


def test_noise_that_is_known_badly_asks_for_more() -> None:
    well, badly = (alarm_for(1, channels=8, rate_hz=100, still_frames=n).threshold for n in (3000, 50))
    assert badly > well


@pytest.mark.parametrize("rate", [0.0, -1.0, float("nan"), float("inf"), 1e9, 1e-12])
def test_rates_that_cannot_be_had(rate: float) -> None:
    with pytest.raises(InputError, match="false alarms a minute cannot be"):
        alarm_for(rate, channels=8, rate_hz=100, still_frames=300)
