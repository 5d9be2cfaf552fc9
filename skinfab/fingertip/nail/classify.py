"""Which class a window is of: linear discriminants on turned phasors, learned from few trials, at any window's length.

What separates trials of one class is how the finger was placed, and that does not depend on the window; noise does, by 2 / samples in
variance. So one model, learned from long windows, serves short ones: their noise is added to the scatter of placing. Few trials say
little of a scatter in twelve dimensions, so it is drawn towards its diagonal mean (Ledoit and Wolf 2004).
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.confidence import LAPSE, UNKNOWN, probabilities, temperature_of
from skinfab.fingertip.nail.labels import NOTHING
from skinfab.fingertip.nail.phasors import ComplexArray, reference_of, turned, turned_phasors
from skinfab.fingertip.nail.units import CHANNELS
from skinfab.fingertip.splits import group_folds

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Turning takes one direction out of the features, so that without any drawing their scatter could not be inverted.
LEAST_SHRINKAGE = 1e-3
#: Parts of the cross-validation that says how sure one may be: with five, models of four fifths of few trials err too much.
_FOLDS = 10
#: Scatter of trials as a part of that of classes, where no class has a second trial that would tell it.
_UNKNOWN_SCATTER = 0.25
#: A window without noise.
_LONG = 10**9
#: Squared distance, in its median among the trials learned from, beyond which a window is like nothing that was learned.
STRANGE = 10.0
#: Log-odds of no contact at the farthest trial without any: 99 in 100. At the gate they are even.
_SURE_OF_NONE = math.log(99)
#: The gate may lie within the trials without contact; then so narrow a part of it parts sure from not.
_LEAST_WIDTH = 0.05


@dataclass(frozen=True, eq=False)
class Decisions:
    """On n windows.

    Parameters
    ----------
    classes : (n,) int
        Index into the model's names.
    confidence : (n,) float
        How probable that class is, among those that were learned; without contact, how probable it is that there is none.
    probability : (n, k) float
        Of each class that is touched, in the order of `NailModel.touched`; each row adds up to 1, also without contact.
    contact : (n,) bool
    strange : (n,) bool
        Like nothing that was learned: another finger, a sensor that came off, a touch too light to be told from none.
    """

    classes: IntArray
    confidence: FloatArray
    probability: FloatArray
    contact: BoolArray
    strange: BoolArray


@dataclass(frozen=True, eq=False)
class NailModel:
    """Trials that were learned from, and what follows from them.

    Parameters
    ----------
    names : tuple of str
        Of the classes; `NOTHING` may be among them.
    classes : (n,) int
        Of each trial.
    drive : (n, 6) complex
        Its phasors, as measured.
    noise : (6,) float
        Root mean square of one reading's noise.
    rate_hz, drive_hz : float
        Readings a second, and the motor's frequency, in the middle.
    shrinkage : float
        How far the scatter is drawn towards its mean, 0 to 1.
    temperature : float
        Squared distances are divided by it.
    channels : (6,) bool
        Which are used.
    """

    names: tuple[str, ...]
    classes: IntArray
    drive: ComplexArray
    noise: FloatArray
    rate_hz: float
    drive_hz: float
    shrinkage: float = 0.1
    temperature: float = 1.0
    channels: BoolArray = field(default_factory=lambda: np.ones(6, dtype=bool))

    @cached_property
    def touched(self) -> IntArray:
        """The classes that are not `NOTHING` and were learned from."""
        return np.array([k for k, name in enumerate(self.names) if name != NOTHING and (self.classes == k).any()], dtype=np.int64)

    @cached_property
    def reference(self) -> ComplexArray:
        """What phasors are turned to, (6,)."""
        return np.where(self.channels, reference_of(self.drive), 0.0)

    @cached_property
    def size(self) -> FloatArray:
        """Root mean square of each used channel's phasors, (c,)."""
        return np.asarray(np.sqrt((np.abs(self.drive[:, self.channels]) ** 2).mean(axis=0)))

    def features(self, drive: ComplexArray) -> FloatArray:
        """Real and imaginary parts of phasors, each channel by its own size; (n, 6) complex to (n, 2 c)."""
        scaled = turned(drive, self.reference)[:, self.channels] / self.size
        return np.concatenate([scaled.real, scaled.imag], axis=1)

    @cached_property
    def learned(self) -> FloatArray:
        """Features of the trials that were learned from."""
        return self.features(self.drive)

    @cached_property
    def means(self) -> FloatArray:
        """Of the classes that are touched, (k, 2 c)."""
        return np.array([self.learned[self.classes == k].mean(axis=0) for k in self.touched])

    @cached_property
    def scatter(self) -> FloatArray:
        """Covariance of trials about their class, (2 c, 2 c)."""
        rest, spare = _residuals(self)
        d = rest.shape[1]
        if spare == 0:
            return np.eye(d) * max(_UNKNOWN_SCATTER * float(self.means.var(axis=0).mean()), 1e-12)
        plain = rest.T @ rest / spare
        return (1 - self.shrinkage) * plain + self.shrinkage * np.trace(plain) / d * np.eye(d)

    def whitener(self, samples: int) -> FloatArray:
        """L with L^T L the inverse of scatter and noise of a window together, (2 c, 2 c)."""
        noise = np.tile(self.noise[self.channels] / self.size, 2)
        out: FloatArray = np.linalg.inv(np.linalg.cholesky(self.scatter + np.diag(2 * noise**2 / samples)))
        return out

    @cached_property
    def at_rest(self) -> FloatArray | None:
        """Mean features without contact; None where nobody recorded any."""
        if NOTHING not in self.names or not (rest := self.classes == self.names.index(NOTHING)).any():
            return None
        return np.asarray(self.learned[rest].mean(axis=0))

    @cached_property
    def gate(self) -> float:
        """Distance from `at_rest` that is contact: midway between the farthest trial without and the nearest with it."""
        without, touching = self._from_rest
        return -math.inf if self.at_rest is None else float(without.max() + touching.min()) / 2

    @cached_property
    def gate_is_safe(self) -> bool:
        """Was every trial with contact farther from rest than every one without?"""
        without, touching = self._from_rest
        return self.at_rest is not None and bool(without.max() < touching.min())

    def none_at(self, away: float, samples: int) -> tuple[float, bool]:
        """How sure it is that a window so far from `at_rest` has no contact, and whether it is like neither.

        The odds fall from 99 to 1 at the farthest trial without contact to even ones at the gate; like neither is what lies beyond the
        middle of the two: there are touches lighter than any that were learned (simulated, 20 to 300 mN where 0.8 N and more were).
        """
        without, _ = self._from_rest
        noise = 4 * float(((self.noise[self.channels] / self.size) ** 2).sum()) / samples
        clean, farthest = math.sqrt(max(away**2 - noise, 0.0)), float(without.max())
        width = max(self.gate - farthest, _LEAST_WIDTH * self.gate, 1e-300)
        sure = 1 / (1 + math.exp(min((clean - self.gate) * _SURE_OF_NONE / width, 50.0)))
        return (1 - LAPSE) * sure + LAPSE / 2, clean > self.gate - width / 2

    @cached_property
    def _from_rest(self) -> tuple[FloatArray, FloatArray]:
        """How far the trials without and with contact lie from `at_rest`."""
        if self.at_rest is None:
            return np.empty(0), np.empty(0)
        away = np.linalg.norm(self.learned - self.at_rest, axis=1)
        without = self.classes == self.names.index(NOTHING)
        return away[without], away[~without]

    @cached_property
    def usual(self) -> float:
        """Median squared distance of trials from their class."""
        rest, _ = _residuals(self)
        d = ((rest @ np.linalg.inv(np.linalg.cholesky(self.scatter)).T) ** 2).sum(axis=1)
        return max(float(np.median(d)), float(rest.shape[1]) / 2)

    def decide_phasors(self, drive: ComplexArray, samples: int) -> Decisions:
        """Decide on phasors (n, 6) of windows of so many readings."""
        return self._decide(self.features(drive), samples)

    def _apart(self, x: FloatArray, L: FloatArray) -> FloatArray:
        """Squared distances of features (n, 2 c) from the classes that are touched, (n, k)."""
        out: FloatArray = (((x @ L.T)[:, None] - self.means @ L.T) ** 2).sum(axis=2)
        return out

    def _decide(self, x: FloatArray, samples: int) -> Decisions:
        squared = self._apart(x, self.whitener(samples))
        nearest, probability = squared.min(axis=1), probabilities(squared, self.temperature)
        best = squared.argmin(axis=1)
        classes, confidence = self.touched[best], probability[np.arange(len(x)), best]
        contact, strange = np.ones(len(x), dtype=bool), nearest > STRANGE * self.usual
        if self.at_rest is not None:
            away = np.linalg.norm(x - self.at_rest, axis=1)
            contact = away > self.gate
            classes = np.where(contact, classes, self.names.index(NOTHING))
            for k in np.flatnonzero(~contact):
                confidence[k], strange[k] = self.none_at(float(away[k]), samples)
        return Decisions(classes, confidence, probability, contact, strange)

    def decide(self, values: FloatArray, *, drive_hz: float | FloatArray | None = None) -> Decisions:
        """Decide on windows (n, samples, 6).

        Parameters
        ----------
        values : (n, samples, 6) float
            NaN where a reading is missing or saturated. A window in which a channel has too few readings cannot be decided by this
            model; `without` gives one that can.
        drive_hz : float or (n,) float, optional
            The motor's frequency meanwhile; the one of the trials where it is left out.

        Raises
        ------
        InputError
            A window is too short, or a channel has too few readings.
        """
        drive, _ = turned_phasors(values, self.rate_hz, self.drive_hz if drive_hz is None else drive_hz, self.reference)
        gone: BoolArray = ~np.asarray(np.isfinite(drive[:, self.channels]).all(axis=0))
        if gone.any():
            names = np.array(CHANNELS)[np.flatnonzero(self.channels)[gone]].tolist()
            raise InputError(f"channel {', '.join(names)} has too few readings in a window; leave it out of the model, or mend its wire")
        return self.decide_phasors(drive, values.shape[1])

    def without(self, missing: BoolArray) -> NailModel:
        """The model that was learned from the other channels alone.

        Raises
        ------
        InputError
            Fewer than two are left: one phasor alone, its phase unknown, is an amplitude.
        """
        left = self.channels & ~missing
        if left.sum() < 2:
            raise InputError(
                f"{int(left.sum())} of the six channels are left, and two are needed to tell anything; look at the sensor's wires"
            )
        return replace(self, channels=left)


