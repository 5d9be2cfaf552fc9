"""From a log to samples fit for a fit: filtered, parted where there are gaps, as relative change, and which ones count."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from calibration.strain.models import Samples
from calibration.strain.rows import in_order, spikes
from skinfab.errors import InputError
from skinfab.readout.bridge import STILL_S, at_rest, relative
from skinfab.readout.filters import Lowpass
from skinfab.readout.table import Table

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
#: What is fitted, and what is held out.
Fold = tuple[tuple[Samples, ...], tuple[Samples, ...]]

#: The cut-off of the paper's filter, Hz.
CUTOFF_HZ = 5.0
#: A hole in the log is bridged by a straight line up to this, s; at 5 Hz nothing is lost that the filter would have kept.
MAX_GAP_S = 0.1
#: A reading that changes by more than so many times the one at rest is said, for the log may have been zeroed: the seed's sensors
#: change by 0.04 and 0.4, strong ones by a few; and one beyond the second is refused.
LARGE_CHANGE, ABSURD_CHANGE = 5.0, 100.0
#: Into so many parts each half of a log without marked trials is cut for cross-validation.
PARTS = 8


@dataclass(frozen=True, eq=False)
class Prepared:
    """A log, ready to be fitted.

    Parameters
    ----------
    runs : tuple of Samples
        Without gaps; those `fit` that lie in the range of angles.
    groups : tuple of (n,) int
        For each run the number of the trial, or of the part of the log, that each sample belongs to.
    marked : bool
        Does the log mark its trials?
    low, high : float, deg
        The range of angles.
    u0 : float
        The reading at rest.
    rate_hz : float
    notes : tuple of str
        What was left out or taken for granted, a sentence each.
    """

    runs: tuple[Samples, ...]
    groups: tuple[NDArray[np.int64], ...]
    marked: bool
    low: float
    high: float
    u0: float
    rate_hz: float
    notes: tuple[str, ...]

    @property
    def n(self) -> int:
        """How many samples count."""
        return sum(int(run.fit.sum()) for run in self.runs)

    def only(self, groups: Sequence[int]) -> tuple[Samples, ...]:
        """The runs, with only samples of these groups to count."""
        return tuple(replace(run, fit=run.fit & np.isin(of, np.asarray(groups))) for run, of in zip(self.runs, self.groups, strict=True))

    @property
    def halves(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """The groups to fit, and those held out: the second half of the log, or of its trials."""
        labels = self.labels
        if self.marked:
            return labels[: (len(labels) + 1) // 2], labels[(len(labels) + 1) // 2 :]
        return tuple(k for k in labels if k < PARTS), tuple(k for k in labels if k >= PARTS)

    @property
    def folds(self) -> list[Fold]:
        """Of what is fitted: without each of its trials in turn and that trial, or its parts where there are not two trials."""
        first, _ = self.halves
        if len(first) > 1:
            return [(self.only([k for k in first if k != out]), self.only([out])) for out in first]
        return self.even_folds

    @property
    def even_folds(self) -> list[Fold]:
        """Of what is fitted: without each of as many equal parts of the samples that count, in turn, and that part."""
        first, _ = self.halves
        runs = self.only(first)
        total = max(sum(int(run.fit.sum()) for run in runs), 1)
        parts, before = [], 0
        for run in runs:
            parts.append((before + np.cumsum(run.fit) - 1) * PARTS // total)
            before += int(run.fit.sum())

        def part_of(out: int, *, held: bool) -> tuple[Samples, ...]:
            return tuple(replace(run, fit=run.fit & ((part == out) == held)) for run, part in zip(runs, parts, strict=True))

        return [(part_of(out, held=False), part_of(out, held=True)) for out in range(PARTS)]

    @property
    def by_trial(self) -> bool:
        """Are folds trials, and enough of them for a standard error?"""
        return self.marked and len(self.halves[0]) > 2

    @property
    def labels(self) -> tuple[int, ...]:
        """The groups that have samples that count, in the order of time."""
        found = [of[run.fit] for run, of in zip(self.runs, self.groups, strict=True)]
        return tuple(int(each) for each in np.unique(np.concatenate(found)))


def prepare(
    table: Table, *, signal: str, angle: str, limits: tuple[float, float] | None, u0: float | None = None, trial: str = "trial"
) -> Prepared:
    """Make a log ready.

    Parameters
    ----------
    table : Table
    signal, angle : str
        Headings of the reading (any unit) and of the true angle (deg).
    limits : (low, high), deg, optional
        Range of angles that counts; without it the paper's 10 to 80 where the log covers that, else all there is.
    u0 : float, optional
        The reading at rest; without it the median of the log's first still window.
    trial : str
        Heading of a column that numbers the trials, if there is one.

    Raises
    ------
    InputError
        A column is missing, rows are not in the order of time, the reading at rest is next to nothing, or
        hardly a sample is left; what and where is said.
    """
    time, readings, angles = table.time, table.column(signal), table.column(angle)
    if signal == angle:
        raise InputError(f"{signal!r} is named as signal and as angle; they must be two columns")
    time, notes = in_order(time, table.file)
    notes = [*table.notes, *notes]
    forward = np.concatenate([[True], np.diff(time) > 0])
    forward &= time >= np.maximum.accumulate(time)
    if count := int(np.count_nonzero(~forward)):
        first = int(np.argmin(forward)) + 1
        notes.append(f"{table.file}: {count} of {len(time)} rows stand still or go back in time (row {first} first); they were left out")
    there = np.isfinite(readings) & np.isfinite(angles)
    if count := int(np.count_nonzero(forward & ~there)):
        notes.append(f"{table.file}: {count} of {len(time)} rows have no reading or no angle; they are bridged up to {MAX_GAP_S:g} s")
    whole = forward & there
    for name, values in ((signal, readings), (angle, angles)):
        absurd = spikes(np.where(whole, time, np.nan), values) & whole
        if count := int(np.count_nonzero(absurd)):
            k = int(np.argmax(absurd))
            notes.append(
                f"{table.file}, row {k + 1}: {name!r} is {values[k]:g}, out of its neighbours by more than the rest of the log moves; "
                + (f"{count} such rows are left out" if count > 1 else "the row is left out")
            )
        whole &= ~absurd
    if np.count_nonzero(whole) < 3:
        raise InputError(f"{table.file}: fewer than 3 rows have a time, a {signal!r} and a {angle!r}; record more")
    time, readings, angles = time[whole], readings[whole], angles[whole]
    trials = table.columns.get(trial)
    if trials is not None and trial not in (signal, angle):
        trials = trials[whole]
        if not np.isfinite(trials).all() or len(np.unique(trials)) < 2:
            trials = None
    else:
        trials = None
    if np.ptp(readings) == 0:
        raise InputError(f"{table.file}: {signal!r} never changes; check the wiring, or name another column")
    if np.ptp(angles) == 0:
        raise InputError(f"{table.file}: {angle!r} never changes; record the joint moving")
    rate = 1 / float(np.median(np.diff(time)))
    pieces = _runs(time, trials, rate)
    filtered, short = _filtered(time, readings, angles, pieces, Lowpass(CUTOFF_HZ, rate))
    if short:
        notes.append(f"{table.file}: {short} stretches between gaps are too short to be filtered; they were left out")
    if not filtered:
        raise InputError(
            f"{table.file}: no stretch without a gap of more than {MAX_GAP_S:g} s is long enough to be filtered at {CUTOFF_HZ:g} Hz; "
            "record without drop-outs"
        )
    if u0 is None:
        rest = at_rest(filtered[0][1], rate, span=float(np.ptp(readings)))
        u0 = rest.level
        if not rest.still:
            notes.append(
                f"{table.file}: the joint never rests for {STILL_S:g} s; U0 is the median of the stillest such window, at "
                f"{rest.at_s:.1f} s, where it moves by {100 * rest.moved:.0f} % of the span"
            )
    _require_rest(u0, readings, np.flatnonzero(whole), signal, table.file, notes)
    limits = limits or _usual_limits(np.concatenate([run[2] for run in filtered]), table.file, notes)
    runs = tuple(Samples(t, relative(u, u0), a, (a >= limits[0]) & (a <= limits[1])) for t, u, a, _ in filtered)
    if not any(run.fit.any() for run in runs):
        low, high = float(angles.min()), float(angles.max())
        raise InputError(
            f"{table.file}: {angle!r} goes from {low:.1f} to {high:.1f} degrees, and nothing of it lies within {limits[0]:g} to "
            f"{limits[1]:g}; give --range {low:.0f} {high:.0f}"
        )
    groups = _groups(runs, [label for _, _, _, label in filtered] if trials is not None else None)
    return Prepared(runs, groups, trials is not None, *limits, u0, rate, tuple(notes))


def _require_rest(u0: float, readings: FloatArray, rows: NDArray[np.int64], signal: str, file: str, notes: list[str]) -> None:
    """A reading at rest that the others can be relative to."""
    if not u0:
        raise InputError(f"{file}: {signal!r} is 0 at rest, so that a relative change means nothing; is it zeroed already?")
    change = np.abs(relative(readings, u0))
    most = int(np.argmax(change))
    if change[most] > ABSURD_CHANGE:
        raise InputError(
            f"{file}: {signal!r} is {u0:g} at rest and {readings[most]:g} in row {rows[most] + 1}, a relative change of "
            f"{change[most]:.3g}, which no sensor has; if the log was zeroed, add the reading at rest again; if the row is wrong, "
            "take it out"
        )
    if change[most] > LARGE_CHANGE:
        notes.append(
            f"{file}: {signal!r} is {u0:g} at rest and {readings[most]:g} in row {rows[most] + 1}, a relative change of "
            f"{change[most]:.3g}: was the log zeroed? Then add the reading at rest again, or a small drift of it changes all angles"
        )


def _runs(time: FloatArray, trials: FloatArray | None, rate: float) -> list[slice]:
    """Where the log goes on without a gap, and within one trial."""
    broken = np.diff(time) > max(MAX_GAP_S, 1.5 / rate)
    if trials is not None:
        broken |= np.diff(trials) != 0
    edges = [0, *(np.flatnonzero(broken) + 1).tolist(), len(time)]
    runs = [slice(a, b) for a, b in pairwise(edges)]
    return runs if trials is None else sorted(runs, key=lambda run: (trials[run.start], run.start))


def _filtered(
    time: FloatArray, readings: FloatArray, angles: FloatArray, pieces: Sequence[slice], low: Lowpass
) -> tuple[list[tuple[FloatArray, FloatArray, FloatArray, int]], int]:
    """Each run at even times, filtered: time, reading, angle, its number; and how many were too short."""
    out, short = [], 0
    for number, run in enumerate(pieces):
        t = time[run]
        even = t[0] + np.arange(round((t[-1] - t[0]) * low.rate_hz) + 1) / low.rate_hz
        if len(even) < low.shortest:
            short += 1
            continue
        u, a = (low.zero_phase(np.interp(even, t, values[run])) for values in (readings, angles))
        out.append((even, u, a, number))
    return out, short


def _usual_limits(angles: FloatArray, file: str, notes: list[str]) -> tuple[float, float]:
    low, high = 10.0, 80.0
    if angles.min() <= low + 0.25 * (high - low) and angles.max() >= high - 0.25 * (high - low):
        return low, high
    least, most = float(angles.min()), float(angles.max())
    notes.append(f"{file}: the angles go from {least:.1f} to {most:.1f} degrees, not over the usual 10 to 80; all of them are fitted")
    return least, most


def _groups(runs: Sequence[Samples], labels: Sequence[int] | None) -> tuple[NDArray[np.int64], ...]:
    """By trial, or `PARTS` equal stretches of each half of the log."""
    if labels is not None:
        return tuple(np.full(len(run.time), label, dtype=np.int64) for run, label in zip(runs, labels, strict=True))
    total = sum(len(run.time) for run in runs)
    number = np.arange(total) * 2 * PARTS // total
    return tuple(np.split(number, np.cumsum([len(run.time) for run in runs])[:-1]))
