"""What each term of the nail's simulator is for: accuracies without it, on the same participants and touches.

Beside the two methods there are two columns that some terms are for: acceleration whose mean is left on, for gravity, and few readings,
for noise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.nail.improved import improved_answers
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome, Protocol, Session, published_answers, sessions, study
from skinfab.fingertip.nail.published import BINS, fit, histograms
from skinfab.fingertip.nail.simulator import Scene
from skinfab.progress import Progress, silent

IntArray = NDArray[np.int64]

NOTHING = "nothing"
#: What a term is called, and the scene without it. The ends of the ranges are no term: nothing reaches them (see docs/nail.md).
TERMS: Mapping[str, Mapping[str, Any]] = {
    NOTHING: {},
    "scatter of the place": {"place_mm": 0.0},
    "scatter of the turn": {"turn_rad": 0.0},
    "scatter of the force": {"force_scatter": 0.0},
    "scatter of participants": {"person_scatter": 0.0},
    "damping of the contact": {"contact_delay_s": 0.0},
    "gravity": {"gravity_g": 0.0},
    "noise of acceleration": {"noise_g": 0.0},
    "noise of angular velocity": {"noise_dps": 0.0},
}
#: Readings of the short windows: the shortest that the improved method takes, and less than a turn of the motor.
FEW = 8
MEAN_LEFT_ON, FEW_READINGS = "AxAyAz, mean left on", f"improved, {FEW} readings"
#: A change counts from so many standard errors on: there are some 150 of them.
_COUNTS = 3.0


@dataclass(frozen=True)
class Left:
    """Accuracy where one term is left out.

    Parameters
    ----------
    term : str
        What is left out.
    test, method : str
        The published one is called by its sensor condition.
    percent, deviation : float
        Mean and standard deviation of the participants' accuracies.
    change : float
        By how much the mean is more than with all terms.
    error : float
        Standard error of the change; participants are compared with themselves.
    counts : bool
        The change is more than three times its error.
    simulated : bool
    """

    term: str
    test: str
    method: str
    percent: float
    deviation: float
    change: float
    error: float
    counts: bool
    simulated: bool = True


def ablate(protocol: Protocol, *, scene: Scene | None = None, seed: int = 0, progress: Progress = silent) -> list[Left]:
    """A row for every term, test and method; one estimate a trial."""
    scene = scene or Scene()
    short = replace(protocol, estimates=1)
    rows: list[Left] = []
    whole: dict[str, Outcome] = {}
    for k, (term, without) in enumerate(TERMS.items()):
        progress(k / len(TERMS), f"without {term}")
        for test in TESTS:
            found = study(sessions(test, protocol=short, scene=replace(scene, **without), seed=seed), _answers)
            of = whole.setdefault(test, found)
            for method, accuracy in found.accuracy.items():
                change = 100 * (accuracy - of.accuracy[method])
                mean, error = float(change.mean()), float(change.std(ddof=1) / math.sqrt(len(change)))
                percent, deviation = 100 * found.mean(method), 100 * found.deviation(method)
                rows.append(Left(term, test, method, percent, deviation, mean, error, abs(mean) > _COUNTS * error))
    return rows


def _answers(of: Session) -> dict[str, IntArray]:
    return {
        **published_answers(of, ("AxAyAzGxGyGz", "AxAyAz", "GxGyGz")),
        MEAN_LEFT_ON: _mean_left_on(of),
        **improved_answers(of),
        FEW_READINGS: improved_answers(of, FEW)["improved"],
    }


def _mean_left_on(of: Session) -> IntArray:
    """The published method on acceleration, but for the mean: `histograms` leaves it on in the last three channels."""
    trained, seen = (histograms(trials.readings[:, 0][..., [3, 4, 5, 0, 1, 2]])[:, 3 * BINS :] for trials in (of.training, of.rounds))
    said: IntArray = fit(trained, of.training.classes).predict(seen)
    return said
