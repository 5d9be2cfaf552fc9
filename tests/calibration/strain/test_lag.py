"""Planted lags are found within a sample, behind slack too; the interval holds them; and what repeats is said to repeat."""

from collections.abc import Callable

import numpy as np
import pytest

from calibration.strain.correlation import STEP_S, Pair
from calibration.strain.lag import find_lag
from calibration.strain.play import play
from skinfab.errors import InputError

FloatArray = np.ndarray
TIME = np.arange(0, 60, STEP_S)
#: From before the log to after it, so that what lies behind slack has a past.
LONG = np.arange(-5, 66, STEP_S)


def irregular(t: FloatArray) -> FloatArray:
    return 45 - 40 * np.cos(2 * np.pi * t / 8 - 3.2 * np.sin(2 * np.pi * t / 32))


def periodic(t: FloatArray) -> FloatArray:
    return 45 - 40 * np.cos(2 * np.pi * t / 4)


def pair(
    lag: float, *, moves: Callable[[FloatArray], FloatArray] = irregular, slack: float = 0.0, noise: float = 2e-3, seed: int = 0
) -> Pair:
    felt = play(moves(LONG), slack) if slack else moves(LONG)
    reading = np.interp(TIME - lag, LONG, 2e-3 * felt + 2e-5 * felt**2)
    reading += noise * np.random.default_rng(seed).standard_normal(len(TIME))
    return Pair(0.0, moves(TIME), np.ones(len(TIME), bool), 0.0, reading, (TIME >= 2.5) & (TIME <= 57.5))


@pytest.mark.parametrize(("lag", "slack"), [(-2.0, 4.0), (-0.3, 9.0), (-0.05, 0.0), (0.0, 9.0), (0.05, 4.0), (0.3, 0.0), (2.0, 9.0)])
def test_a_planted_lag_is_found_within_a_sample(lag: float, slack: float) -> None:
    found = find_lag([pair(lag, slack=slack)], (-2.5, 2.5))
    assert found.lag_s == pytest.approx(lag, abs=STEP_S) and found.slack_deg == pytest.approx(slack, abs=1.0)
    assert found.low_s <= lag <= found.high_s and found.high_s - found.low_s < 0.1 and not found.others_s


def test_a_curve_alone_takes_slack_for_lag() -> None:
    """Why slack is told apart: behind 9 degrees of it the best shift of a curve without memory is 0.2 s wrong."""
    made = pair(0.0, slack=9.0)
    lags = np.arange(-50, 51)
    i = np.arange(300, 5700)
    left = [np.polyfit(made.angle[i - k] / 50, made.reading[i], 4, full=True)[1][0] for k in lags]
    assert lags[int(np.argmin(left))] * STEP_S > 0.15
    assert abs(find_lag([made], (-2.5, 2.5)).lag_s) < STEP_S


def test_the_interval_holds_the_truth_as_often_as_it_says() -> None:
    """Noise that hangs together, as skin over a joint makes it: naive intervals would be ten times too short."""
    held, widths = 0, []
    for seed in range(8):
        made = pair(0.3, noise=0.0)
        drift = np.convolve(np.random.default_rng(seed).standard_normal(len(TIME) + 400), np.hanning(401), "valid")
        wild = Pair(0.0, made.angle, made.angle_known, 0.0, made.reading + 0.02 * drift / drift.std(), made.reading_counts)
        found = find_lag([wild], (-1, 1))
        held += found.low_s <= 0.3 <= found.high_s
        widths.append(found.high_s - found.low_s)
    assert held >= 6 and np.median(widths) < 0.3  # 95 % of 8: fewer than 6 in one run of 170


@pytest.mark.parametrize("lag", [0.0, 0.3, -0.3])
def test_a_periodic_movement_is_said_to_repeat(lag: float) -> None:
    found = find_lag([pair(lag, moves=periodic)], (-2.5, 2.5), near_zero=True)
    assert found.lag_s == pytest.approx(lag, abs=STEP_S)
    # A curve that falls fits half a period away as well as one that rises here.
    assert found.others_s and all(min(abs(each - lag) % 2, 2 - abs(each - lag) % 2) < 2 * STEP_S for each in found.others_s)


def test_clocks_that_do_not_begin_together() -> None:
    made = pair(0.3)
    later = Pair(100.0, made.angle, made.angle_known, 3.0, made.reading[300:], made.reading_counts[300:])
    assert find_lag([later], (-102, -97)).lag_s == pytest.approx(0.3 - 100, abs=STEP_S)


def test_gaps_do_no_harm() -> None:
    made = pair(0.3, slack=4.0)
    angle_known, counts, reading = made.angle_known.copy(), made.reading_counts.copy(), made.reading.copy()
    angle_known[1000:1200], counts[3000:3300] = False, False
    reading[3000:3300] = 99.0
    assert find_lag([Pair(0.0, made.angle, angle_known, 0.0, reading, counts)], (-1, 1)).lag_s == pytest.approx(0.3, abs=STEP_S)


@pytest.mark.parametrize(
    ("moves", "says"),
    [
        (lambda t: 45 + 0 * t, "less than 5 degrees"),
        (lambda t: 45 - 40 * np.cos(2 * np.pi * t / 90), "it takes 3 strokes"),
        (lambda t: irregular(1.37 * t + 50)[::-1], "is it this joint's sensor"),
    ],
)
def test_what_tells_no_lag(moves: Callable[[FloatArray], FloatArray], says: str) -> None:
    made = pair(0.0, noise=0.02) if "sensor" in says else pair(0.0, moves=moves)
    with pytest.raises(InputError, match=says):
        find_lag([Pair(0.0, moves(TIME), made.angle_known, 0.0, made.reading, made.reading_counts)], (-1, 1))
