"""How good models are on trials that they have not seen.

Trials of one participant are a group each: a participant's own model is judged on trials that were held out (the ``test`` part of the
table where it has one, else five folds). Where participants are put together, whole participants are held out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.confusion import Confusion
from skinfab.fingertip.nail.frozen import without_frozen
from skinfab.fingertip.nail.histogram_model import HistogramModel
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.phasors import turned_phasors
from skinfab.fingertip.nail.published import modes
from skinfab.fingertip.nail.regress import Regression, learnable, off_by, targets_of
from skinfab.fingertip.nail.touches import touches_by_class, touches_of
from skinfab.fingertip.nail.train import WINDOW, Prepared, whole
from skinfab.fingertip.splits import Split, group_folds, leave_one_out

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FOLDS = 5


@dataclass(frozen=True, eq=False)
class Held:
    """How good models are on trials that were held out.

    Parameters
    ----------
    confusion : Confusion
    groups : tuple of n
        Which cases are not independent of each other.
    right : (n,) bool
    angle_deg, place_mm, force_part : (n,) float
        Errors of the regression against the labels, the force's as a part of it; NaN where there is none.
    confidence : (n,) float
        NaN without contact, and of the published method, which knows none.
    """

    confusion: Confusion
    groups: tuple[str, ...]
    right: NDArray[np.bool_]
    angle_deg: FloatArray
    place_mm: FloatArray
    force_part: FloatArray
    confidence: FloatArray


def splits_of(trials: Sequence[Trial], *, across: bool) -> list[Split]:
    """What is learned from and what is judged.

    Parameters
    ----------
    trials : sequence of Trial
    across : bool
        Hold out whole participants.

    Raises
    ------
    InputError
        There is too little to hold anything out.
    """
    if across:
        return leave_one_out([each.label.participant for each in trials])
    test = np.array([each.label.part == "test" for each in trials])
    if test.any() and not test.all():
        return [(np.flatnonzero(~test), np.flatnonzero(test))]
    labels = [each.label for each in trials]
    touches = touches_by_class(labels)
    rarest = min(touches, key=lambda name: touches[name])
    if touches[rarest] < 2:
        raise InputError(
            f"class {rarest!r} has a single trial, so that none can be held out to say how good the model is; record another one"
        )
    return group_folds(touches_of(labels)[0], k=min(FOLDS, touches[rarest]), strata=[each.label for each in labels])


def judge(made: Prepared, splits: Sequence[Split], *, samples: int | None = WINDOW, published: bool = False, across: bool = False) -> Held:
    """Decide on what was held out.

    Parameters
    ----------
    made : Prepared
    splits : sequence of (train, test)
    samples : int, optional
        Readings of the window, from the trial's first; all of it where it is left out. Of the published method, which knows one length,
        the whole trial in windows, and the mode of what is said of them.
    published : bool
        By the published method.
    across : bool
        Cases of one participant are not independent.
    """
    truth, said, groups = [], [], []
    errors = []
    names = made.groups(across=across)
    for train, test in splits:
        if published:
            model = made.fit_published(train)
            decided = [by_histograms(model, made.trials[k].values) for k in test]
            estimates = np.full((len(test), 4), np.nan)
        else:
            decided, estimates = _by_phasors(made, train, test, samples, across)
        truth += [made.names[made.classes[k]] for k in test]
        said += [made.names[k] for k in decided]
        groups += [names[k] for k in test]
        errors.append(estimates)
    both = np.concatenate(errors)
    right = np.array([a == b for a, b in zip(truth, said, strict=True)])
    return Held(Confusion.of(truth, said, made.names), tuple(groups), right, *both.T)


def by_histograms(model: HistogramModel, values: FloatArray) -> int:
    """What most of a trial's windows say, of readings (n, 6) that have one: from the first on, gaps closed up."""
    values = whole(values)
    count = len(values) // model.samples
    return int(modes(model.decide(values[: count * model.samples].reshape(count, model.samples, 6))[None])[0])


def _by_phasors(made: Prepared, train: IntArray, test: IntArray, samples: int | None, across: bool) -> tuple[list[int], FloatArray]:
    model = made.fit(train, across=across)
    labels = [made.trials[k].label for k in train]
    regression = Regression(model, learnable(targets_of(labels))[0])
    decided, errors = [], np.full((len(test), 4), np.nan)
    for row, k in enumerate(test):
        trial = made.trials[k]
        window = without_frozen(np.where(trial.saturated, np.nan, trial.values)[:samples])
        drive, _ = turned_phasors(window[None], made.rate_hz, made.drive_hz[k], model.reference)
        usable = model
        if (gone := ~np.isfinite(drive[0]) & model.channels).any():
            usable = model.without(gone)
            drive, _ = turned_phasors(window[None], made.rate_hz, made.drive_hz[k], usable.reference)
        own = regression if usable is model else Regression(usable, regression.targets)
        decision = usable.decide_phasors(drive, len(window))
        decided.append(int(decision.classes[0]))
        target = targets_of([trial.label])[0]
        found = own.estimate(usable.features(drive))[0]
        errors[row] = *off_by(found, target), decision.confidence[0] if decision.contact[0] else np.nan
    return decided, errors
