"""Fit a strain sensor to joint angles: how many degrees the curve needs, which model the log needs, and how well it will do.

Degree and model are chosen by cross-validation within the first half of the log, which all are fitted to; the errors reported
are those on the second half, which takes part in neither. Where trials are marked, halves and folds are of whole trials, and the
simplest is taken whose error is within one standard error of the least. Where they are not, folds are stretches of time: each
sees other angles, so that their scatter says little of the models', and the lowest degree within 2 % of the least is taken, and the
simplest model within 5 %. What is handed out is fitted to the whole log.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from calibration.strain.curve import Curve, fit_curve
from calibration.strain.models import MODELS, BranchModel, Model, Samples
from calibration.strain.prepare import Fold, Prepared
from skinfab.errors import InputError, RefusedError

FloatArray = NDArray[np.float64]
Name = TypeVar("Name", str, int)

#: The highest degree that is tried: the paper needed 3 and 4.
MAX_DEGREE = 6
#: Without marked trials a lower degree counts as equal up to this times the least cross-validated error.
WITHIN = 1.02
#: A model whose error is above this part of a simpler one's did not do better to speak of.
SAME = 0.95
#: A sensor that explains less than this part of the angles' variance on the half held out is useless: its error is then more
#: than 0.71 of that of the answer that never changes. The models taken for real knees are at 0.76 to 0.98, clocks that are
#: 6 s apart at 0.16.
MIN_EXPLAINED = 0.5
#: So many samples are timed, one by one.
_TIMED = 500


@dataclass(frozen=True)
class Score:
    """How a model does on samples it has not seen.

    Parameters
    ----------
    held_out_rms_deg : float
        Of the angle, on the second half of the log.
    outside : float
        Part of those samples whose reading lay outside what the model knew.
    us_per_sample : float
        One step of its tracker, in us.
    degree : int
        Of its curve.
    """

    held_out_rms_deg: float
    outside: float
    us_per_sample: float
    degree: int


@dataclass(frozen=True, eq=False)
class Calibration:
    """A fitted sensor, and how good the fit is.

    Parameters
    ----------
    model : Model
        Fitted to the whole log.
    plain : Curve
        The characteristic curve by least squares alone; it may turn.
    tried : dict of dict of float
        Cross-validated error (deg) by model and degree.
    n : int
        Samples that were fitted.
    sse, r2 : float
        Of the plain curve, in dU/U0.
    rms_deg : float
        Residual of the model's angles on the whole log.
    scores : dict of Score
        By the model's name.
    sensitivity_per_deg : (min, mean, max)
        Of the plain curve over its monotone range, 1/deg.
    monotone_range_deg : (low, high)
    band : (k, 3) float
        Angle (deg), and the ends of the plain curve's 95 % confidence band, dU/U0.
    notes : tuple of str
    """

    model: Model
    plain: Curve
    tried: Mapping[str, Mapping[int, float]]
    n: int
    sse: float
    r2: float
    rms_deg: float
    scores: Mapping[str, Score]
    sensitivity_per_deg: tuple[float, float, float]
    monotone_range_deg: tuple[float, float]
    band: FloatArray
    notes: tuple[str, ...]


def calibrate(log: Prepared, *, model: str = "auto", degree: int | None = None) -> Calibration:
    """Choose, fit and judge.

    Parameters
    ----------
    log : Prepared
    model : str
        ``auto`` or a name of `calibration.strain.models.MODELS`.
    degree : int, optional
        Of the curve; chosen by cross-validation where it is not given.

    Raises
    ------
    InputError
        The log is too short, or goes one way only.
    """
    first, second = log.halves
    if not first or not second:
        raise InputError("one half of the log has no sample in the range of angles, so that nothing could be held out; record a longer log")
    notes: list[str] = list(log.notes)
    degrees = range(1, MAX_DEGREE + 1) if degree is None else (degree,)
    folds = _folds(log, degrees[0])
    tried: dict[str, dict[int, Trial]] = {}
    for name in MODELS:
        found, said = _trials(folds, name, degrees)
        if found:
            tried[name] = found
        elif name == model:
            raise InputError(said)
        else:
            notes.append(f"model {name} was left out: in the first half of the log, by which models are chosen, {said}")
    if not tried:
        raise InputError("no model can be fitted to the first half of the log: " + notes[-1])
    wanted = {name: _within_an_error(each) if log.by_trial else _within_a_part(each, WITHIN) for name, each in tried.items()}
    if model == "auto":
        rest = {name: tried[name][wanted[name]] for name in tried}
        model = _within_an_error(rest) if log.by_trial else _within_a_part(rest, 1 / SAME)
    degree = wanted[model]
    fitted = MODELS[model].fit(log.runs, degree=degree)
    scores = {name: _score(MODELS[name].fit(log.only(first), degree=wanted[name]), log.only(second), wanted[name]) for name in tried}
    best = min(scores, key=lambda name: scores[name].held_out_rms_deg)
    if scores[best].held_out_rms_deg < SAME * scores[model].held_out_rms_deg:
        notes.append(
            f"on the half held out {best} did better than {model}: {scores[best].held_out_rms_deg:.2f} against "
            f"{scores[model].held_out_rms_deg:.2f} degrees; a longer log would tell whether that is chance"
        )
    if degree == MAX_DEGREE and len(degrees) > 1:
        notes.append(f"the highest degree that is tried, {degree}, was chosen: the curve may need more, or the log is too short to tell")
    angle = np.concatenate([run.angle[run.fit] for run in log.runs])
    signal = np.concatenate([run.signal[run.fit] for run in log.runs])
    plain = fit_curve(angle, signal, degree=degree)
    residual = signal - plain.signal(angle)
    sse = float(residual @ residual)
    if not plain.monotone:
        low, high = plain.monotone_range
        notes.append(
            f"the curve of degree {degree} turns outside {low:.1f} to {high:.1f} degrees, where a reading has two angles; "
            "the best curve that does not turn is used for the way back"
        )
    low, high = plain.monotone_range
    slopes = np.abs(plain.slope(np.linspace(low, high, 1001)))
    return Calibration(
        model=fitted,
        plain=plain,
        tried={name: {k: float(np.sqrt(trial.mean)) for k, trial in each.items()} for name, each in tried.items()},
        n=len(angle),
        sse=sse,
        r2=1 - sse / float(np.sum((signal - signal.mean()) ** 2)),
        rms_deg=_rms(angle_errors(fitted, log.runs)),
        scores=scores,
        sensitivity_per_deg=(float(slopes.min()), float(slopes.mean()), float(slopes.max())),
        monotone_range_deg=(low, high),
        band=_band(log, degree, plain),
        notes=tuple(notes),
    )


def require_useful(log: Prepared, found: Calibration) -> None:
    """Refuse a calibration that is useless by its own figures.

    Raises
    ------
    RefusedError
        On the half held out it explains less than `MIN_EXPLAINED` of the variance that the log's angles have.
    """
    score = found.scores[found.model.name].held_out_rms_deg
    # Of the whole log: in its second half the joint may have rested.
    spread = float(np.std(np.concatenate([run.angle[run.fit] for run in log.runs])))
    if score**2 <= (1 - MIN_EXPLAINED) * spread**2:
        return
    best = min(found.scores, key=lambda name: found.scores[name].held_out_rms_deg)
    better = found.scores[best].held_out_rms_deg
    raise RefusedError(
        f"the calibration is useless: on the half held out {found.model.name} is {score:.1f} degrees wrong, where the answer that never "
        f"changes is {spread:.1f} wrong; "
        + (
            f"take --model {best}, which is {better:.1f} wrong"
            if better**2 <= (1 - MIN_EXPLAINED) * spread**2
            else "is it this joint's sensor, were both recorded at once (skinfab angle --shift auto), and did its wires hold?"
        )
    )


def rms_on(log: Prepared, found: Calibration, other: Prepared) -> dict[str, float]:
    """Error (deg) on another log of every model of a calibration, fitted to the whole of `log`."""
    fitted = {name: MODELS[name].fit(log.runs, degree=score.degree) for name, score in found.scores.items()}
    return {name: _rms(angle_errors(model, other.runs)) for name, model in fitted.items()}


@dataclass(frozen=True, eq=False)
class Trial:
    """Mean squared errors (deg^2) of a model on groups of samples that took no part in its fit, and the groups' sizes."""

    squares: FloatArray
    sizes: FloatArray

    @property
    def mean(self) -> float:
        """Over all samples."""
        return float(np.average(self.squares, weights=self.sizes))