def fit_phasors(
    names: Sequence[str],
    classes: IntArray,
    drive: ComplexArray,
    noise: FloatArray,
    *,
    rate_hz: float,
    drive_hz: float,
    groups: Sequence[Hashable] | None = None,
    seed: int = 0,
) -> NailModel:
    """Learn from trials.

    Parameters
    ----------
    names : sequence of str
        Of the classes.
    classes : (n,) int
        Of each trial.
    drive : (n, 6) complex
        Its phasors (`skinfab.fingertip.nail.phasors.turned_phasors` or `lock_in`); NaN throughout a channel that is missing.
    noise : (n, 6) float
        Of a reading.
    rate_hz, drive_hz : float
    groups : sequence of n, optional
        Trials that are not independent of each other, such as those of one participant where the model is for another; each is one of
        its own where they are left out.
    seed : int
        Of the cross-validation that says how sure the model may be.

    Raises
    ------
    InputError
        Fewer than two classes are touched, or fewer than two channels have readings in all trials.
    """
    from sklearn.covariance import ledoit_wolf_shrinkage

    there: BoolArray = np.asarray(np.isfinite(drive).all(axis=0))
    if there.sum() < 2:
        raise InputError(
            f"{int(there.sum())} of the six channels have readings in all trials, and two are needed; look at the sensor's wires"
        )
    known = np.where(there, drive, 0.0)
    plain = NailModel(
        tuple(names), np.asarray(classes, dtype=np.int64), known, np.where(there, np.sqrt(np.mean(noise**2, axis=0)), 0.0),
        float(rate_hz), float(drive_hz), channels=there,
    )  # fmt: skip
    if len(plain.touched) < 2:
        raise InputError(f"{len(plain.touched)} class of contact is among the trials, and at least two are needed; record another one")
    rest, spare = _residuals(plain)
    if spare == 0:  # how trials scatter is not known, nor then how sure one may be
        return replace(plain, temperature=UNKNOWN)
    made = replace(plain, shrinkage=max(float(ledoit_wolf_shrinkage(rest, assume_centered=True)), LEAST_SHRINKAGE))
    return replace(made, temperature=_temperature(made, groups, seed))


