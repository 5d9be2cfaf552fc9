"""The rate and the places of a log's readings: by even times, and where these are coarse by what is declared, counted or given."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.pace import pace_of, places_of, times_of
from skinfab.readout.frame import Channel, Recording, Stream

RATE = 1400.0
EVEN = 3.0 + np.arange(7000) / RATE
BUNCHED = 3.0 + np.arange(7000) // 14 * 0.01
LOST = np.random.default_rng(0).uniform(size=len(EVEN)) < 0.02


def log(time: np.ndarray, declared: float = 0.0, sequence: np.ndarray | None = None) -> Recording:
    made = Recording.of_values(Stream("s", (Channel("Ax"),), declared), np.zeros((len(time), 1)), device_time=time)
    if sequence is None:
        return made
    return Recording(made.stream, made.device_time, made.host_time, sequence, made.values, made.valid, made.saturated)


@pytest.mark.parametrize("declared", [0.0, RATE])
@pytest.mark.parametrize(
    "time",
    [
        np.round(EVEN, 3),
        np.round(np.where(np.arange(7000) < 3500, EVEN, EVEN + 3), 3),
        BUNCHED,
        BUNCHED + 1e-5 * (np.arange(7000) % 14),
    ],
    ids=["ms", "ms with a hole", "bunches", "bunches that rise"],
)
def test_coarse_times(time: np.ndarray, declared: float) -> None:
    recording = log(time, declared)
    pace = pace_of(recording)
    assert pace.coarse and pace.rate_hz == pytest.approx(RATE, rel=0.003 if not declared else 1e-9)
    (note,) = [each for each in pace.notes if "hole" not in each]  # nothing of a clock that was set
    assert "do not tell one reading from the next" in note and "frames are missing" not in note
    assert ("that it declares" in note) == bool(declared) and ("give --rate" in note) != bool(declared)
    places = places_of(recording, pace)
    steps = np.diff(places)
    assert (steps[steps != 1].tolist() == []) == (time[-1] < 9)
    if time[-1] < 9:
        assert np.abs(times_of(recording, places, pace) - (EVEN - 3.0)).max() < 0.012


def test_even_times() -> None:
    recording = log(EVEN[~LOST], 1500.0)
    pace = pace_of(recording)
    assert not pace.coarse and pace.rate_hz == pytest.approx(RATE)
    assert places_of(recording, pace).tolist() == np.flatnonzero(~LOST).tolist()
    assert any("frames come at 1400 Hz, and the stream says 1500" in note for note in pace.notes)
    assert pace_of(recording, rate_hz=1390.0).rate_hz == pace.rate_hz
    with pytest.raises(InputError, match="has 1400 readings a second by its times; leave --rate out"):
        pace_of(recording, rate_hz=700.0)


@pytest.mark.parametrize("time", [np.round(EVEN, 3), BUNCHED], ids=["ms", "bunches"])
def test_a_count_tells_what_is_lost(time: np.ndarray) -> None:
    recording = log(time[~LOST], sequence=np.flatnonzero(~LOST))
    pace = pace_of(recording)
    assert pace.coarse and pace.rate_hz == pytest.approx(RATE, rel=0.003) and any("by the frames' count" in note for note in pace.notes)
    assert places_of(recording, pace).tolist() == (np.flatnonzero(~LOST) - np.flatnonzero(~LOST)[0]).tolist()


@pytest.mark.parametrize("given", [None, RATE])
def test_lost_frames_by_milliseconds(given: float | None) -> None:
    """Without a count: the rate must be known, and then what is lost lies within some frames of where it is found to be."""
    recording = log(np.round(EVEN, 3)[~LOST], 0.0 if given else RATE)
    pace = pace_of(recording, rate_hz=given)
    assert pace.rate_hz == RATE
    assert any(f"by that {LOST.sum()} frames are missing" in note or "frames are missing, of which" in note for note in pace.notes)
    off = places_of(recording, pace) - (np.flatnonzero(~LOST) - np.flatnonzero(~LOST)[0])
    assert np.abs(off - round(np.median(off))).max() <= 1 and np.mean(off == np.median(off)) > 0.9
    closed = np.arange(len(off)) - np.flatnonzero(~LOST)
    assert np.ptp(closed) > 100  # as if nothing were lost
    unknown = pace_of(log(np.round(EVEN, 3)[~LOST]))
    assert unknown.rate_hz == pytest.approx(0.98 * RATE, rel=0.005) and "as if no frame were lost (else give --rate)" in unknown.notes[0]


def test_times_that_say_nothing() -> None:
    for time in (np.zeros(3), np.full(3, np.nan), np.array([1.0])):
        with pytest.raises(InputError, match="frames do not go on, and give no rate; write the device's time"):
            pace_of(log(time))
