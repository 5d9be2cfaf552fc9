import numpy as np
import pytest

from calibration.contact.simulator import simulate
from calibration.finger.logs import ROBOT, calibrated, finger_log
from calibration.strain.reading import AngleReader
from gui.live.watch import Watch
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream

HAND = simulate("cube", seed=1)
#: A frame in the midst of a long touch.
MIDST = next(int(t.start * 100) + 60 for t in HAND.truth if t.end - t.start > 1.0)


@pytest.fixture(scope="module")
def calibration():
    return calibrated(ROBOT, "play")


@pytest.fixture(scope="module")
def finger():
    time, _, volts = finger_log(ROBOT)
    return Recording.of_values(Stream("finger", (Channel("robot_V", "V", "strain"),), 100.0), volts[:, None], device_time=time)


def test_lights_are_on_during_true_touches_and_off_at_rest():
    recording, watch = HAND.recording, Watch(HAND.recording.stream, contact=HAND.recording.stream.names)
    right = wrong = 0
    for frame in recording:
        watch.step(frame)
        for touch in HAND.truth:
            # In the midst of it: what a person sees.
            if touch.start + 0.3 < frame.device_time < touch.end - 0.4:
                right += touch.channel in watch.touched
                wrong += touch.channel not in watch.touched
    assert right > 20 * wrong  # drop-outs of the simulated wires
    assert watch.touched == {}


def test_sought_is_as_watched_all_along():
    recording = HAND.recording
    k = MIDST
    one, two = (Watch(recording.stream, contact=recording.stream.names) for _ in range(2))
    for j in range(k):
        one.step(recording.frame(j))
    two.step(recording.frame(500))  # of elsewhere
    two.catch_up(recording, k)
    assert one.touched == two.touched != {}


def test_a_rate_that_nobody_states_is_counted_and_nothing_of_it_is_lost():
    made = HAND.recording
    plain = Recording(Stream("p", made.stream.channels), *(getattr(made, n) for n in ("device_time", "host_time", "sequence")),
                      made.values, made.valid, made.saturated)  # fmt: skip
    stated, counted = Watch(made.stream, contact=made.stream.names), Watch(plain.stream, contact=made.stream.names)
    for k in range(MIDST):
        stated.step(made.frame(k))
        counted.step(plain.frame(k))
        assert counted.blind == "counting frames for 2 s" or counted.rate_hz == pytest.approx(100.0)
    assert counted.touched == pytest.approx(stated.touched) and stated.touched


def test_angles_are_those_of_the_calibration(calibration, finger):
    watch = Watch(finger.stream, contact=())
    watch.calibrate(calibration)
    reader = AngleReader(calibration, finger.stream)
    for frame in finger:
        watch.step(frame)
        assert watch.reading.angle == reader.step(frame).angle
    assert watch.blind == "" and 5 < watch.reading.angle < 85
    last = watch.catch_up(finger, 1000)
    assert len(last) == 1000 and watch.reading.angle == last[-1]
    watch.calibrate(None)
    assert watch.reading is None and len(watch.catch_up(finger, 10)) == 0


def test_a_channel_that_is_not_there_is_refused_and_nothing_is_read(calibration, finger):
    watch = Watch(Stream("other", (Channel("U"),), 100.0), contact=())
    with pytest.raises(InputError, match="robot_V"):
        watch.calibrate(calibration)
    with pytest.raises(InputError, match="cut-off"):
        Watch(Stream("slow", (Channel("robot_V"),), 4.0), contact=()).calibrate(calibration)


def test_it_says_what_keeps_contacts_from_being_seen():
    watch = Watch(HAND.recording.stream, contact=("S1", "S2"))
    assert "S1, S2" in watch.blind and "at rest for 3 s" in watch.blind
    for k in range(320):
        watch.step(HAND.recording.frame(k))
    assert watch.blind == ""
    watch.watch(("S3",))
    assert "S3" in watch.blind
    assert "no contacts" in Watch(Stream("slow", (Channel("S1"),), 1e-9), contact=("S1",)).blind


def test_frames_of_unknown_rate_whose_clock_goes_back_are_counted_anew():
    watch = Watch(Stream("p", (Channel("S1"),)), contact=("S1",))
    times = np.concatenate([50 + np.arange(100) / 100, np.arange(300) / 100])
    for frame in Recording.of_values(watch.stream, np.random.default_rng(0).normal(100, 1, (400, 1)), device_time=times):
        watch.step(frame)
    assert watch.rate_hz == pytest.approx(100.0)
