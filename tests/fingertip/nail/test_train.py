"""From labelled trials to a model: what it needs, and what is said of trials that do not have it."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.held_out import judge, splits_of
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.train import prepare


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
