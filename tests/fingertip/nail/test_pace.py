"""The rate of a log's readings: by even times, and where these are not those of single readings by what is declared, counted or given."""

from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.pace import pace_of, pace_of_log
from skinfab.fingertip.nail.places import places_of, times_of
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import read_log

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
    assert pace.kind in ("clock", "bunches") and pace.rate_hz == pytest.approx(RATE, rel=0.003 if not declared else 1e-9)
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
    assert pace.kind == "even" and pace.rate_hz == pytest.approx(RATE)
    assert places_of(recording, pace).tolist() == np.flatnonzero(~LOST).tolist()
    assert any("frames come at 1400 Hz, and the stream says 1500" in note for note in pace.notes)
    assert pace_of(recording, rate_hz=1390.0).rate_hz == pace.rate_hz
    with pytest.raises(InputError, match="has 1400 readings a second by its times; leave --rate out"):
        pace_of(recording, rate_hz=700.0)


@pytest.mark.parametrize("time", [np.round(EVEN, 3), BUNCHED], ids=["ms", "bunches"])
def test_a_count_tells_what_is_lost(time: np.ndarray) -> None:
    recording = log(time[~LOST], sequence=np.flatnonzero(~LOST))
    pace = pace_of(recording)
    assert (
        pace.kind in ("clock", "bunches")
        and pace.rate_hz == pytest.approx(RATE, rel=0.003)
        and any("by the frames' count" in note for note in pace.notes)
    )
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


def late(times: np.ndarray, seconds: float) -> np.ndarray:
    """As a computer writes them down that stops 20 times for so long, and gets what gathered at once."""
    out = times.copy()
    for begin in np.random.default_rng(3).uniform(3.3, 7.5, 20):
        inside = (times >= begin) & (times < begin + seconds)
        out[inside] = np.maximum(out[inside], begin + seconds)
    return np.maximum.accumulate(out) + 1e-8 * np.arange(len(out))


def jittered(spread_s: float) -> np.ndarray:
    return np.sort(EVEN + np.random.default_rng(1).normal(0, spread_s, len(EVEN)))


@pytest.mark.parametrize("rate", [None, RATE])
@pytest.mark.parametrize(
    ("time", "kind", "says"),
    [
        (jittered(2e-5), "even", ""),
        (jittered(1e-4), "jitter", "its times jitter (steps of "),
        (jittered(2e-4), "jitter", "its times jitter"),
        (jittered(5e-4), "jitter", "so some frames come late"),
        (EVEN + np.random.default_rng(2).exponential(1.5e-4, len(EVEN)), "jitter", "its times jitter"),
        (late(EVEN, 0.02), "jitter", "to 21 ms"),
        (np.round(EVEN / 5e-4) * 5e-4, "clock", "its clock goes in steps of 0.5 ms"),
        (np.round(EVEN / 7e-4) * 7e-4, "clock", "its clock goes in steps of 0.7 ms"),
        (np.round(EVEN / 3e-4) * 3e-4, "jitter", "its times jitter"),
    ],
    ids=["20 us", "100 us", "200 us", "500 us", "exponential", "host stops", "0.5 ms clock", "0.7 ms clock", "0.3 ms clock"],
)
def test_frames_that_come_late_are_not_lost(time: np.ndarray, kind: str, says: str, rate: float | None) -> None:
    """No frame is missing: the rate is within a thousandth, nothing is lost, and the sentence says what is so."""
    recording = log(np.maximum.accumulate(time))
    pace = pace_of(recording, rate_hz=rate)
    assert pace.kind == kind and pace.rate_hz == pytest.approx(RATE, rel=1e-3) and pace.known == (kind == "even" or bool(rate))
    places = places_of(recording, pace)
    assert places[-1] == len(time) - 1
    assert np.abs(times_of(recording, places, pace) - (EVEN - 3.0)).max() < 1e-3
    said = " ".join(pace.notes)
    assert says in said and "declares" not in said and "missing" not in said and (("--rate" in said) == bool(said))


def test_a_plain_table_declares_no_rate(tmp_path: Path) -> None:
    """What the reader of logs makes of its times is none: an eighth of the frames were lost if 1600 a second were declared."""
    lines = ["time_s,Ax", *(f"{t:.4f},0" for t in late(EVEN, 0.02) - 3)]
    (tmp_path / "t.csv").write_text("\n".join(lines) + "\n")
    made = read_log(tmp_path / "t.csv")
    assert made.rate_of_times and abs(made.recording.stream.rate_hz - RATE) > 0.01 * RATE  # a median of 0.1 ms steps
    pace = pace_of_log(made)
    assert pace.rate_hz == pytest.approx(RATE, rel=1e-3) and not pace.known and "declares" not in " ".join(pace.notes)


def test_times_that_say_nothing() -> None:
    for time in (np.zeros(3), np.full(3, np.nan), np.array([1.0])):
        with pytest.raises(InputError, match="frames do not go on, and give no rate; write the device's time"):
            pace_of(log(time))
