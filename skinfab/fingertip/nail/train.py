"""From labelled trials to a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel, fit_phasors
from skinfab.fingertip.nail.frozen import without_frozen
from skinfab.fingertip.nail.histogram_model import HistogramModel, fit_histograms
from skinfab.fingertip.nail.labels import NOTHING, Trial
from skinfab.fingertip.nail.model_file import class_names
from skinfab.fingertip.nail.phasors import (
    BLOCK,
    FIND_SHORTEST,
    SHORTEST,
    ComplexArray,
    find_drive,
    lock_in,
    reference_of,
    turned_phasors,
    turns,
)
from skinfab.fingertip.nail.touches import touches_by_class, touches_of
from skinfab.fingertip.nail.units import CHANNELS

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Readings of a window that is decided on: four turns of the motor, 24 ms. Longer ones are hardly better (docs/nail.md).
WINDOW = 33
#: The paper's window, for the published method.
PUBLISHED_WINDOW = 1024
#: It learns so much of the shortest trial: a single frame that is lost in as long a one would leave none to be asked about.
_SPARED = 0.95
#: Channels that are saturated in more of the readings are told of.
_SATURATED = 0.01
#: Fewer trials of a class are told of: with two, accuracy is 10 % lower than with five.
_FEW = 5
#: A frequency that is given may be off by so much of a block's resolution: a tenth of the amplitude is lost then.
_OFF_BLOCK = 0.25
#: And lie below so much of the sampling rate, as where it is looked for.
_HIGHEST = 0.48


@dataclass(frozen=True, eq=False)
class Prepared:
    """Trials, ready to be learned from.

    Parameters
    ----------
    trials : tuple of n Trial
    names : tuple of str
        The classes.
    classes : (n,) int
    drive : (n, 6) complex
        Phasors of each whole trial, turned alike.
    noise : (n, 6) float
    drive_hz : (n,) float
    rate_hz : float
    notes : tuple of str
    """

    trials: tuple[Trial, ...]
    names: tuple[str, ...]
    classes: IntArray
    drive: ComplexArray
    noise: FloatArray
    drive_hz: FloatArray
    rate_hz: float
    notes: tuple[str, ...]

    def groups(self, *, across: bool) -> list[str]:
        """Of each trial, what is held out as a whole with it: its touch, or `across` participants its participant."""
        labels = [each.label for each in self.trials]
        return [each.participant for each in labels] if across else touches_of(labels)[0]

    def fit(self, rows: IntArray, *, across: bool = False) -> NailModel:
        """The model of some of the trials, as sure as it is right on other trials; with `across` on other participants."""
        groups = self.groups(across=across)
        return fit_phasors(
            self.names,
            self.classes[rows],
            self.drive[rows],
            self.noise[rows],
            rate_hz=self.rate_hz,
            drive_hz=float(np.median(self.drive_hz[rows])),
            groups=[groups[k] for k in rows.tolist()],
        )

    def fit_published(self, rows: IntArray) -> HistogramModel:
        """The published model of some of the trials, each cut to the paper's 1024 readings, or to a little less than the shortest trial.

        Raises
        ------
        InputError
            A channel stands still or has too few readings in some trial.
        """
        if not (there := np.isfinite(self.drive).all(axis=0)).all():
            raise InputError(
                f"channel {', '.join(np.array(CHANNELS)[~there])} has too few readings in some trials, or stands still, and the published "
                "method needs all six; mend it, or use --method improved"
            )
        samples = min(PUBLISHED_WINDOW, *(int(_SPARED * len(whole(each.values))) for each in self.trials))
        if samples < SHORTEST:
            raise InputError(
                f"a trial has fewer than {SHORTEST / _SPARED:.0f} readings of all six channels, which the published method needs; record "
                "it again"
            )
        windows = np.array([whole(self.trials[k].values)[:samples] for k in rows])
        return fit_histograms(self.names, self.classes[rows], windows, rate_hz=self.rate_hz)


def prepare(trials: Sequence[Trial], *, drive_hz: float | None = None) -> Prepared:
    """Phasors of trials.

    Parameters
    ----------
    trials : sequence of Trial
    drive_hz : float, optional
        The motor's frequency; found in each trial where it is left out.

    Raises
    ------
    InputError
        The sampling rates differ, a trial is too short for its motor's frequency to be found, nothing vibrates in it, or not at the
        frequency that is given.
    """
    rates = np.array([each.rate_hz for each in trials])
    rate = float(np.median(rates))
    if np.abs(rates - rate).max() > 0.01 * rate:
        raise InputError(f"the logs have {rates.min():.4g} to {rates.max():.4g} readings a second; record all of them at one rate")
    masked = [without_frozen(np.where(each.saturated, np.nan, each.values)) for each in trials]
    if drive_hz is not None:
        _require_drive(trials, masked, rate, drive_hz)
    drives = np.array([_drive(each, values, rate) if drive_hz is None else drive_hz for each, values in zip(trials, masked, strict=True)])
    first = np.array([lock_in(v[None, :BLOCK], rate, f).drive[0] for v, f in zip(masked, drives, strict=True)])
    reference = reference_of(first)
    each = [turned_phasors(v[None], rate, f, reference) for v, f in zip(masked, drives, strict=True)]
    names = class_names([trial.label.label for trial in trials])
    classes = np.array([names.index(trial.label.label) for trial in trials])
    drive, noise = np.concatenate([one for one, _ in each]), np.concatenate([one for _, one in each])
    return Prepared(tuple(trials), names, classes, drive, noise, drives, rate, tuple(_notes(trials, names, drive)))


def _drive(trial: Trial, values: FloatArray, rate: float) -> float:
    where = _where(trial)
    if len(values) < FIND_SHORTEST:
        raise InputError(f"{where}: {len(values)} readings are too few to find the motor's frequency in; give it with --drive")
    found = float(find_drive(values[None], rate)[0])
    if not np.isfinite(found):
        raise InputError(f"{where}: the motor does not turn: nothing that vibrates stands out of the noise; was it on?")
    return found


def _require_drive(trials: Sequence[Trial], masked: Sequence[FloatArray], rate: float, drive_hz: float) -> None:
    """Refuse a frequency that is given and that the readings do not have."""
    if drive_hz > _HIGHEST * rate:
        raise InputError(
            f"--drive {drive_hz:g} is above half of {rate:.4g} readings a second, where nothing can be told; give the motor's own"
        )
    found = [float(find_drive(values[None], rate)[0]) for values in masked if len(values) >= FIND_SHORTEST]
    known = [each for each in found if np.isfinite(each)]
    if known and abs(middle := float(np.median(known)) - drive_hz) > _OFF_BLOCK * rate / BLOCK:
        raise InputError(
            f"--drive {drive_hz:g} is {abs(middle):.3g} Hz off: the motor turns at {drive_hz + middle:.1f} Hz in the readings; leave it out"
        )
    for each, values in zip(trials, masked, strict=True):
        if not turns(values[None], rate, drive_hz)[0]:
            raise InputError(
                f"{_where(each)}: nothing of {drive_hz:g} Hz stands out of the noise; was the motor on, and is that its frequency?"
            )


def _where(trial: Trial) -> str:
    return f"{trial.label.log}, {trial.label.start_s:.3f} to {trial.label.end_s:.3f} s"


def _notes(trials: Sequence[Trial], names: tuple[str, ...], drive: ComplexArray) -> list[str]:
    notes = touches_of([each.label for each in trials])[1]
    there = np.isfinite(drive).all(axis=0)
    if not there.all():
        gone = ", ".join(np.array(CHANNELS)[~there])
        notes.append(f"channel {gone} has too few readings in some trials, or stands still, and the model does without")
    saturated = np.concatenate([each.saturated for each in trials]).mean(axis=0)
    for name, part in zip(CHANNELS, saturated.tolist(), strict=True):
        if part > _SATURATED:
            notes.append(
                f"channel {name} is at the end of its range in {part:.1%} of the readings, which are left out; choose a wider range"
            )
    touches = touches_by_class([each.label for each in trials])
    rarest = min(touches, key=lambda name: touches[name])
    if (few := touches[rarest]) < _FEW:
        notes.append(f"class {rarest!r} has {few} {'trial' if few == 1 else 'trials'}; five a class are better by far")
    if NOTHING not in names:
        notes.append(f"no trial is without contact (labelled {NOTHING!r}), so every window will be taken for a contact; record some")
    return notes


def whole(values: FloatArray) -> FloatArray:
    """The rows that have all channels: a histogram does not mind what lies between them."""
    return values[np.isfinite(values).all(axis=1)]
