"""The shift between a capture and a log: found wherever the two overlap, at rates that differ, and refused where it cannot be told."""

import numpy as np
import pytest

from calibration.mocap.shift import find_shift
from calibration.strain.play import play
from skinfab.errors import InputError

FloatArray = np.ndarray


def bent(t: FloatArray) -> FloatArray:
    """Quick and slow bends, by the camera's time."""
    return 45 - 38 * np.cos(0.9 * t + 2.5 * np.sin(t / 7))


def log(
    shift: float, *, seconds: float = 40.0, rate: float = 80.0, slack: float = 0.0, begins: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """A board's times and readings; the capture began `shift` after its first time."""
    time = np.arange(round(seconds * rate)) / rate + begins
    past = np.arange(-20, 120, 0.01)
    felt = play(bent(past), slack) if slack else bent(past)
    reading = 2.5 + np.interp(time - shift, past, 5e-3 * felt + 5e-5 * felt**2)
    return time, reading + 2e-3 * np.random.default_rng(0).standard_normal(len(time))


CAPTURE = np.arange(3600) / 120


@pytest.mark.parametrize("shift", [-12.0, -2.0, -0.05, 0.0, 0.05, 0.4, 7.13, 17.0])
def test_shifts_are_found(shift: float) -> None:
    found = find_shift(*log(shift), CAPTURE, bent(CAPTURE))
    assert found.lag_s == pytest.approx(shift, abs=0.015) and found.low_s <= shift <= found.high_s


def test_behind_slack() -> None:
    found = find_shift(*log(2.0, slack=8.0), CAPTURE, bent(CAPTURE))
    assert found.lag_s == pytest.approx(2.0, abs=0.02) and found.slack_deg == pytest.approx(8, abs=1)


@pytest.mark.parametrize("shift", [13.2, 13.5])
def test_behind_slack_with_half_in_common(shift: float) -> None:
    """Strokes with rests between: the slack is used up only at the first stroke, and what comes before counts as in common."""
    strokes = ((6.0, 60), (11.5, 50), (17.0, 60), (23.7, 60), (26.2, 60), (28.5, 70), (36.0, 60))

    def rests(t: FloatArray) -> FloatArray:
        return 8 + sum(high * np.exp(-(((t - at) / 0.7) ** 2)) for at, high in strokes)

    past, time, capture = np.arange(-20, 60, 0.01), np.arange(0, 30, 0.01), np.arange(0, 30, 1 / 120)
    noise = np.random.default_rng(0)
    reading = np.interp(time, past, 2e-3 * play(rests(past), 9.0)) + 2e-3 * noise.standard_normal(len(time))
    found = find_shift(time, reading, capture, rests(capture + shift) + 0.3 * noise.standard_normal(len(capture)))
    assert found.lag_s == pytest.approx(shift, abs=0.03) and found.low_s <= shift <= found.high_s
    assert found.slack_deg == pytest.approx(9, abs=1.5)


def test_over_gaps() -> None:
    time, reading = log(2.0)
    angle = bent(CAPTURE).copy()
    angle[500:700], reading[1500:1600] = np.nan, np.nan
    assert find_shift(time, reading, CAPTURE, angle).lag_s == pytest.approx(2.0, abs=0.015)


def test_rows_doubled_or_out_of_time_are_passed_over() -> None:
    time, reading = log(1.0)
    time, reading = np.insert(time, 900, time[899]), np.insert(reading, 900, 50.0)
    assert find_shift(time, reading, CAPTURE, bent(CAPTURE)).lag_s == pytest.approx(1.0, abs=0.015)


def test_a_periodic_movement_is_refused() -> None:
    time = np.arange(4000) / 100
    # Of even cycles a shift by half of one fits too; those nearest to 0 are named.
    with pytest.raises(
        InputError, match=r"the movement repeats, so that shifts of -?0.00, -?2.00, -?2.00, -?4.00 and -?4.00 s fit alike; give"
    ):
        find_shift(time, np.cos(2 * np.pi * time / 4), CAPTURE, 45 - 30 * np.cos(2 * np.pi * CAPTURE / 4))


def test_too_little_is_refused() -> None:
    time, reading = log(0.0)
    with pytest.raises(InputError, match="less than 5 degrees"):
        find_shift(time, reading, CAPTURE, np.full(3600, 30.0))
    with pytest.raises(InputError, match="too few to find a shift from"):
        find_shift(time, np.full(len(time), np.nan), CAPTURE, bent(CAPTURE))
    with pytest.raises(InputError, match="lets the reading follow the angle"):
        find_shift(time, np.random.default_rng(1).standard_normal(len(time)), CAPTURE, bent(CAPTURE))
