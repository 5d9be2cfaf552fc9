"""The contact detector: as a stream and at once, both signs, what lasts, what falls silent, and what is no contact."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from calibration.contact.detector import Contact, ContactDetector, Detection, detect
from calibration.contact.simulator import simulate
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream

TIME = np.arange(3000) / 100


def skin(*changes: np.ndarray, r0: float = 100.0, noise: float = 0.004, high: float = np.inf, seed: int = 0) -> Recording:
    """Readings of channels that change by these parts."""
    rng = np.random.default_rng(seed)
    values = np.column_stack([r0 * (1 + each + noise * rng.standard_normal(len(each))) for each in changes])
    stream = Stream("skin", tuple(Channel(f"S{j + 1}", "kohm", "contact", high=high) for j in range(len(changes))), 100.0)
    return Recording.of_values(stream, np.minimum(values, high), device_time=np.arange(len(values)) / 100)


def touch(start: float, end: float, change: float = 0.3, *, time: np.ndarray = TIME) -> np.ndarray:
    """A press and a release, each over 0.1 s."""
    return change * np.clip(np.minimum((time - start) / 0.1, (end - time) / 0.1), 0, 1)


def spans(found: Detection, channel: str = "S1") -> list[tuple[float, float, int]]:
    return [(each.start, each.end, each.sign) for each in found.of(channel)]


def near(*expected: tuple[float, float, int]) -> object:
    """The same contacts, to a tenth of a second."""
    return [pytest.approx(each, abs=0.1) for each in expected]


@pytest.mark.parametrize(("name", "seed"), [("cube", 0), ("cup", 3), ("dodecahedron", 1)])
def test_a_stream_finds_what_the_whole_does(name: str, seed: int) -> None:
    log = simulate(name, seed=seed).recording
    whole = detect(log)
    watch = ContactDetector(log.stream)
    edges = [(frame.device_time, each) for frame in log for each in watch.step(frame)]
    found = watch.found()
    assert found.contacts == whole.contacts and found.channels == whole.channels
    ended = [each for _, each in edges if not each.lasting]
    assert sorted(ended, key=lambda each: (each.start, each.channel)) == [c for c in whole.contacts if not c.lasting]
    # Every contact was told when it began, within a tenth of a second (but after a drop-out, when it was seen).
    began = [(now, each) for now, each in edges if each.lasting]
    assert len(began) == len(whole.contacts) and all(0 <= now - each.start < 0.1 for now, each in began)


def test_both_signs_and_their_strengths() -> None:
    found = detect(skin(touch(5, 8, 0.3), touch(6, 9, -0.159)))
    assert spans(found) == near((5.0, 8.0, 1)) and spans(found, "S2") == near((6.0, 9.0, -1))
    assert [each.strength for each in found.contacts] == pytest.approx([0.3, 0.159], abs=0.01)


@settings(max_examples=20, deadline=None)
@given(st.floats(1e-6, 1e6))
def test_units_do_not_matter(scale: float) -> None:
    plain = skin(touch(5, 8))
    scaled = detect(replace(plain, values=scale * plain.values))
    mirrored = detect(replace(plain, values=-scale * plain.values))
    assert spans(scaled) == near((5.0, 8.0, 1)) and spans(mirrored) == near((5.0, 8.0, -1))


@pytest.mark.parametrize("drift", [-0.02, 0.02])
def test_a_contact_lasts_through_drift(drift: float) -> None:
    time = np.arange(12000) / 100
    found = detect(skin(touch(20, 100, 0.1, time=time) + drift * time / 60, drift * time / 60), false_alarms=0.01)
    assert spans(found) == near((20.0, 100.0, 1)) and not found.of("S2")


def test_one_that_has_not_ended_is_told() -> None:
    (only,) = detect(skin(touch(5, 99))).contacts
    assert only.lasting and only.start == pytest.approx(5, abs=0.05)


def test_a_channel_that_is_not_well_is_named_and_stops_no_other() -> None:
    silent, dead = np.full(3000, np.nan), np.zeros(3000)
    plain = skin(silent, touch(5, 8), dead)
    values = plain.values.copy()
    values[:, 2] = 47.0
    found = detect(Recording.of_values(plain.stream, values, device_time=plain.device_time))
    assert spans(found, "S2") == near((5.0, 8.0, 1)) and {each.channel for each in found.contacts} == {"S2"}
    (first,), none, (third,) = (health.faults for health in found.channels)
    assert "channel S1 never read anything" in first and none == () and "channel S3 read one value" in third
    assert [health.state for health in found.channels] == ["silent", "", "constant"]


def test_a_channel_that_never_rests_is_named() -> None:
    found = detect(skin(0.3 * np.sin(TIME), touch(5, 8)))
    assert "S1 never rested" in found.channels[0].faults[0] and spans(found, "S2") == near((5.0, 8.0, 1))


def test_what_begins_with_a_touch_is_learnt_afterwards() -> None:
    found = detect(skin(touch(1, 2, time=TIME) + touch(10, 12)))
    assert found.channels[0].ready == pytest.approx(6, abs=0.1) and spans(found) == near((10.0, 12.0, 1))


@pytest.mark.parametrize(("silence", "expected"), [((6.0, 6.8), [(5.0, 8.0, False)]), ((6.0, 7.5), [(5.0, 6.0, True), (7.5, 8.0, False)])])
def test_a_short_silence_is_bridged_and_a_long_one_said(silence: tuple[float, float], expected: list[tuple[float, float, bool]]) -> None:
    change = touch(5, 8)
    change[(TIME > silence[0]) & (TIME < silence[1])] = np.nan
    found = detect(skin(change))
    assert spans(found) == near(*((start, end, 1) for start, end, _ in expected))
    assert [each.dropped for each in found.contacts] == [dropped for _, _, dropped in expected]
    assert "read nothing in" in found.channels[0].faults[0]


def test_a_press_into_the_end_of_the_range_is_flagged_and_an_open_wire_is_no_contact() -> None:
    open_wire = np.where((TIME > 15) & (TIME < 17), 9.0, 0.0)
    found = detect(skin(touch(5, 8, 0.9) + open_wire, high=150.0))
    (only,) = found.contacts
    assert (only.start, only.end) == pytest.approx((5.0, 8.0), abs=0.1) and only.saturated and only.strength >= 0.2
    assert "end of its range" in found.channels[0].faults[0]


def test_a_spike_is_no_contact_and_breaks_none() -> None:
    change = touch(5, 8)
    change[[1000, 1001, 650]] += 5.0
    assert spans(detect(skin(change))) == near((5.0, 8.0, 1))


def test_two_touches_of_a_channel_are_two() -> None:
    assert spans(detect(skin(touch(5, 6) + touch(6.2, 7) + touch(7.8, 9)))) == near((5.0, 6.0, 1), (6.2, 7.0, 1), (7.8, 9.0, 1))


def test_silicone_that_creeps_back_is_no_contact() -> None:
    after = np.where(TIME > 8, 0.1 * np.exp(-(TIME - 8) / 2), 0.0)
    assert spans(detect(skin(touch(5, 8, 1.0) + after))) == near((5.0, 8.0, 1))


def test_a_clock_set_back_says_nothing() -> None:
    plain = skin(touch(5, 8))
    time = plain.device_time.copy()
    time[2000:2100] -= 15
    time[2500] = np.nan
    assert spans(detect(replace(plain, device_time=time))) == near((5.0, 8.0, 1))


def test_who_is_touched_now() -> None:
    log = skin(touch(5, 8), touch(7, 9))
    watch, seen = ContactDetector(log.stream), set()
    for frame in log:
        watch.step(frame)
        seen.add(watch.touched)
    assert seen == {(), ("S1",), ("S1", "S2"), ("S2",)}


def test_channels_that_are_watched() -> None:
    mixed = skin(touch(5, 8), touch(6, 9))
    channels = (replace(mixed.stream.channels[0], kind="strain"), mixed.stream.channels[1])
    log = replace(mixed, stream=replace(mixed.stream, channels=channels))
    assert {each.channel for each in detect(log).contacts} == {"S2"}
    assert {each.channel for each in detect(log, channels=["S1"]).contacts} == {"S1"}


def test_a_rate_that_is_not_said_is_measured() -> None:
    plain = skin(touch(5, 8))
    found = detect(replace(plain, stream=replace(plain.stream, rate_hz=0.0)))
    assert found.alarm.threshold == pytest.approx(detect(plain).alarm.threshold, abs=1e-6) and spans(found) == near((5.0, 8.0, 1))


def test_what_cannot_be_used() -> None:
    plain = skin(touch(5, 8))
    with pytest.raises(InputError, match=r"no channel 'S9'; it has S1"):
        detect(plain, channels=["S9"])
    with pytest.raises(InputError, match="does not say how many frames"):
        ContactDetector(replace(plain.stream, rate_hz=0.0))
    with pytest.raises(InputError, match="10 frames are too few"):
        detect(Recording.of_frames(plain.stream, [plain.frame(k) for k in range(10)]))
    with pytest.raises(InputError, match="the time stands still"):
        detect(replace(plain, stream=replace(plain.stream, rate_hz=0.0), device_time=np.zeros(3000)))


def test_no_channel_of_nothing_but_zero() -> None:
    log = skin(touch(5, 8), r0=0.0)
    assert not detect(log).contacts


def test_a_contact_knows_whether_it_lasts() -> None:
    assert Contact("S1", 1.0, float("nan"), 1, 0.1).lasting and not Contact("S1", 1.0, 2.0, 1, 0.1).lasting


def test_what_creeps_back_while_nothing_is_read_is_no_contact() -> None:
    left = np.where(TIME > 8, 0.08 * np.exp(-(TIME - 8) / 1.0), 0.0)
    left[(TIME > 8.6) & (TIME < 10.5)] = np.nan
    assert spans(detect(skin(touch(5, 8, 0.6) + left))) == near((5.0, 8.0, 1))


def without(recording: Recording, start: float, end: float) -> Recording:
    """The recording, with a hole in its time."""
    stays = (recording.device_time < start) | (recording.device_time >= end)
    kept = (getattr(recording, name)[stays] for name in ("device_time", "host_time", "sequence", "values", "valid", "saturated"))
    return Recording(recording.stream, *kept)


def test_a_contact_ends_at_a_hole_in_the_time() -> None:
    found = detect(without(skin(touch(5, 15), touch(5, 8)), 7, 12))
    assert spans(found) == near((5.0, 7.0, 1), (12.0, 15.0, 1)) and spans(found, "S2") == near((5.0, 7.0, 1))
    assert [each.dropped for each in found.contacts] == [True, True, False]
    assert "2 contacts were cut short" in found.faults[-1]
    bridged = detect(without(skin(touch(5, 15)), 7, 7.9))
    assert spans(bridged) == near((5.0, 15.0, 1)) and bridged.faults == ()


def test_no_contact_begins_in_a_hole() -> None:
    # What summed up before the hole and what is seen after it are not one beginning.
    found = detect(without(skin(touch(11.97, 20)), 12, 18))
    assert spans(found) == near((18.0, 20.0, 1))


def test_a_slow_stream_keeps_its_contacts() -> None:
    plain = skin(touch(5, 8))
    slow = replace(plain, stream=replace(plain.stream, rate_hz=5.0), device_time=20 * plain.device_time)
    # Six frames that are missing are more than a second, and no hole.
    (only,) = detect(without(slow, 120, 121.3), false_alarms=0.01).contacts
    assert (only.start, only.end, only.dropped) == (pytest.approx(100, abs=1), pytest.approx(160, abs=2), False)


def test_a_device_that_begins_anew_ends_its_contacts_and_is_watched_on() -> None:
    plain = skin(touch(5, 14) + touch(20, 22))
    time = plain.device_time.copy()
    time[1000:] -= time[1000]
    log = replace(plain, device_time=time)
    found = detect(log)
    assert spans(found) == near((5.0, 10.0, 1), (11.0, 14.0, 1), (20.0, 22.0, 1)) and found.contacts[0].dropped
    assert "the clock is set back before frame 1,101" in found.faults[0]
    watch = ContactDetector(log.stream)
    for frame in log:
        watch.step(frame)
    assert watch.found().contacts == found.contacts and watch.found().set_back == found.set_back
    assert watch.now == pytest.approx(29.99)


def test_rest_is_found_soon_after_the_last_touch_and_late_is_said() -> None:
    busy = sum(touch(at, at + 1.0) for at in np.arange(0.5, 12, 2.0))
    found = detect(skin(busy + touch(20, 22), touch(20, 22)))
    late, soon = found.channels
    assert 11.5 + 3 <= late.ready <= 11.5 + 3 + 1.5 and late.late == pytest.approx(late.ready - 3, abs=0.02)
    assert "S1 was not at rest at first and is watched from 14" in late.faults[0] and soon.faults == () and soon.late < 0.02
    assert spans(found) == near((20.0, 22.0, 1))


def test_a_rest_is_gathered_on_one_side_of_a_hole() -> None:
    found = detect(without(skin(touch(20, 22)), 2, 10))
    assert found.channels[0].ready == pytest.approx(13, abs=0.05) and found.channels[0].late == pytest.approx(10, abs=0.1)


def test_what_waits_and_what_is_frozen_is_known_at_any_time() -> None:
    log = skin(np.zeros(3000), touch(1, 2))
    log.values[1000:, 0] = 100.0
    watch = ContactDetector(log.stream)
    seen = {frame.device_time: (watch.step(frame), watch.waiting, watch.frozen)[1:] for frame in log}
    assert seen[2.0] == (("S1", "S2"), ()) and seen[4.0] == (("S2",), ()) and seen[6.0] == ((), ()) and seen[12.0] == ((), ("S1",))
