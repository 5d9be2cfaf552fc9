"""The paper's experiment on simulated participants: who touches what how often, and how often each sensor condition is right.

Each participant learns and is tested alone: five trials of each class, no contact being one, then ten rounds over all patterns.
A trial of the learning phase is one window of 1024 readings; one of the test phase is ten windows in a row, and what most of the ten
estimates say counts. No touch is in both phases.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.confusion import Confusion
from skinfab.fingertip.nail.finger import Finger
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.published import CONDITIONS, columns, fit, histograms, modes
from skinfab.fingertip.nail.simulator import WINDOW, Scene, Touch, participant, readings, running, touch

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: The order of the tests is part of what a seed gives.
_TEST_NUMBER = {name: k for k, name in enumerate(TESTS)}


@dataclass(frozen=True)
class Protocol:
    """How much is recorded; the defaults are the paper's.

    Parameters
    ----------
    participants : int
    training : int
        Trials of each class, no contact being one.
    rounds : int
        Of the test, over all patterns but not no contact.
    estimates : int
        Windows of a trial of the test.
    samples : int
        Readings of a window.
    """

    participants: int = 10
    training: int = 5
    rounds: int = 10
    estimates: int = 10
    samples: int = WINDOW

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value < 1:
                raise InputError(f"{value} {name} are none; a test needs one at least")


@dataclass(frozen=True, eq=False)
class Trials:
    """What was recorded of some touches.

    Parameters
    ----------
    touches : tuple of n Touch
        The truth.
    classes : (n,) int
        0 is no contact, k the k-th pattern of the test.
    readings : (n, estimates, samples, 6) float
        Windows one after the other.
    """

    touches: tuple[Touch, ...]
    classes: IntArray
    readings: FloatArray


@dataclass(frozen=True, eq=False)
class Session:
    """One participant in one test.

    Parameters
    ----------
    test : str
        One of `TESTS`.
    participant : int
        From 1.
    finger : Finger
    training, rounds : Trials
    """

    test: str
    participant: int
    finger: Finger
    training: Trials
    rounds: Trials


@dataclass(frozen=True, eq=False)
class Outcome:
    """What came out of a test.

    Parameters
    ----------
    test : str
    accuracy : dict of (participants,) float
        Part of each participant's trials that were right, by condition.
    confusion : dict of Confusion
        All participants' trials, by condition; the classes are called by their numbers, as in the paper's figures, and 0 is no contact.
    """

    test: str
    accuracy: dict[str, FloatArray]
    confusion: dict[str, Confusion]

    def mean(self, condition: str) -> float:
        """Of the participants' accuracies."""
        return float(self.accuracy[condition].mean())

    def deviation(self, condition: str) -> float:
        """Standard deviation among participants."""
        return float(self.accuracy[condition].std(ddof=1))


def session(
    test: str, number: int, *, protocol: Protocol | None = None, scene: Scene | None = None, seed: int = 0, in_a_row: bool = False
) -> Session:
    """Record one participant; the same seed gives the same finger in all three tests, and other touches.

    Parameters
    ----------
    test : str
        One of `TESTS`.
    number : int
        Of the participant, from 1.
    in_a_row : bool
        The motor runs on from each trial to the next, as in one log of all of them; else each is recorded for itself.
    """
    if test not in TESTS:
        raise InputError(f"there is no test {test!r}; there are {', '.join(TESTS)}")
    p, patterns = protocol or Protocol(), TESTS[test]
    finger = participant(np.random.default_rng([seed, number]), scene)
    rng = np.random.default_rng([seed, number, _TEST_NUMBER[test]])

    drive_hz = (scene or Scene()).drive_hz
    turned = 0.0

    def recorded(classes: IntArray, estimates: int) -> Trials:
        nonlocal turned
        touches = tuple(touch(None if k == 0 else patterns[k - 1], rng, scene) for k in classes)
        samples = estimates * p.samples
        *begun, turned = running(drive_hz, samples, len(touches) + 1, begun=turned)
        values = readings(finger, touches, rng, samples=samples, scene=scene, begun=np.array(begun) if in_a_row else None)
        return Trials(touches, classes, values.reshape(len(classes), estimates, p.samples, 6))

    training = recorded(np.repeat(np.arange(len(patterns) + 1), p.training), 1)
    rounds = recorded(np.tile(np.arange(1, len(patterns) + 1), p.rounds), p.estimates)
    return Session(test, number, finger, training, rounds)


def sessions(test: str, *, protocol: Protocol | None = None, scene: Scene | None = None, seed: int = 0) -> Iterator[Session]:
    """Each participant's in turn."""
    for number in range(1, (protocol or Protocol()).participants + 1):
        yield session(test, number, protocol=protocol, scene=scene, seed=seed)


def published_answers(of: Session, conditions: Sequence[str] = tuple(CONDITIONS)) -> dict[str, IntArray]:
    """What the published method says of each trial of the test, by sensor condition."""
    trained = histograms(of.training.readings[:, 0])
    n, estimates, samples, _ = of.rounds.readings.shape
    asked = histograms(of.rounds.readings.reshape(n * estimates, samples, 6))
    out = {}
    for condition in conditions:
        used = columns(condition)
        said = fit(trained[:, used], of.training.classes).predict(asked[:, used])
        out[condition] = modes(said.reshape(n, estimates))
    return out


def study(
    recorded: Iterable[Session],
    answers: Callable[[Session], Mapping[str, IntArray]] = published_answers,
    *,
    told: Callable[[Session], None] | None = None,
) -> Outcome:
    """Ask a method about each session of one test.

    Parameters
    ----------
    recorded : iterable of Session
        From `sessions`; one is in memory at a time.
    answers : callable
        Gives, by condition, what it says of each trial of the test.
    told : callable, optional
        Called with each session that is done.

    Examples
    --------
    >>> small = Protocol(participants=2, training=2, rounds=1, estimates=1, samples=256)
    >>> found = study(sessions("edges4", protocol=small))
    >>> sorted(found.accuracy) == sorted(CONDITIONS), found.accuracy["GxGyGz"].shape, int(found.confusion["GxGyGz"].counts.sum())
    (True, (2,), 8)
    """
    accuracy: dict[str, list[float]] = {}
    confusion: dict[str, Confusion] = {}
    test = ""
    for each in recorded:
        if test and each.test != test:
            raise InputError(f"sessions of {test} and {each.test} cannot be judged together; give those of one test")
        test = each.test
        true = each.rounds.classes
        names = tuple(str(k) for k in range(len(TESTS[each.test]) + 1))
        for condition, said in answers(each).items():
            accuracy.setdefault(condition, []).append(float((said == true).mean()))
            found = Confusion.of([str(k) for k in true], [str(k) for k in said], names)
            confusion[condition] = confusion[condition] + found if condition in confusion else found
        if told is not None:
            told(each)
    if not test:
        raise InputError("there is no session to judge; record one participant at least")
    return Outcome(test, {name: np.array(each) for name, each in accuracy.items()}, confusion)
