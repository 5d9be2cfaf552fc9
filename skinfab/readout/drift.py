"""A slow baseline under a fast signal: what drift moves goes with it, what a contact moves does not.

A plain high-pass forgets a contact that lasts; here whoever knows of one holds the baseline meanwhile. At rest a reading
far off counts as one just off, so that a spike does not drag the baseline along.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@njit(cache=True)
def follow(baseline: float, reading: float, dt: float, time_constant: float, reach: float) -> float:
    """One step of a baseline towards a reading: a first-order lag of `time_constant`, which sees no farther than `reach`."""
    off = min(max(reading - baseline, -reach), reach)
    return float(baseline + off * (1.0 - math.exp(-dt / time_constant)))


class Baseline:
    """The baselines of some channels, followed frame by frame.

    Parameters
    ----------
    start : (c,) float
        The readings at rest.
    time_constant : float, s
        How slowly it follows. A drift of r a second leaves it r times this behind.
    reach : (c,) float
        A reading farther off counts as one that far off: a few times the channel's noise.

    Examples
    --------
    A drift of 1 a second is followed 2 behind; a contact that is held is not followed at all.

    >>> line = Baseline(np.zeros(1), time_constant=2.0, reach=np.array([5.0]))
    >>> for k in range(2000):
    ...     base = line.step(np.array([k / 100]), 0.01, held=np.array([False]))
    >>> round(19.99 - float(base[0]), 1)
    2.0
    >>> before = float(base[0])
    >>> for k in range(1000):
    ...     base = line.step(np.array([500.0]), 0.01, held=np.array([True]))
    >>> float(base[0]) == before
    True
    """

    def __init__(self, start: FloatArray, *, time_constant: float, reach: FloatArray) -> None:
        self.values = np.array(start, dtype=float)
        self.time_constant, self.reach = time_constant, reach

    def step(self, readings: FloatArray, dt: float, *, held: BoolArray) -> FloatArray:
        """The baselines `dt` seconds on; those of channels that are held, or read nothing, stay."""
        for k in np.flatnonzero(~held & np.isfinite(readings)):
            self.values[k] = follow(self.values[k], readings[k], dt, self.time_constant, self.reach[k])
        return self.values.copy()
