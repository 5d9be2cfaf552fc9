"""Where contact detection fails: what the usual ways do there, so that the case is real, and what the project's does."""

import numpy as np
import pytest

from calibration.contact.detector import detect
from calibration.contact.peers import THRESHOLD, fixed_threshold, high_pass
from calibration.contact.simulator import Scene, simulate
from skinfab.readout.frame import Channel, Recording, Stream

TIME = np.arange(12_000) / 100


def skin(*changes: np.ndarray) -> Recording:
    noise = 0.004 * np.random.default_rng(1).standard_normal((len(TIME), len(changes)))
    stream = Stream("skin", tuple(Channel(f"S{j + 1}", "kohm", "contact") for j in range(len(changes))), 100.0)
    return Recording.of_values(stream, 100 * (1 + np.column_stack(changes) + noise), device_time=TIME)


def touch(start: float, end: float, change: float) -> np.ndarray:
    return change * np.clip(np.minimum((TIME - start) / 0.15, (end - TIME) / 0.15), 0, 1)


def test_a_fixed_threshold_takes_drift_for_a_contact() -> None:
    log = skin(0.04 * TIME / 60)
    (alarm,) = fixed_threshold(log)
    assert alarm.lasting and alarm.strength > THRESHOLD
    assert not detect(log).contacts


def test_a_fixed_threshold_in_drift_never_lets_go() -> None:
    log = skin(0.05 * TIME / 60 + touch(70, 72, 0.2))
    assert not any(abs(each.start - 70) < 0.2 and abs(each.end - 72) < 0.2 for each in fixed_threshold(log))
    (only,) = detect(log).contacts
    assert (only.start, only.end) == pytest.approx((70, 72), abs=0.2)


def test_a_high_pass_erases_a_contact_that_lasts_and_makes_one_of_its_end() -> None:
    log = skin(touch(20, 80, 0.2))
    found = high_pass(log)
    assert found[0].end - found[0].start < 5  # of sixty seconds
    assert any(each.sign < 0 and abs(each.start - 80) < 1 for each in found)  # touched the other way, when it was let go
    (only,) = detect(log).contacts
    assert (only.start, only.end, only.sign) == (pytest.approx(20, abs=0.1), pytest.approx(80, abs=0.1), 1)


def test_a_threshold_on_rises_misses_a_channel_that_falls() -> None:
    log = skin(touch(20, 22, -0.159))  # S2 of the paper's cube
    assert fixed_threshold(log, signed=True) == []
    (only,) = detect(log).contacts
    assert only.sign == -1 and only.strength == pytest.approx(0.159, abs=0.01)


def test_a_weak_contact_lies_below_any_threshold_that_is_fixed_for_all() -> None:
    log = skin(touch(20, 22, 0.043))  # S4 of the paper's cup
    assert fixed_threshold(log) == []
    (only,) = detect(log).contacts
    assert only.start == pytest.approx(20, abs=0.1)


def test_a_dead_channel_stops_none() -> None:
    log = skin(np.full(len(TIME), np.nan), touch(20, 22, 0.2))
    assert np.isnan(np.median(log.values[:300], axis=0)[0])  # what a reading at rest comes to
    found = detect(log)
    assert [each.channel for each in found.contacts] == ["S2"] and "S1 never read anything" in found.channels[0].faults[0]


def test_an_open_wire_reads_as_the_strongest_contact_of_all() -> None:
    values = skin(np.where((TIME > 40) & (TIME < 42), 9.0, 0.0)).values
    naive = Recording.of_values(Stream("skin", (Channel("S1"),), 100.0), values, device_time=TIME)
    assert [each.sign for each in fixed_threshold(naive)] == [1]
    told = Recording.of_values(Stream("skin", (Channel("S1", high=500.0),), 100.0), np.minimum(values, 500), device_time=TIME)
    found = detect(told)
    assert not found.contacts and "end of its range" in found.channels[0].faults[0]


def test_creep_after_a_strong_contact_is_many_times_the_noise() -> None:
    scene = Scene(scatter=0, second=0, drop_outs_per_minute=0, drift_per_minute=0)
    trial = simulate("cube", seed=0, scene=scene)
    released = next(each for each in trial.truth if each.channel == "S3")
    after = (trial.recording.device_time > released.end + 0.3) & (trial.recording.device_time < released.end + 0.5)
    left = np.median(trial.recording.column("S3")[after]) / np.median(trial.recording.column("S3")[:300]) - 1
    assert left > 5 * scene.noise  # a threshold on the noise alone would see it come and go
    found = detect(trial.recording)
    assert len(found.of("S3")) == sum(each.channel == "S3" for each in trial.truth)
    assert {each.sign for each in found.of("S3")} == {1}


def test_a_channel_that_is_stuck_is_a_contact_that_never_ends() -> None:
    log = skin(touch(20, 22, 0.2))
    log.values[4000:, 0] = 500.0
    assert fixed_threshold(log)[-1].lasting and any(abs(each.start - 40) < 0.1 for each in high_pass(log))
    found = detect(log)
    (only,) = found.contacts
    assert (only.start, only.end) == pytest.approx((20, 22), abs=0.2) and "S1 froze at 40" in found.faults[0]


def test_a_hole_in_the_time_is_a_contact_for_who_does_not_look() -> None:
    log = skin(touch(20, 90, 0.2))
    log.device_time[3000:] += 100
    (spanned,) = fixed_threshold(log)
    assert spanned.start < 31 and spanned.end > 130  # what was in between nobody knows
    found = detect(log)
    assert [(each.start, each.end) for each in found.contacts] == [pytest.approx((20, 30), abs=0.1), pytest.approx((130, 190), abs=0.2)]
