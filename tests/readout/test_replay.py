"""Replay: the same frames again, at a pace that is kept, and stale where a live source would be."""

import time

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.replay import Replay
from skinfab.readout.source import Source, StaleError


def recording(n: int = 20, *, step: float = 0.01) -> Recording:
    stream = Stream("skin", (Channel("S1", "V", high=15.0), Channel("S2", "V")), 1 / step, simulated=True)
    values = np.column_stack([np.arange(n, dtype=float), np.full(n, np.nan)])
    made = Recording.of_values(stream, values, device_time=5 + step * np.arange(n), host_time=1.7e9 + step * np.arange(n))
    made.sequence[n // 2 :] += 3
    return made


def test_as_fast_as_possible_it_is_the_recording_itself() -> None:
    made = recording()
    with Replay(made) as source:
        again = Recording.of_frames(source.stream, source)
    for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"):
        assert getattr(again, name).tobytes() == getattr(made, name).tobytes()
    assert source.stream.simulated and (source.counts.frames, source.counts.lost) == (20, 3)


@pytest.mark.parametrize("speed", [1.0, 4.0])
def test_the_pace_is_kept(speed: float) -> None:
    made = recording(30)
    source: Source = Replay(made, speed=speed)
    before = time.time()
    with source:
        times = [(frame.host_time, time.time()) for frame in source]
    due, came = np.array(times).T
    # A frame never comes early; its host time is when it was due, whatever the machine did meanwhile.
    assert np.all(came - due > -0.005)
    assert np.allclose(np.diff(due), 0.01 / speed, atol=1e-6) and due[0] >= before - 0.005


def test_opened_again_it_begins_again() -> None:
    source = Replay(recording())
    assert source.read() is None  # not open
    for _ in range(2):
        with source:
            assert [frame.values[0] for frame in source][:3] == [0, 1, 2]
        assert source.read() is None
    assert source.counts.frames == 20


def test_a_timeout_gives_none_and_loses_nothing() -> None:
    with Replay(recording(3, step=0.8), speed=1.0) as source:
        assert source.read(timeout=0.05).values[0] == 0
        assert source.read(timeout=0.01) is None
        assert source.read(timeout=5).values[0] == 1


def test_the_latest_and_the_stale() -> None:
    source = Replay(recording(5, step=0.02), speed=1.0)
    with pytest.raises(StaleError, match="no frame yet"):
        source.read_latest(1.0)
    with source:
        time.sleep(0.15)
        assert source.read_latest(60.0).values[0] == 4
        with pytest.raises(StaleError, match=r"s old, and 0\.01 s are allowed"):
            source.read_latest(0.01)
        assert source.counts.frames == 5


def test_a_clock_that_steps_back_stops_nothing() -> None:
    made = recording()
    made.device_time[10:] -= 3600
    with Replay(made, speed=1.0) as source:
        assert sum(1 for _ in source) == 20
    assert source.duration_s == pytest.approx(0.09)


def test_speeds_that_are_none() -> None:
    for speed in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InputError, match="is none"):
            Replay(recording(), speed=speed)
    made = recording()
    made.device_time[3] = np.nan
    with pytest.raises(InputError, match="no device time"):
        Replay(made, speed=1.0)
    with Replay(made) as source:
        assert sum(1 for _ in source) == 20


def test_no_frame_at_all() -> None:
    with Replay(recording(0), speed=1.0) as source:
        assert source.read() is None and source.duration_s == 0
