"""What is held out, and how good a model is on it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.held_out import judge, splits_of
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.train import prepare


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


def test_the_test_part_is_held_out_where_there_is_one(trials_of: Callable[..., list[Trial]]) -> None:
    trials = trials_of("pins6", 1, part="yes")
    ((train, test),) = splits_of(trials, across=False)
    assert {trials[k].label.part for k in train} == {"train"} and {trials[k].label.part for k in test} == {"test"}
    held = judge(prepare(trials), [(train, test)], published=True)
    assert held.confusion.accuracy.value > 0.5 and np.isnan(held.place_mm).all()


def test_whole_participants_are_held_out(pins: list[Trial], trials_of: Callable[..., list[Trial]]) -> None:
    both = pins + trials_of("pins6", 2)
    splits = splits_of(both, across=True)
    assert [{both[k].label.participant for k in test} for _, test in splits] == [{"1"}, {"2"}]
    apart = judge(prepare(both), splits, across=True)
    assert set(apart.groups) == {"1", "2"}
    own = judge(prepare(pins), splits_of(pins, across=False))
    assert apart.right.mean() < own.right.mean()  # another finger is another instrument


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


def test_a_class_of_one_trial_cannot_be_held_out(pins: list[Trial]) -> None:
    single = [next(each for each in pins if each.label.label == name) for name in dict.fromkeys(each.label.label for each in pins)]
    with pytest.raises(InputError, match="single trial"):
        splits_of(single, across=False)