def _folds(log: Prepared, degree: int) -> list[Fold]:
    """Folds that all models can be fitted to, so that all are compared on the same samples.

    A stretch of time may hold the only way back there is within the range of angles; equal parts of the samples that count part it.
    Where that does not help (trials are not parted), what cannot be fitted is left out, as long as two folds remain.
    """
    choices = [log.folds] if log.marked else [log.folds, log.even_folds]
    for folds in choices:
        if all(_both_ways(fitted, degree) for fitted, _ in folds):
            return folds
    some = [(fitted, held_out) for fitted, held_out in log.folds if _both_ways(fitted, degree)]
    return some if len(some) > 1 else log.folds


def _both_ways(runs: Sequence[Samples], degree: int) -> bool:
    try:
        BranchModel.fit(runs, degree=degree)
    except InputError:
        return False
    return True


def _trials(folds: Sequence[Fold], name: str, degrees: Sequence[int]) -> tuple[dict[int, Trial], str]:
    """A model judged at each degree that can be fitted to all folds, and why not where none can."""
    tried: dict[int, Trial] = {}
    said = ""
    for degree in degrees:
        try:
            tried[degree] = _trial(folds, name, degree)
        except InputError as fault:
            said = said or str(fault)
    return tried, said


def _trial(folds: Sequence[Fold], name: str, degree: int) -> Trial:
    """Fit to each fold and judge on what it leaves out."""
    squares, sizes = [], []
    for fitted, held_out in folds:
        errors = angle_errors(MODELS[name].fit(fitted, degree=degree), held_out)
        if len(errors):
            squares.append(float(np.mean(errors**2)))
            sizes.append(len(errors))
    return Trial(np.array(squares), np.array(sizes, dtype=float))


