"""Sources read beside the window: over a pseudo-terminal, from logs, from simulators."""

import collections
import itertools
import math
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from calibration.contact.simulator import simulate
from gui.live.choices import LogChoice, PortChoice, SimulatorChoice
from gui.live.feed import Feed
from skinfab.errors import InputError
from skinfab.readout.faults import Faults
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.logs.log import read_log
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.record import Recorder

LOGS = Path(__file__).resolve().parents[3] / "calibration" / "logs"
STREAM = Stream("board", (Channel("A", "V"), Channel("B", "V")), 200.0)


def frames(stream=STREAM):
    c = len(stream.channels)
    for k in itertools.count():
        t = k / stream.rate_hz
        yield Frame(t, t, k, np.full(c, float(k)), np.ones(c, dtype=bool), np.zeros(c, dtype=bool))


def until(true, seconds=10.0):
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.01)


@pytest.fixture
def feeds():
    made = []

    def begin(choice, **given):
        given = {"contact": lambda stream: ()} | given
        made.append(Feed(choice, **given))
        return made[-1]

    yield begin
    for feed in made:
        feed.close()
    for feed in made:
        assert feed.join(8.0)


def test_frames_of_a_port_come_in_order_and_its_thread_ends(feeds):
    with PtyServer(STREAM, frames()) as device:
        feed = feeds(PortChoice(str(device.path)))
        assert feed.status().state == "opening" and feed.take().newest is None
        until(lambda: feed.status().state == "running")
        rows = []
        until(lambda: rows.extend(feed.take().rows[:, 0].tolist()) or len(rows) > 100)
        assert np.array_equal(np.diff(rows), np.ones(len(rows) - 1))
        status = feed.status()
        assert status.stream == STREAM and np.isnan(status.rate_hz) and np.isfinite(status.age_s) and np.isnan(status.gone_s)
        feed.close()
        assert feed.join(1.0) and feed.status().state == "ended" and feed.status().sentence == ""
        assert not [t for t in threading.enumerate() if t.name == f"reader of {device.path}"]


def test_a_port_that_is_unplugged_is_said_to_be_gone_and_comes_back_by_itself(feeds):
    with PtyServer(STREAM, frames(), faults=Faults(unplugged={100: 1.2})) as device:
        feed = feeds(PortChoice(str(device.path)))
        until(lambda: feed.status().gone_s > 0.4)
        assert feed.status().age_s > 0.2
        until(lambda: feed.status().outages_s)
        (gone,) = feed.status().outages_s
        assert gone > 0.9 and np.isnan(feed.status().gone_s)
        feed.take()
        until(lambda: feed._pending)
        assert feed.status().counts.reopened == 1


def test_what_is_recorded_is_what_came(feeds, tmp_path):
    with PtyServer(STREAM, frames()) as device:
        feed = feeds(PortChoice(str(device.path)))
        until(lambda: feed.status().state == "running")
        feed.record(Recorder(tmp_path / "a.frames", STREAM))
        until(lambda: feed.recording is not None and feed.recording.frames > 100)
        feed.end_recording()
        until(lambda: not feed.records)
        seen = feed.take().rows[:, 0]
        made = read_log(tmp_path / "a.frames").recording
        assert np.array_equal(np.diff(made.values[:, 0]), np.ones(len(made) - 1)) and len(made) > 100
        assert set(made.values[:, 0]) <= set(seen)
        until(lambda: feed.take().newest.values[0] > made.values[-1, 0])  # reading went on


def test_a_recording_is_whole_where_the_source_is_closed_in_its_midst(feeds, tmp_path):
    feed = feeds(SimulatorChoice("strain channels"))
    until(lambda: feed.status().state == "running")
    feed.record(Recorder(tmp_path / "a.csv", feed.status().stream))
    until(lambda: feed.recording is not None and feed.recording.frames > 20)
    feed.close()
    assert feed.join(2.0)
    recording = read_log(tmp_path / "a.csv").recording
    assert len(recording) > 20 and recording.stream.simulated


