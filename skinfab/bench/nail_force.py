"""How well the force is told that a finger presses with, and what forces of all sizes cost the classes.

Forces are drawn log-uniform between `FORCES_N`, in training and test alike, and are known in training as a scale would tell them. The
paper's participants press with 80 to 120 g, from which no force can be learned.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.confusion import grouped_accuracy
from skinfab.fingertip.nail.improved import asked, frequency, label_of, learn
from skinfab.fingertip.nail.phasors import turned_phasors
from skinfab.fingertip.nail.protocol import Protocol, Session, sessions
from skinfab.fingertip.nail.regress import Regression, targets_of
from skinfab.fingertip.nail.simulator import RATE_HZ, Scene
from skinfab.fingertip.nail.train import WINDOW
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]

FORCES_N = (0.3, 3.0)


@dataclass(frozen=True)
class Row:
    """The improved method on one test, from the first readings of each trial.

    Parameters
    ----------
    test : str
    trials, samples : int
        Of all participants, and readings of a window.
    low_n, high_n : float
        Between which the forces are drawn.
    force_off_percent, constant_off_percent : float
        Mean of |said / true - 1|, and the same of who always says the training's geometric mean.
    percent, low, high : float
        Classes that are right at such forces, and the 95 % interval (participants drawn anew).
    simulated : bool
    """

    test: str
    trials: int
    samples: int
    low_n: float
    high_n: float
    force_off_percent: float
    constant_off_percent: float
    percent: float
    low: float
    high: float
    simulated: bool = True


def measure(protocol: Protocol, tests: Sequence[str], *, seed: int = 0, progress: Progress = silent) -> list[Row]:
    """A row a test; one estimate a trial.

    Examples
    --------
    >>> row, = measure(Protocol(participants=2, training=3, rounds=2, samples=64), ("edges4",))
    >>> row.trials, 0 < row.force_off_percent < row.constant_off_percent
    (16, True)
    """
    rows = []
    for j, test in enumerate(tests):
        right: list[NDArray[np.bool_]] = []
        off: list[FloatArray] = []
        for k, each in enumerate(sessions(test, protocol=replace(protocol, estimates=1), scene=Scene(force_n=FORCES_N), seed=seed)):
            progress((j + k / protocol.participants) / len(tests), f"{test}: forces, participant {k + 1}")
            one, errors = _asked(each)
            right.append(one)
            off.append(errors)
        mean = 100 * np.concatenate(off).mean(axis=0)
        of = np.repeat(np.arange(len(right)), [len(each) for each in right]).tolist()
        rate = grouped_accuracy(np.concatenate(right), of)
        samples = min(WINDOW, protocol.samples)
        rows.append(
            Row(test, len(of), samples, *FORCES_N, float(mean[0]), float(mean[1]), 100 * rate.value, 100 * rate.low, 100 * rate.high)
        )
    return rows


def _asked(each: Session) -> tuple[NDArray[np.bool_], FloatArray]:
    """Which trials are right, and by what part the force is off that is said, and that a constant says, (n, 2)."""
    model, windows = learn(each), asked(each, WINDOW)
    aimed = targets_of([label_of(touch) for touch in each.training.touches])
    drive, _ = turned_phasors(windows, RATE_HZ, frequency(windows, model), model.reference)
    said = Regression(model, aimed).estimate(model.features(drive))[:, -1]
    constant = np.nanmean(aimed[:, -1])
    true = np.log([touch.force_n for touch in each.rounds.touches])
    right: NDArray[np.bool_] = model.decide_phasors(drive, windows.shape[1]).classes == each.rounds.classes
    return right, np.abs(np.exp(np.column_stack([said, np.full_like(said, constant)]) - true[:, None]) - 1)


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Errors of the force and the classes at such forces: every number in it comes from the table."""
    forces = ", ".join(f"{row['force_off_percent']:.0f} % of {row['test']} (a constant {row['constant_off_percent']:.0f})" for row in table)
    classes = ", ".join(f"{row['percent']:.1f} % of {row['test']}" for row in table)
    first = table[0]
    return (
        f"Forces from {first['low_n']:g} to {first['high_n']:g} N, simulated, {first['samples']} readings: the force is off by {forces}, "
        f"and at such forces the improved method is right in {classes}."
    )
