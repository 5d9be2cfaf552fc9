"""Classes from phasors: as good at 8 readings as at 256, sure where it is right, and without a channel that is gone."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import fit_phasors
from skinfab.fingertip.nail.improved import asked, frequency, learn
from skinfab.fingertip.nail.protocol import Protocol, Session, session, sessions
from skinfab.fingertip.nail.simulator import RATE_HZ, participant, readings, touch

SMALL = Protocol(participants=3, training=5, rounds=4, estimates=1, samples=256)


@pytest.fixture(scope="module")
def people() -> list[Session]:
    return list(sessions("edges12", protocol=SMALL, seed=3))


@pytest.fixture(scope="module")
def one() -> Session:
    return session("pins6", 1, protocol=replace(SMALL, rounds=3), seed=3)


def accuracy(people: list[Session], samples: int) -> float:
    right = []
    for each in people:
        model, windows = learn(each), asked(each, samples)
        right.append(model.decide(windows, drive_hz=frequency(windows, model)).classes == each.rounds.classes)
    return float(np.mean(right))


def test_short_windows_are_nearly_as_good_as_long_ones(people: list[Session]) -> None:
    long, short = accuracy(people, 256), accuracy(people, 8)
    assert long > 0.6 and short > long - 0.08  # by chance it were 0.08


def test_it_is_about_as_sure_as_it_is_right(people: list[Session]) -> None:
    sure, right = [], []
    for each in people:
        model, windows = learn(each), asked(each)
        found = model.decide(windows, drive_hz=frequency(windows, model))
        np.testing.assert_allclose(found.probability.sum(axis=1), 1)
        sure.append(found.confidence)
        right.append(found.classes == each.rounds.classes)
    assert np.mean(np.concatenate(sure)) == pytest.approx(np.mean(np.concatenate(right)), abs=0.05)
    halves = np.array_split(np.concatenate(right)[np.argsort(np.concatenate(sure))], 2)
    assert halves[1].mean() > halves[0].mean() + 0.1


def test_units_do_not_matter(one: Session) -> None:
    model = learn(one)
    units = np.array([9.81, 9.81, 9.81, 0.017, 0.017, 0.017])
    other = fit_phasors(
        model.names, model.classes, model.drive * units, model.noise[None] * units, rate_hz=model.rate_hz, drive_hz=model.drive_hz
    )
    windows = asked(one, 33)
    a, b = model.decide(windows), other.decide(windows * units)
    assert (a.classes == b.classes).all() and np.allclose(a.probability, b.probability)


def test_contact_and_no_contact(one: Session) -> None:
    model = learn(one)
    rng = np.random.default_rng(0)
    for samples in (8, 33, 256):
        free = readings(one.finger, [touch(None, rng) for _ in range(200)], rng, samples=samples)
        found = model.decide(free)
        assert not found.contact.any() and set(found.classes.tolist()) == {0} and not found.strange.any()
        assert model.decide(asked(one, samples)).contact.all()
    assert model.gate_is_safe


def test_without_trials_at_rest_all_is_contact(one: Session) -> None:
    model = learn(one)
    kept = model.classes > 0
    blind = replace(model, classes=model.classes[kept], drive=model.drive[kept])
    free = readings(one.finger, [touch(None, np.random.default_rng(0))], np.random.default_rng(0), samples=33)
    assert blind.decide(free).contact.all() and not blind.gate_is_safe


def test_a_vibration_like_none_that_was_learned_is_strange(one: Session) -> None:
    model = learn(one)
    assert model.decide(asked(one)).strange.mean() < 0.1
    other = participant(np.random.default_rng(77))
    rng = np.random.default_rng(1)
    windows = readings(other, [touch(each.pattern, rng) for each in one.rounds.touches], rng, samples=256)
    turned_over = windows[..., [1, 0, 2, 4, 3, 5]]  # the sensor glued on the other way
    assert model.decide(turned_over).strange.mean() > 0.9


def test_a_channel_less(one: Session) -> None:
    model = learn(one)
    gone = np.array([False, False, True, False, False, False])
    windows = asked(one, 64)
    windows[..., 2] = np.nan
    with pytest.raises(InputError, match="channel Az has too few readings"):
        model.decide(windows)
    left = model.without(gone)
    whole = (model.decide(asked(one, 64)).classes == one.rounds.classes).mean()
    assert left.learned.shape[1] == 10 and (left.decide(windows).classes == one.rounds.classes).mean() > whole - 0.1
    with pytest.raises(InputError, match="1 of the six channels are left"):
        left.without(np.array([True, True, True, True, False, True]) & left.channels)


def test_what_cannot_be_learned(one: Session) -> None:
    model = learn(one)
    few, drive = model.classes <= 1, model.drive.copy()
    drive[0, :5] = np.nan
    with pytest.raises(InputError, match="1 class of contact"):
        fit_phasors(model.names, model.classes[few], model.drive[few], model.noise[None], rate_hz=RATE_HZ, drive_hz=169.0)
    with pytest.raises(InputError, match="1 of the six channels have readings"):
        fit_phasors(model.names, model.classes, drive, model.noise[None], rate_hz=RATE_HZ, drive_hz=169.0)


@pytest.mark.parametrize("trials", [1, 2])
def test_one_or_two_trials_a_class_do(trials: int) -> None:
    each = session("pins6", 2, protocol=replace(SMALL, training=trials, rounds=3), seed=3)
    model = learn(each)
    assert model.temperature > 1 and (model.decide(asked(each)).classes == each.rounds.classes).mean() > 0.5


def test_trials_of_one_group_do_not_vouch_for_each_other(people: list[Session]) -> None:
    """Another finger is another instrument: a model of several must be less sure of the next one than of these."""
    models = [learn(each) for each in people]
    both = models[0].classes, np.concatenate([each.drive for each in models]), np.repeat(models[0].noise[None], 3, axis=0)
    classes = np.concatenate([each.classes for each in models])
    settings = {"rate_hz": RATE_HZ, "drive_hz": models[0].drive_hz}
    groups = np.repeat(range(3), len(both[0])).tolist()
    alone = fit_phasors(models[0].names, classes, both[1], both[2], **settings)
    apart = fit_phasors(models[0].names, classes, both[1], both[2], groups=groups, **settings)
    assert apart.temperature > 1.5 * alone.temperature
    one = fit_phasors(models[0].names, classes, both[1], both[2], groups=["Ann"] * len(classes), **settings)
    assert one.temperature == pytest.approx(12)  # nothing can be held out
