"""Continuous numbers: nearer to where the finger really is than any class, forces from amplitudes, and circles that close."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.nail.improved import asked, frequency, label_of, learn
from skinfab.fingertip.nail.labels import Label
from skinfab.fingertip.nail.phasors import find_drive, lock_in, turned_phasors
from skinfab.fingertip.nail.protocol import Protocol, Session, session, sessions
from skinfab.fingertip.nail.regress import Regression, angle_apart, by_probability, continuous_of, foot, learnable, targets_of
from skinfab.fingertip.nail.simulator import RATE_HZ, Scene, readings


@pytest.fixture(scope="module")
def people() -> list[Session]:
    return list(sessions("edges12", protocol=Protocol(participants=3, rounds=4, estimates=1, samples=256), seed=5))


def errors(estimate: np.ndarray, truth: np.ndarray) -> tuple[float, float]:
    angles = [[continuous_of(row).angle_deg for row in of] for of in (estimate, truth)]
    return float(angle_apart(*angles).mean()), float(np.linalg.norm(estimate[:, 2:4] - truth[:, 2:4], axis=1).mean())


def test_regression_beats_classes_and_probabilities(people: list[Session]) -> None:
    found: dict[str, list[tuple[float, float]]] = {}
    for each in people:
        model, windows = learn(each), asked(each)
        aimed = targets_of([label_of(touch) for touch in each.training.touches])
        truth = targets_of([label_of(touch) for touch in each.rounds.touches], true=True)
        drive, _ = turned_phasors(windows, RATE_HZ, frequency(windows, model), model.reference)
        decided = model.decide_phasors(drive, 256)
        found.setdefault("regression", []).append(errors(Regression(model, aimed).estimate(model.features(drive)), truth))
        found.setdefault("weighted", []).append(errors(by_probability(model, aimed, decided.probability), truth))
        hard = np.eye(len(model.touched))[decided.probability.argmax(axis=1)]
        found.setdefault("class", []).append(errors(by_probability(model, aimed, hard), truth))
    mean = {name: np.mean(each, axis=0) for name, each in found.items()}
    assert mean["regression"][0] < 0.8 * min(mean["weighted"][0], mean["class"][0])
    assert mean["regression"][1] < 0.95 * min(mean["weighted"][1], mean["class"][1])


def test_a_force_from_amplitudes(people: list[Session]) -> None:
    each = people[0]
    rng = np.random.default_rng(0)

    def pressed(touches: tuple) -> tuple[list, np.ndarray]:  # type: ignore[type-arg]
        harder = [t if t.pattern is None else replace(t, force_n=float(np.exp(rng.uniform(math.log(0.3), math.log(3.0))))) for t in touches]
        return harder, readings(each.finger, harder, rng, samples=256)

    touches, windows = pressed(each.training.touches)
    drive_hz = find_drive(windows, RATE_HZ)
    found = lock_in(windows, RATE_HZ, drive_hz)
    model = replace(learn(each), drive=found.drive)
    targets, notes = learnable(targets_of([label_of(touch) for touch in touches]))
    assert notes == []
    test, windows = pressed(each.rounds.touches)
    drive, _ = turned_phasors(windows, RATE_HZ, find_drive(windows, RATE_HZ), model.reference)
    estimate = Regression(model, targets).estimate(model.features(drive))[:, 4]
    true = np.log([touch.force_n for touch in test])
    assert np.abs(estimate - true).mean() < 0.6 * np.abs(true - targets[np.isfinite(targets[:, 4]), 4].mean()).mean()
    assert np.corrcoef(estimate, true)[0, 1] > 0.7


def test_forces_that_are_alike_are_not_learned() -> None:
    targets = targets_of([Label("a", 0, 1, "x", force_n=force) for force in (0.9, 1.0, 1.2)])
    kept, notes = learnable(targets)
    assert np.isnan(kept[:, 4]).all() and "forces from 0.9 to 1.2 N are too much alike" in notes[0]


def test_what_never_differs_is_not_learned() -> None:
    star = targets_of([Label("a", 0, 1, "x", x_mm=0.0, y_mm=0.0, angle_deg=angle) for angle in (0.0, 45.0, 90.0)])
    kept, notes = learnable(star)
    assert np.isnan(kept[:, 2:4]).all() and np.array_equal(kept[:, :2], star[:, :2])
    assert notes == ["all patterns have their foot at one place, and no other can be learned from them; touch some to the side too"]
    rows = targets_of([Label("a", 0, 1, "x", x_mm=0.0, y_mm=y, angle_deg=180.0 * (y > 0)) for y in (-7.5, 0.0, 7.5)])
    kept, notes = learnable(rows)
    assert np.isnan(kept[:, :2]).all() and np.array_equal(kept[:, 2:4], rows[:, 2:4]) and "one direction" in notes[0]


@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(0, 180), st.floats(-30, 30))
def test_a_foot_is_the_same_along_the_edge(x: float, y: float, angle: float, along: float) -> None:
    here = foot(x, y, angle)
    moved = foot(x + along * math.cos(math.radians(angle)), y + along * math.sin(math.radians(angle)), angle)
    np.testing.assert_allclose(here, moved, atol=1e-9)
    assert np.linalg.norm(here) <= math.hypot(x, y) + 1e-9


@given(st.floats(0, 179.9))
def test_a_direction_comes_back(angle: float) -> None:
    (target,) = targets_of([Label("a", 0, 1, "x", x_mm=1.0, y_mm=2.0, angle_deg=angle)])
    found = continuous_of(target)
    assert angle_apart(found.angle_deg, angle) < 1e-9 and math.isnan(found.force_n)


def test_pins_have_no_direction() -> None:
    (target,) = targets_of([Label("a", 0, 1, "pin", x_mm=3.0, y_mm=-6.0, force_n=1.0)])
    found = continuous_of(target)
    assert math.isnan(found.angle_deg) and (found.x_mm, found.y_mm, found.force_n) == pytest.approx((3.0, -6.0, 1.0))


def test_a_target_a_trial(people: list[Session]) -> None:
    with pytest.raises(InputError, match="give 5 a trial"):
        Regression(learn(people[0]), np.zeros((3, 5)))


def test_a_force_outside_what_was_learned_is_told_as_at_the_end() -> None:
    settings = Protocol(training=5, rounds=2, estimates=1, samples=128)

    def told(force_n: tuple[float, float]) -> list[str]:
        out = []
        for number in (1, 2):
            one = session("edges4", number, protocol=settings, scene=Scene(force_n=(0.3, 3.0)), seed=2)
            model = learn(one)
            regression = Regression(model, targets_of([label_of(each) for each in one.training.touches]))
            windows = asked(session("edges4", number, protocol=settings, scene=Scene(force_n=force_n), seed=2), 33)
            x = model.features(turned_phasors(windows, model.rate_hz, model.drive_hz, model.reference)[0])
            out += [regression.continuous(each).force_end for each in x]
        return out

    within, more, less = told((0.5, 1.8)), told((6.0, 10.0)), told((0.02, 0.1))
    assert within.count("") > 0.75 * len(within)
    assert more.count("high") > 0.7 * len(more) and less.count("low") > 0.4 * len(less) and "low" not in more and "high" not in less