def _residuals(model: NailModel) -> tuple[FloatArray, int]:
    """Trials less the mean of their class, of classes that are touched, and how many of them are free."""
    rows = np.isin(model.classes, model.touched)
    place = np.searchsorted(model.touched, model.classes[rows])
    return model.learned[rows] - model.means[place], int(rows.sum()) - len(model.touched)


def _temperature(model: NailModel, groups: Sequence[Hashable] | None, seed: int) -> float:
    """What trials ask for whose whole group was held out."""
    rows = np.flatnonzero(np.isin(model.classes, model.touched))
    of = rows.tolist() if groups is None else [groups[k] for k in rows.tolist()]
    folds = min(_FOLDS, len(set(of)))
    apart, columns = [], []
    for kept, held in group_folds(of, k=folds, strata=model.classes[rows].tolist(), seed=seed) if folds > 1 else []:
        part = replace(model, classes=model.classes[rows[kept]], drive=model.drive[rows[kept]])
        if len(part.touched) < len(model.touched):  # a class of one trial: nothing is known of it without
            continue
        # Means of fewer trials are worse by as much as this, and the model in the file has all of them.
        fewer, every = (np.bincount(of.classes)[model.touched] for of in (part, model))
        apart.append(part._apart(part.features(model.drive[rows[held]]), part.whitener(_LONG)) * (1 + 1 / every) / (1 + 1 / fewer))
        columns.append(np.searchsorted(part.touched, model.classes[rows[held]]))
    return temperature_of(np.concatenate(apart), np.concatenate(columns)) if apart else UNKNOWN
