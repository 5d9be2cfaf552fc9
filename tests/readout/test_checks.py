"""Checks on open: each fault is found and named, and a recording without faults has none."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.readout.checks import check
from skinfab.readout.frame import Channel, Recording, Stream

N = 2000


def recording(**channels: np.ndarray) -> Recording:
    stream = Stream("skin", tuple(Channel(name, "V", "strain", 0.0, 3.3) for name in channels), 100.0)
    return Recording.of_values(stream, np.column_stack(list(channels.values())), device_time=np.arange(N) / 100)


def wave(phase: float = 0.0, *, noise: float = 0.002) -> np.ndarray:
    return 1.6 + 0.5 * np.sin(np.arange(N) / 50 + phase) + noise * np.random.default_rng(int(10 * phase)).standard_normal(N)


GOOD = recording(S1=wave(), S2=wave(1.0))


def only(found: list[str]) -> str:
    (sentence,) = found
    return sentence


def test_nothing_is_wrong() -> None:
    assert check(GOOD) == []


def test_a_coarse_converter_and_a_resting_joint_are_no_clipping() -> None:
    coarse = np.round(wave(), 2)  # turns at the same step at every crest
    rest = 1.0 + np.clip(0.3 * np.sin(np.arange(N) / 50) ** 3, 0, None) ** 2  # leaves its rest gently, and comes back so
    assert check(recording(S1=coarse, S2=rest)) == []


def test_no_frame() -> None:
    assert "no frame" in only(check(Recording.of_values(GOOD.stream, np.zeros((0, 2)), device_time=np.zeros(0))))


def test_constant_and_dead_channels() -> None:
    assert check(recording(S1=wave(), S2=np.ones(N))) == ["S2 never changes; check its wiring"]
    assert check(recording(S1=wave(), S2=np.ones(N), S3=np.ones(N))) == ["S2, S3 never change; check their wiring"]
    found = check(recording(S1=wave(), S2=np.full(N, np.nan)))
    assert found == ["S2 never has a valid reading; check its wiring"]
    many = check(recording(**{f"S{k}": np.ones(N) for k in range(9)}))
    assert many == ["S0, S1, S2, S3, S4, S5 and 3 more never change; check their wiring"]


def test_holes() -> None:
    values = wave()
    values[100:300] = np.nan
    assert "S2 (10 %) is not valid at times" in only(check(recording(S1=wave(), S2=values)))


def test_saturation_is_said_with_its_part() -> None:
    assert "S2 (" in only(check(recording(S1=wave(), S2=np.minimum(wave() + 1.5, 3.3)))) and "saturated" in only(
        check(recording(S1=wave(), S2=np.minimum(wave() + 1.5, 3.3)))
    )


@pytest.mark.parametrize("sign", [1, -1])
def test_clipping_within_the_range_is_seen(sign: int) -> None:
    """An amplifier clips before the converter does: no value is at an end of the range that was stated."""
    clipped = 1.6 + sign * np.minimum(wave() - 1.6, 0.3)
    assert only(check(recording(S1=wave(), S2=clipped))).startswith("S2 seems clipped")


def test_times() -> None:
    time = GOOD.device_time.copy()
    time[500] = time[499]
    time[1000:] -= 3
    assert "stands still or runs back 2 times, at frame 501 first" in only(check(replace(GOOD, device_time=time, host_time=GOOD.host_time)))
    host = GOOD.host_time.copy()
    host[700:] -= 60
    assert "host time runs back 1 time, at frame 701 first" in only(check(replace(GOOD, host_time=host)))
    host[3] = np.nan
    assert any("1 of 2,000 frames have no host time" in each for each in check(replace(GOOD, host_time=host)))


def test_rate() -> None:
    assert "at 96 Hz, and the stream says 100" in only(check(replace(GOOD, device_time=np.arange(N) / 96)))
    assert check(replace(GOOD, device_time=np.arange(N) / 100.5)) == []


def test_missing_and_doubled_frames() -> None:
    keep = np.ones(N, dtype=bool)
    keep[[100, 101, 102, 900]] = False
    made = Recording(
        GOOD.stream, *(getattr(GOOD, name)[keep] for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"))
    )
    assert only(check(made)) == "4 frames are missing (0.2 %), in 2 places"
    sequence = GOOD.sequence.copy()
    sequence[50] = 49
    assert any("does not go up at 1 place;" in each for each in check(replace(GOOD, sequence=sequence)))


def wrench(arm: np.ndarray, force: np.ndarray, *, skew: float = 0.0) -> Recording:
    torque = np.cross(arm, force) + skew * force
    kinds = [("f", "N", "force")] * 3 + [("m", "N m", "torque")] * 3
    channels = tuple(Channel(f"{name}{axis}", unit, kind) for (name, unit, kind), axis in zip(kinds, "xyzxyz", strict=True))
    return Recording.of_values(Stream("tip", channels, 100.0), np.hstack([force, torque]), device_time=np.arange(N) / 100)


def test_force_and_torque_that_no_touch_gives() -> None:
    rng = np.random.default_rng(0)
    force = rng.standard_normal((N, 3)) * np.abs(np.sin(np.arange(N) / 100))[:, None]
    arm = np.array([0.002, 0.001, 0.01]) + 0.001 * rng.standard_normal((N, 3))
    assert check(wrench(arm, force)) == []
    assert "force and torque are parallel (|cos| " in only(check(wrench(arm, force, skew=0.1)))
    assert check(wrench(np.zeros((N, 3)), force))  # torques that are all zero: constant, and no direction to judge
