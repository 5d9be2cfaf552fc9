"""Decisions as readings come: at the right moments, through gaps, lost frames and a device that begins anew, while the motor drifts."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.histogram_model import fit_histograms
from skinfab.fingertip.nail.improved import learn
from skinfab.fingertip.nail.live import NailWatch, Told, decide_log
from skinfab.fingertip.nail.protocol import Protocol, Session, session
from skinfab.fingertip.nail.simulator import RATE_HZ, nail_stream, readings
from skinfab.readout.frame import Channel, Recording, Stream


@pytest.fixture(scope="module")
def one() -> Session:
    return session("pins6", 1, protocol=Protocol(training=5, rounds=1, estimates=1, samples=512), seed=8)


@pytest.fixture(scope="module")
def model(one: Session) -> NailModel:
    return learn(one)


def log(values: np.ndarray, stream: Stream | None = None) -> Recording:
    return Recording.of_values(stream or nail_stream(), values, device_time=np.arange(len(values)) / RATE_HZ)


def right(told: list[Told], one: Session, model: NailModel, *, samples: int = 512) -> float:
    """Part of the windows within a touch that are right."""
    good = []
    for each in told:
        trial, since = divmod(round(each.time_s * RATE_HZ), samples)
        if since >= 33 and each.decision is not None:
            good.append(each.decision.label == model.names[one.rounds.classes[trial]])
    return float(np.mean(good))


def test_a_decision_every_few_readings(one: Session, model: NailModel) -> None:
    told, lost = decide_log(model, log(one.rounds.readings[0, 0]), samples=33, every=10)
    assert lost == 0 and [round(each.time_s * RATE_HZ) for each in told[:3]] == [32, 42, 52]
    assert len(told) == 48 and all(each.left_out == 0 for each in told)


def test_a_whole_log(one: Session, model: NailModel) -> None:
    told, _ = decide_log(model, log(one.rounds.readings.reshape(-1, 6)), samples=33, every=8)
    assert right(told, one, model) > 0.7


def test_frame_by_frame_is_the_same(one: Session, model: NailModel) -> None:
    recording = log(one.rounds.readings[1, 0])
    watch = NailWatch(model, recording.stream, samples=33, every=8)
    frames = [made for frame in recording if (made := watch.step(frame)) is not None]
    assert frames == decide_log(model, recording, samples=33, every=8)[0]


def test_lost_frames_leave_a_gap_in_their_place(one: Session, model: NailModel) -> None:
    recording = log(one.rounds.readings[2, 0])
    kept = np.ones(512, dtype=bool)
    kept[100:105] = kept[200:205] = False
    holed = Recording(
        *(recording.stream, recording.device_time[kept], recording.host_time[kept], recording.sequence[kept]),
        *(recording.values[kept], recording.valid[kept], recording.saturated[kept]),
    )
    told, lost = decide_log(model, holed, samples=33, every=1)
    assert lost == 10
    whole = {round(each.time_s * RATE_HZ): each for each in decide_log(model, recording, samples=33, every=1)[0]}
    at = next(each for each in told if round(each.time_s * RATE_HZ) == 110)
    same = whole[110]
    assert at.left_out == pytest.approx(5 / 33) and at.decision is not None and same.decision is not None
    assert at.decision.label == same.decision.label and at.decision.confidence == pytest.approx(same.decision.confidence, abs=0.25)


def test_a_device_that_begins_anew(one: Session, model: NailModel) -> None:
    watch = NailWatch(model, nail_stream(), samples=33, every=1)
    rows = one.rounds.readings[0, 0]
    made = [watch.take(row, k, k / RATE_HZ) for k, row in enumerate(rows[:100])]
    again = [watch.take(row, k, k / RATE_HZ) for k, row in enumerate(rows[:100])]
    assert sum(each is not None for each in made) == sum(each is not None for each in again) == 68 and watch.lost == 0


def test_the_motor_is_followed(one: Session, model: NailModel) -> None:
    rng = np.random.default_rng(0)
    touches = [replace(one.rounds.touches[0], drive_hz=169.0)]
    values = readings(one.finger, touches, rng, samples=4096, drift_hz_per_s=3.0)[0]
    told, _ = decide_log(model, log(values), samples=33, every=8)
    true = [169.0 + 3.0 * (each.time_s - 128 / RATE_HZ) for each in told]
    assert max(abs(each.drive_hz - hz) for each, hz in list(zip(told, true, strict=True))[40:]) < 0.6


def test_saturated_and_missing_readings_are_left_out(one: Session, model: NailModel) -> None:
    stream = nail_stream()
    narrow = replace(stream, channels=tuple(replace(each, low=each.low / 3, high=each.high / 3) for each in stream.channels))
    values = one.rounds.readings.reshape(-1, 6)
    ends = np.array([each.high for each in narrow.channels])
    told, _ = decide_log(model, log(np.clip(values, -ends, ends), narrow), samples=33, every=8)
    assert max(each.left_out for each in told) > 0.05 and right(told, one, model) > 0.7
    values = values.copy()
    values[:, 5] = np.nan
    told, _ = decide_log(model, log(values), samples=33, every=8)
    assert {each.decision.missing for each in told if each.decision} == {("Gz",)} and right(told, one, model) > 0.6


def test_silence_is_not_decided(model: NailModel) -> None:
    told, _ = decide_log(model, log(np.full((300, 6), np.nan)), samples=33, every=8)
    assert told and all(each.decision is None and each.left_out == 1 for each in told)


def test_the_published_machine(one: Session) -> None:
    names = learn(one).names
    model = fit_histograms(names, one.training.classes, one.training.readings[:, 0], rate_hz=RATE_HZ)
    told, _ = decide_log(model, log(one.rounds.readings.reshape(-1, 6)), samples=33, every=512)
    said = [each.decision.label for each in told if each.decision]
    assert len(said) == 6 and said == [names[k] for k in model.decide(one.rounds.readings[:, 0])]


def test_streams_that_do_not_fit(model: NailModel) -> None:
    with pytest.raises(InputError, match="700 readings a second and the model learned from 1400"):
        NailWatch(model, replace(nail_stream(), rate_hz=700.0), samples=33, every=8)
    with pytest.raises(InputError, match="does not say how many frames"):
        NailWatch(model, replace(nail_stream(), rate_hz=0.0), samples=33, every=8)
    with pytest.raises(InputError, match="none of the channels"):
        NailWatch(model, Stream("s", (Channel("U"),), 1400.0), samples=33, every=8)
    with pytest.raises(InputError, match="a window of 7 readings is none; give 8 to 16384"):
        NailWatch(model, nail_stream(), samples=7, every=8)


def test_a_rate_that_is_a_little_off(one: Session, model: NailModel) -> None:
    """A clock that is 4 % fast says 1456 readings a second and a motor 4 % faster: the very same readings."""
    values = one.rounds.readings.reshape(-1, 6)
    fast = Recording.of_values(nail_stream(), values, device_time=np.arange(len(values)) / (1.04 * RATE_HZ))
    settings = {"samples": 256, "every": 512 // 4}
    own, off = (decide_log(model, each, **settings)[0] for each in (log(values), fast))
    same = [a.decision.label == b.decision.label for a, b in zip(own, off, strict=True) if a.decision and b.decision]
    assert len(same) > 20 and np.mean(same[2:]) > 0.95  # the first come before the motor was found
    assert off[-1].drive_hz == pytest.approx(1.04 * own[-1].drive_hz, abs=0.3)


@pytest.mark.parametrize("spread", [0.0, 1.0])
def test_a_motor_that_is_off_decides_nothing(one: Session, model: NailModel, spread: float) -> None:
    rng = np.random.default_rng(3)
    off = np.array([0.1, 0.2, 0.96, 0.0, 0.0, 0.0]) + spread * np.array([0.02] * 3 + [2.0] * 3) * rng.standard_normal((4096, 6))
    told, _ = decide_log(model, log(off), samples=33, every=8)
    assert len(told) > 500 and all(each.decision is None and each.turning is False and np.isnan(each.drive_hz) for each in told)
    both = np.concatenate([one.rounds.readings[:2, 0].reshape(-1, 6), off])  # switched off after 1024 readings
    told, _ = decide_log(model, log(both), samples=33, every=8)
    at = [(round(each.time_s * RATE_HZ), each.decision) for each in told]
    assert all(decision is not None for k, decision in at if k < 1024) and all(decision is None for k, decision in at if k > 1024 + 128)
    noise = [each.decision for each in told if 1024 + 33 < round(each.time_s * RATE_HZ) <= 1024 + 128 and each.decision]
    assert bool(noise) == (spread > 0) and all(each.strange for each in noise)  # until it is told; a sensor that hangs is none


def test_the_published_machine_closes_gaps_up_and_says_what_stands_still(one: Session) -> None:
    """As it does when it learns: a histogram does not mind what lies between its readings, but needs all channels of each."""
    names = learn(one).names
    model = fit_histograms(names, one.training.classes, one.training.readings[:, 0], rate_hz=RATE_HZ)
    values = np.concatenate([one.rounds.readings[2, 0]] * 3)
    kept = np.random.default_rng(0).uniform(size=len(values)) > 0.02
    time = np.arange(len(values)) / RATE_HZ
    told, lost = decide_log(model, Recording.of_values(nail_stream(), values[kept], device_time=time[kept]), samples=33, every=512)
    said = [each.decision.label for each in told if each.decision]
    assert lost > 20 and len(said) == 2 and said[0] == names[model.decide(values[kept][None, :512])[0]]
    frozen = np.where(np.arange(6) == 4, 1.25, values)
    told, _ = decide_log(model, log(frozen), samples=33, every=512)
    assert len(told) == 3 and all("channel Gy stands still, and the published method needs all six" in each.reason for each in told)
    five = replace(nail_stream(), channels=nail_stream().channels[:5])
    with pytest.raises(InputError, match="has no Gz, and the published method needs all six channels"):
        NailWatch(model, five, samples=33, every=8)
