"""Fingerprints of readings: a log that was saved anew by another program is another file, with the same readings.

Each reading of six channels becomes one number, after rounding that is coarser than what a file's decimals change and finer than a
sensor's noise: so no two readings of two touches are alike but by rare chance, and those of a copy are, also where it begins elsewhere.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Readings are rounded to so much, G and deg/s: some hundredth of the noise of the simulated sensor, the last digit of common ones.
_GRID = np.repeat([1e-3, 0.1], 3)
#: Trials that share more of their readings have them from one log. What chance makes alike is a thousandth of that.
_SHARED = 0.1
#: And no fewer than so many: a channel that hangs makes single readings alike.
_FEWEST = 4
#: So many numbers of a trial are kept in a model, the smallest: which ones these are does not depend on where a trial begins.
KEPT = 24
#: Of all channels, and of each kind alone: so a copy in which a channel of the other kind differs is known too.
_VIEWS = (slice(0, 6), slice(0, 3), slice(3, 6))
#: Odd factors by which bits are mixed (Steele, Lea and Flood 2014, splitmix64).
_MIX = (np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB))


def prints_of(values: FloatArray, view: slice = _VIEWS[0]) -> IntArray:
    """A number for each different reading (n, 6) that has any channel of a view, ascending.

    Examples
    --------
    >>> values = np.random.default_rng(0).standard_normal((100, 6))
    >>> saved_anew = np.round(values, 4)
    >>> len(np.intersect1d(prints_of(values), prints_of(saved_anew[20:]))) > 60
    True
    """
    values = values[:, view]
    cells = np.where(np.isfinite(values), np.rint(values / _GRID[view]), np.iinfo(np.int32).max)
    rows = cells[np.isfinite(values).any(axis=1)].astype(np.int64).view(np.uint64)
    out = np.zeros(len(rows), dtype=np.uint64)
    for column in rows.T:
        out = (out ^ column) + np.uint64(0x9E3779B97F4A7C15)
        out = (out ^ (out >> np.uint64(30))) * _MIX[0]
        out = (out ^ (out >> np.uint64(27))) * _MIX[1]
        out ^= out >> np.uint64(31)
    found: IntArray = np.unique(out.view(np.int64))
    return found


def kept_of(values: FloatArray) -> list[list[int]]:
    """What a model keeps of a trial's readings: some numbers of each view."""
    return [prints_of(values, view)[:KEPT].tolist() for view in _VIEWS]


def known(values: FloatArray, kept: Sequence[Sequence[int]]) -> bool:
    """Are these readings, or a part of them, among those that a model keeps, all channels of them or those of one kind?"""
    views = [prints_of(values, view) for view in _VIEWS]
    own, count = np.concatenate(views), max(map(len, views))
    return any(_alike(np.isin(np.asarray(each, dtype=np.int64), own).sum(), min(len(each), count)) for each in kept)


def shared(trials: Sequence[FloatArray]) -> dict[tuple[int, int], float]:
    """Which pairs (i, j), i < j, of trials have readings in common, and how large a part of the longer one's.

    Of readings that are there three times, each trial is paired with the next one that has them.
    """
    each = [prints_of(values) for values in trials]
    of = np.repeat(np.arange(len(each)), [len(one) for one in each])
    every = np.concatenate(each) if each else np.empty(0, dtype=np.int64)
    order = np.argsort(every, kind="stable")
    twice = np.flatnonzero(np.diff(every[order]) == 0)
    count = Counter(zip(of[order[twice]].tolist(), of[order[twice + 1]].tolist(), strict=True))
    sizes = [len(one) for one in each]
    return {
        pair: number / max(sizes[pair[0]], sizes[pair[1]])
        for pair, number in sorted(count.items())
        if _alike(number, min(sizes[pair[0]], sizes[pair[1]]))
    }


def _alike(number: int, of: int) -> bool:
    return bool(number >= max(_FEWEST, _SHARED * of))
