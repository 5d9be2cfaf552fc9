"""Channels that freeze: named from when on, out of the decision, and never one that is only quiet, coarse or slow."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from calibration.contact.detector import ContactDetector, Detection, detect
from skinfab.readout.frame import Channel, Recording, Stream

TIME = np.arange(4000) / 100


def touch(start: float, end: float, change: float = 0.3) -> np.ndarray:
    return change * np.clip(np.minimum((TIME - start) / 0.1, (end - TIME) / 0.1), 0, 1)


def readings(*changes: np.ndarray, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([100 * (1 + each + 0.004 * rng.standard_normal(len(each))) for each in changes])


def log(values: np.ndarray, rate_hz: float = 100.0) -> Recording:
    stream = Stream("skin", tuple(Channel(f"S{j + 1}", "kohm", "contact") for j in range(values.shape[1])), rate_hz)
    return Recording.of_values(stream, values, device_time=np.arange(len(values)) / rate_hz)


def spans(found: Detection, channel: str) -> list[tuple[float, float]]:
    return [(each.start, each.end) for each in found.of(channel)]


def stream_of(recording: Recording) -> tuple[Detection, list[tuple[float, str, float, float]]]:
    watch = ContactDetector(recording.stream)
    edges = [(frame.device_time, each.channel, each.start, each.end) for frame in recording for each in watch.step(frame)]
    return watch.found(), edges


def test_one_that_freezes_midway_is_named_and_no_more_watched() -> None:
    change = touch(5, 8) + touch(25, 28)
    values = readings(change, change)
    values[2000:, 0] = values[2000, 0]
    found = detect(log(values))
    assert spans(found, "S1") == [pytest.approx((5, 8), abs=0.1)] and len(found.of("S2")) == 2
    first, second = found.channels
    (frozen,) = first.freezes
    assert (
        frozen.start == pytest.approx(20.0, abs=0.03)
        and math.isnan(frozen.end)
        and frozen.value == pytest.approx(values[2000, 0], abs=0.04)
    )
    assert first.state == "frozen" and any("channel S1 froze at" in fault for fault in found.faults)
    assert second.freezes == () and first.watched == pytest.approx(17 / 40, abs=0.01) and second.watched == pytest.approx(37 / 40, abs=0.01)


def test_one_that_freezes_under_a_contact_ends_it_there() -> None:
    values = readings(touch(5, 12))
    values[700:, 0] = values[700, 0]
    (only,) = detect(log(values)).contacts
    assert (only.start, only.end) == pytest.approx((5, 7), abs=0.1) and only.dropped


@pytest.mark.parametrize("flicker", [0.0, 0.01])
@pytest.mark.parametrize("end", [500.0, 0.0])
def test_one_at_the_end_of_a_range_that_nobody_declared_is_no_contact_and_comes_back(end: float, flicker: float) -> None:
    values = readings(touch(5, 8) + touch(35, 37))
    values[2000:3000, 0] = end + flicker * (np.arange(1000) % 2)
    recording = log(values)
    found, edges = stream_of(recording)
    assert spans(found, "S1") == [pytest.approx((5, 8), abs=0.1), pytest.approx((35, 37), abs=0.1)]
    (frozen,) = found.channels[0].freezes
    assert (frozen.start, frozen.end) == pytest.approx((20, 30.3), abs=0.1)
    assert ("the most" if end else "the least") in found.channels[0].faults[0]
    # As it came it looked like a touch; when it had frozen, that was taken back.
    (begun,) = [each for each in edges if each[2] == pytest.approx(20, abs=0.1) and math.isnan(each[3])]
    assert ("S1", begun[2], begun[2]) in [each[1:] for each in edges]
    whole = detect(recording)
    assert whole.contacts == found.contacts and whole.channels == found.channels


def test_a_press_into_that_end_is_cut_short_and_kept() -> None:
    values = np.minimum(readings(touch(5, 9, 0.8)), 150.0)
    found = detect(log(values))
    (only,) = found.contacts
    assert only.start == pytest.approx(5, abs=0.05) and only.dropped and "S1 froze at 5.0" in found.channels[0].faults[0]


@pytest.mark.parametrize("step", [0.02, 0.1, 0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("colour", [0.0, 0.7])
def test_a_coarse_converter_is_not_frozen_however_its_level_lies(step: float, colour: float) -> None:
    """Twenty minutes of a noise of 0.4 whose level goes over four steps."""
    noise = lfilter([math.sqrt(1 - colour**2)], [1, -colour], np.random.default_rng(3).standard_normal(120_000))
    level = 100 + np.linspace(0, 4 * step, len(noise))
    (health,) = detect(log((np.round((level + 0.4 * noise) / step) * step)[:, None])).channels
    assert health.freezes == () and not math.isnan(health.ready)


def test_a_channel_that_hardly_moves_cannot_tell_and_says_so() -> None:
    values = np.round(readings(touch(5, 8)) / 4) * 4
    found = detect(log(values))
    assert spans(found, "S1") == [pytest.approx((5, 8), abs=0.1)]
    assert "nobody could tell if it froze" in found.channels[0].faults[0]


def test_a_slow_stream_freezes_after_as_many_frames() -> None:
    values = readings(np.zeros(400))
    values[200:215, 0] = values[200, 0]
    assert detect(log(values, 5.0), false_alarms=0.01).channels[0].freezes == ()
    values[200:230, 0] = values[200, 0]
    (frozen,) = detect(log(values, 5.0), false_alarms=0.01).channels[0].freezes
    assert frozen.start == pytest.approx(40.0, abs=0.2)


def test_a_declared_end_is_saturated_and_not_frozen() -> None:
    values = readings(touch(5, 8))
    values[2000:3000, 0] = 500.0
    recording = log(values)
    stream = replace(recording.stream, channels=(replace(recording.stream.channels[0], high=500.0),))
    found = detect(Recording.of_values(stream, values, device_time=recording.device_time))
    assert len(found.contacts) == 1 and found.channels[0].freezes == () and "end of its range in 25.0 %" in found.channels[0].faults[0]
