import time

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.paced import PacedFrames
from skinfab.readout.source import StaleError
from skinfab.readout.strain_simulator import simulated_strain

STREAM = Stream("s", (Channel("U"),), 200.0)
MADE = Recording.of_values(STREAM, np.arange(40.0)[:, None], device_time=np.arange(40) / 200)


def test_frames_come_at_their_time_and_say_when_that_was() -> None:
    with PacedFrames(STREAM, lambda: MADE) as source:
        began = time.monotonic()
        found = list(source)
        took = time.monotonic() - began
    assert [f.values[0] for f in found] == list(range(40)) and took >= 39 / 200
    np.testing.assert_allclose(np.diff([f.host_time for f in found]), 1 / 200, atol=1e-6)
    assert source.counts.frames == 40


def test_read_waits_no_longer_than_it_is_told() -> None:
    slow = Stream("s", (Channel("U"),), 0.5)
    with PacedFrames(slow, lambda: MADE) as source:
        assert source.read(0.0) is not None
        began = time.monotonic()
        assert source.read(0.05) is None and 0.05 <= time.monotonic() - began < 1.0


def test_the_latest_passes_over_what_was_due_before() -> None:
    began = time.monotonic()
    with PacedFrames(STREAM, lambda: MADE) as source:
        time.sleep(0.1)
        newest = source.read_latest(5.0)
        assert 18 <= newest.sequence <= min((time.monotonic() - began) * 200, 39)
        time.sleep(0.3)
        assert source.read_latest(5.0).sequence == 39
        with pytest.raises(StaleError, match="s old"):
            source.read_latest(0.01)


def test_nothing_comes_before_it_is_opened_or_after_it_is_closed_and_it_opens_anew() -> None:
    source = PacedFrames(STREAM, lambda: MADE, in_time=False)
    assert source.read() is None
    with pytest.raises(StaleError, match="no frame yet"):
        source.read_latest(1.0)
    for _ in range(2):
        with source:
            first = source.read()
            assert first is not None and first.values[0] == 0.0
            assert source.read_latest(1.0).values[0] == 1.0
        assert source.read() is None


def test_a_stream_without_a_rate_cannot_keep_time() -> None:
    with pytest.raises(InputError, match="has no rate"):
        PacedFrames(Stream("s", (Channel("U"),)), lambda: MADE)


def test_simulated_strain_is_labelled_repeats_and_stays_in_range() -> None:
    runs = []
    for _ in range(2):
        with simulated_strain(channels=20, in_time=False) as source:
            runs.append(np.array([source.read().values for _ in range(2000)]))  # type: ignore[union-attr]
            assert source.stream.simulated and source.stream.channels[19].board == 2
    np.testing.assert_array_equal(*runs)
    assert 0.5 < runs[0].min() < runs[0].max() < 3.0 and np.all(np.ptp(runs[0], axis=0) > 0.2)