def test_a_disk_that_is_full_ends_the_recording_and_not_the_reading(feeds, tmp_path):
    feed = feeds(SimulatorChoice("strain channels"))
    until(lambda: feed.status().state == "running")
    recorder = Recorder(tmp_path / "a.frames", feed.status().stream)

    def full(frame):
        raise InputError("there is no room left on the disk")

    recorder.add = full
    feed.record(recorder)
    until(lambda: not feed.records)
    assert feed.recording_fault == "there is no room left on the disk"
    feed.take()
    until(lambda: len(feed.take().time))
    assert feed.status().state == "running"


def test_a_port_that_is_not_there_ends_in_a_sentence(feeds):
    feed = feeds(PortChoice("/dev/nowhere"))
    assert feed.join(5.0) and feed.status().state == "ended" and "there is no port /dev/nowhere" in feed.status().sentence


def test_a_fault_of_the_programs_own_is_logged(feeds):
    told = []

    def broken(stream):
        raise ZeroDivisionError("oh")

    feed = feeds(SimulatorChoice("strain channels"), contact=broken, log=told.append)
    assert feed.join(5.0) and "ZeroDivisionError" in feed.status().sentence and "Traceback" in told[0]


def test_a_port_is_let_go_before_it_is_opened_again(feeds):
    with PtyServer(STREAM, frames()) as device:
        first = feeds(PortChoice(str(device.path)))
        until(lambda: first.status().state == "running")
        second = feeds(PortChoice(str(device.path)), after=first)
        until(lambda: second.status().state != "opening")
        assert second.status().state == "running" and not first.alive


def test_contacts_of_a_hand_over_the_wire_light_up(feeds):
    trial = simulate("cube", seed=1)
    # As quick as it can be read: the touches are told by the device's time.
    with PtyServer(trial.recording.stream, trial.recording, rate_hz=2000.0) as device:
        feed = feeds(PortChoice(str(device.path)), contact=lambda stream: stream.names)
        begun = []
        until(lambda: begun.extend(c for c in feed.take().contacts if c.lasting) or len(begun) > 10, 20.0)
    truth = [touch for touch in trial.truth if touch.start < begun[-1].start + 0.1]
    found = [any(c.channel == t.channel and abs(c.start - t.start) < 0.3 for c in begun) for t in truth]
    assert np.mean(found) > 0.8


def test_a_log_that_is_sought_shows_what_was_before_and_knows_its_lights(feeds):
    log = read_log(LOGS / "contact_cube_1.csv").recording
    feed = feeds(LogChoice(LOGS / "contact_cube_1.csv", speed=1.0), contact=lambda stream: stream.names)
    until(lambda: feed.player is not None)
    feed.player.pause(True)
    feed.player.seek(4.6)  # S1 is touched from 4.00 to 5.25 s, says its truth
    k = int(np.searchsorted(log.device_time, 4.6 - 1e-9))
    news = feed.take()
    while not news.anew:
        news = feed.take()
    assert np.array_equal(news.rows[:, 0], log.column("S1")[:k], equal_nan=True) and np.allclose(news.time, log.device_time[:k])
    assert news.touched.keys() == {"S1"} and news.newest.sequence == k - 1
    assert feed.status().state == "running" and feed.player.paused
    feed.player.seek(3.0)
    until(lambda: feed.take().touched == {})


def test_a_rate_is_said_after_a_second_and_a_burst_does_not_count():
    """What a device had kept ready comes at once: 200 frames, and then 100 a second."""
    feed = Feed.__new__(Feed)
    feed._given, feed._frames, feed._first = collections.deque(), 0, math.inf
    said = {}
    assert math.isnan(feed._rate(50.0))
    feed._first = 50.0
    for k in range(1, 91):
        feed._frames = 200 + round(100 * k / 30)
        said[k] = feed._rate(50.0 + k / 30)
    assert all(math.isnan(said[k]) for k in range(1, 45)), "half a second of burst and one of counting"
    assert all(abs(said[k] - 100) < 2 for k in range(46, 91))
