"""Where lost frames lie by times that jitter, stop or come in bunches: where a gap lasts, and nowhere else."""

import numpy as np
import pytest

from skinfab.fingertip.nail.pace import pace_of
from skinfab.fingertip.nail.places import lasting, places_of, times_of
from skinfab.readout.frame import Channel, Recording, Stream

RATE = 1400.0
EVEN = np.arange(7000) / RATE
LOST = np.random.default_rng(0).uniform(size=len(EVEN)) < 0.02
LOST[0] = False
GAP = np.zeros(len(EVEN), dtype=bool)
GAP[3000:3300] = GAP[5000] = True


def log(time: np.ndarray) -> Recording:
    return Recording.of_values(Stream("s", (Channel("Ax"),)), np.zeros((len(time), 1)), device_time=time)


def off_by(recording: Recording, lost: np.ndarray, rate: float | None) -> np.ndarray:
    pace = pace_of(recording, rate_hz=rate)
    places = places_of(recording, pace)
    away: np.ndarray = places - np.flatnonzero(~lost)
    assert np.abs(times_of(recording, places, pace) - EVEN[~lost]).max() < 0.012
    return away


@pytest.mark.parametrize("spread_s", [1e-4, 2e-4, 5e-4])
@pytest.mark.parametrize("lost", [LOST, GAP], ids=["one in fifty", "a gap and one"])
def test_jitter(spread_s: float, lost: np.ndarray) -> None:
    recording = log(np.sort((EVEN + np.random.default_rng(1).normal(0, spread_s, len(EVEN)))[~lost]))
    steps = np.rint(np.diff(recording.device_time) * RATE)
    assert np.maximum(steps, 1).sum() - (~lost).sum() > lost.sum() + 20  # by single steps: many that were not lost
    assert np.abs(off_by(recording, lost, RATE)).max() <= 3


def test_a_gap_is_seen_where_the_rate_is_not_known() -> None:
    recording = log(np.sort((EVEN + np.random.default_rng(1).normal(0, 2e-4, len(EVEN)))[~GAP]))
    assert pace_of(recording).rate_hz == pytest.approx(RATE, rel=1e-3) and np.abs(off_by(recording, GAP, None)).max() <= 1


def test_bunches_tell_lost_frames_to_some_bunches() -> None:
    fetched = np.floor(EVEN / 0.01) * 0.01
    recording = log(fetched[~LOST])
    away = off_by(recording, LOST, RATE)
    assert np.abs(away).max() <= 12  # closed up they would be 140 off
    (note,) = pace_of(recording, rate_hz=RATE).notes
    assert "such times tell their places to some bunches" in note
    free = pace_of(recording)
    assert free.rate_hz == pytest.approx(0.98 * RATE, rel=0.005) and not free.known and free.loose_s == pytest.approx(0.01, rel=0.1)


def test_what_is_made_up_for_does_not_last() -> None:
    steps = np.ones(400)
    steps[50], steps[51:80] = 30.0, 0.0
    steps[100], steps[101:180] = 80.0, 0.0
    assert not lasting(steps).any()
    steps[300] = 3.0
    assert np.flatnonzero(lasting(steps)).tolist() == [300] and lasting(steps)[300] == 2
