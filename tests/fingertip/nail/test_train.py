"""Learning from labelled trials: whole groups held out, short trials and broken channels told of, and errors against the labels."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.improved import label_of
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.protocol import Protocol, Trials, session
from skinfab.fingertip.nail.simulator import RATE_HZ
from skinfab.fingertip.nail.train import judge, prepare, splits_of


def trials_of(test: str, number: int, *, part: str = "", training: int = 4, samples: int = 256) -> list[Trial]:
    each = session(test, number, protocol=Protocol(training=training, rounds=3, estimates=1, samples=samples), seed=9)

    def made(of: Trials, part: str) -> list[Trial]:
        values = of.readings.reshape(len(of.touches), -1, 6)
        labels = [replace(label_of(t), participant=str(number), trial=f"{part}{k}", part=part) for k, t in enumerate(of.touches)]
        return [Trial(label, v, np.zeros(v.shape, dtype=bool), RATE_HZ) for label, v in zip(labels, values, strict=True)]

    return made(each.training, "train" if part else "") + (made(each.rounds, "test") if part else [])


@pytest.fixture(scope="module")
def pins() -> list[Trial]:
    return trials_of("pins6", 1)


def test_whole_trials_are_held_out(pins: list[Trial]) -> None:
    halves = (slice(128), slice(128, 256))  # of one trial
    twice = [replace(each, values=each.values[half], saturated=each.saturated[half]) for each in pins for half in halves]
    made = prepare(twice)
    splits = splits_of(made.trials, across=False)
    for train, test in splits:
        assert not {twice[k].label.trial for k in train} & {twice[k].label.trial for k in test}
    held = judge(made, splits)
    assert held.confusion.counts.sum() == len(twice) and held.confusion.accuracy.value > 0.7
    assert np.nanmean(held.place_mm) < 3 and np.isnan(held.angle_deg).all()  # pins have no direction
    assert len(set(held.groups)) == len(pins)


def test_the_test_part_is_held_out_where_there_is_one() -> None:
    trials = trials_of("pins6", 1, part="yes")
    ((train, test),) = splits_of(trials, across=False)
    assert {trials[k].label.part for k in train} == {"train"} and {trials[k].label.part for k in test} == {"test"}
    held = judge(prepare(trials), [(train, test)], published=True)
    assert held.confusion.accuracy.value > 0.5 and np.isnan(held.place_mm).all()


def test_whole_participants_are_held_out(pins: list[Trial]) -> None:
    both = pins + trials_of("pins6", 2)
    splits = splits_of(both, across=True)
    assert [{both[k].label.participant for k in test} for _, test in splits] == [{"1"}, {"2"}]
    apart = judge(prepare(both), splits, across=True)
    assert set(apart.groups) == {"1", "2"}
    own = judge(prepare(pins), splits_of(pins, across=False))
    assert apart.right.mean() < own.right.mean()  # another finger is another instrument


def test_what_is_said_of_the_trials(pins: list[Trial]) -> None:
    dead = [replace(each, values=np.where(np.arange(6) == 1, np.nan, each.values)) for each in pins]
    assert any("channel Ay has too few readings" in note for note in prepare(dead).notes)
    clipped = [replace(each, saturated=np.abs(each.values) > 0.8 * np.abs(each.values).max(axis=0)) for each in pins]
    assert any("at the end of its range in" in note for note in prepare(clipped).notes)
    assert any("has 4 trials; five" in note for note in prepare(pins).notes)
    touching = [each for each in pins if each.label.label != "none"]
    assert any("no trial is without contact" in note for note in prepare(touching).notes)


def test_short_trials_need_the_motors_frequency(pins: list[Trial]) -> None:
    short = [replace(each, values=each.values[:40], saturated=each.saturated[:40]) for each in pins]
    with pytest.raises(InputError, match="40 readings are too few to find the motor's frequency in; give it with --drive"):
        prepare(short)
    made = prepare(short, drive_hz=169.0)
    assert judge(made, splits_of(short, across=False)).confusion.accuracy.value > 0.7


def test_what_cannot_be_learned(pins: list[Trial]) -> None:
    noise = np.random.default_rng(0).normal(size=(256, 6))
    for off in (np.ones((256, 6)), np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]) + 0.01 * noise):
        with pytest.raises(InputError, match="the motor does not turn: nothing that vibrates stands out of the noise; was it on"):
            prepare([replace(pins[0], values=off)])
    with pytest.raises(InputError, match="record all of them at one rate"):
        prepare([pins[0], replace(pins[1], rate_hz=700.0)])
    single = [next(each for each in pins if each.label.label == name) for name in dict.fromkeys(each.label.label for each in pins)]
    with pytest.raises(InputError, match="single trial"):
        splits_of(single, across=False)


def test_parts_of_a_touch_without_a_name_are_held_out_together(pins: list[Trial]) -> None:
    """Cut in two and without names: as one touch each, not as one that the model knows half of."""
    halves = []
    for k, each in enumerate(pins):
        for j in range(2):
            label = replace(each.label, log="a.csv", trial="", start_s=k + 0.1 * j, end_s=k + 0.1 * (j + 1))
            halves.append(replace(each, label=label, values=each.values[128 * j :][:128], saturated=each.saturated[128 * j :][:128]))
    splits = splits_of(halves, across=False)
    assert all({k // 2 for k in train}.isdisjoint(k // 2 for k in test) for train, test in splits)
    notes = prepare(halves, drive_hz=169.0).notes
    assert any("taken for 28 touches, where those of one label" in note for note in notes) and any("has 4 trials" in note for note in notes)


def test_a_frequency_that_is_given_must_be_in_the_readings(pins: list[Trial]) -> None:
    assert prepare(pins, drive_hz=169.5).drive_hz.tolist() == [169.5] * len(pins)
    for hz, says in ((120.0, "--drive 120 is 49 Hz off: the motor turns at 169"), (1690.0, "--drive 1690 is above half of 1400 readings")):
        with pytest.raises(InputError, match=says):
            prepare(pins, drive_hz=hz)
    still = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]) + 0.01 * np.random.default_rng(0).normal(size=(256, 6))
    for off in (still, still[:40]):
        with pytest.raises(InputError, match="nothing of 169 Hz stands out of the noise; was the motor on"):
            prepare([*pins, replace(pins[0], values=off, saturated=np.zeros(off.shape, dtype=bool))], drive_hz=169.0)


def test_the_published_method_needs_all_six_channels(pins: list[Trial]) -> None:
    still = [replace(each, values=np.where(np.arange(6) == 4, 1.25, each.values)) for each in pins]
    with pytest.raises(InputError, match="channel Gy has too few readings in some trials, or stands still, and the published method needs"):
        prepare(still).fit_published(np.arange(len(pins)))