def _within_an_error(tried: Mapping[Name, Trial]) -> Name:
    """The first of what is tried (the simplest comes first) whose error is within one standard error of the least.

    Groups differ from each other more than models do, so the difference is judged group by group.
    """
    best = min(tried.values(), key=lambda trial: trial.mean)
    for name, trial in tried.items():
        more = (trial.squares - best.squares) * trial.sizes / trial.sizes.mean()
        if trial.mean - best.mean <= np.std(more, ddof=1) / np.sqrt(len(more)):
            return name
    raise AssertionError("the best is within any error of itself")


def _within_a_part(tried: Mapping[Name, Trial], times: float) -> Name:
    """The first of what is tried whose error is at most so many times the least."""
    least = min(trial.mean for trial in tried.values())
    return next(name for name, trial in tried.items() if trial.mean <= times**2 * least)


def _score(model: Model, held_out: Sequence[Samples], degree: int) -> Score:
    outside = np.concatenate([model.estimate(run.time, run.signal)[1][run.fit] for run in held_out])
    return Score(_rms(angle_errors(model, held_out)), float(outside.mean()), step_us(model, held_out[0]), degree)


def step_us(model: Model, run: Samples) -> float:
    """The median of single steps, us."""
    tracker, clock = model.tracker(), time.perf_counter
    taken = []
    for t, u in zip(run.time[:_TIMED].tolist(), run.signal[:_TIMED].tolist(), strict=True):
        began = clock()
        tracker.step(t, u)
        taken.append(clock() - began)
    return float(np.median(taken)) * 1e6


def angle_errors(model: Model, runs: Sequence[Samples]) -> FloatArray:
    """Estimated less true angle of the samples that count, deg."""
    return np.concatenate([(model.estimate(run.time, run.signal)[0] - run.angle)[run.fit] for run in runs])


def _rms(errors: FloatArray) -> float:
    return float(np.sqrt(np.mean(errors**2)))


def _band(log: Prepared, degree: int, plain: Curve) -> FloatArray:
    """The 95 % confidence band of the plain curve, by leaving out a group at a time: neighbouring samples are not independent."""
    from scipy.stats import t

    at = np.linspace(plain.low, plain.high, 71)
    curves = []
    for left_out in log.labels:
        runs = log.only([k for k in log.labels if k != left_out])
        angle = np.concatenate([run.angle[run.fit] for run in runs])
        signal = np.concatenate([run.signal[run.fit] for run in runs])
        if len(angle) > degree + 1 and np.ptp(angle) > 0:
            curves.append(fit_curve(angle, signal, degree=degree).signal(at))
    k = len(curves)
    middle = plain.signal(at)
    if k < 2:
        return np.column_stack([at, np.full_like(at, -np.inf), np.full_like(at, np.inf)])
    spread = np.sqrt((k - 1) / k * np.sum((np.array(curves) - np.mean(curves, axis=0)) ** 2, axis=0))
    half = t.ppf(0.975, k - 1) * spread
    return np.column_stack([at, middle - half, middle + half])
