"""What tactels read when nothing touches them: measured at first, followed while they are untouched, and left out where they are broken.

Capacitors warm up, and their rest wanders by more than a light touch within minutes. While nothing touches them it is followed, each by a
slow low-pass, and what all have in common with its speed, so that it does not lag; while something does they go on at that speed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Time constant of following, s: a touch of 0.1 N that takes longer than this to come is taken for wandering.
FOLLOW_S = 1.5
#: A tactel that reads bit for bit the same for so long, s, and so many frames, is broken, where so many of all change in every frame.
STUCK_S, STUCK_FRAMES, LIVELY = 1.0, 8, 0.75


def stuck_at_rest(volts: FloatArray) -> BoolArray:
    """Tactels that never change in frames (n, rings, stripes) in which the others do.

    Examples
    --------
    >>> volts = np.random.default_rng(0).random((20, 2, 2)); volts[:, 0, 1] = 1.3
    >>> stuck_at_rest(volts)
    array([[False,  True],
           [False, False]])
    """
    if len(volts) < STUCK_FRAMES:
        return np.zeros(volts.shape[1:], dtype=bool)
    changes = np.diff(volts, axis=0) != 0
    still: BoolArray = np.isfinite(volts).all(axis=0) & ~changes.any(axis=0)
    return still & bool(not still.all() and changes[:, ~still].mean() >= LIVELY)


class Rest:
    """Voltages at rest, as they wander, and tactels that are broken.

    Parameters
    ----------
    rest_v : (rings, stripes) float
        NaN of a tactel that is left out from the start.

    Examples
    --------
    >>> rest = Rest(np.ones((1, 2)))
    >>> for k in range(200):
    ...     rest.follow(k / 10, np.array([[1.02, 1.02]]), idle=True)
    >>> rest.volts.round(3)
    array([[1.02, 1.02]])
    """

    def __init__(self, rest_v: FloatArray) -> None:
        self.dead = ~np.isfinite(rest_v)
        self.volts = np.where(self.dead, 1.0, rest_v)
        self._time, self._drift = math.nan, 0.0  # s, and by what part a second all of them wander
        self._last = np.full(rest_v.shape, np.nan)
        self._since = np.zeros(rest_v.shape)  # since when each reads the same, s
        self._same = np.zeros(rest_v.shape, dtype=np.int64)  # for how many frames
        self.ever_stuck = np.zeros(rest_v.shape, dtype=bool)

    def alive(self, time: float, volts: FloatArray) -> FloatArray:
        """A frame's voltages, NaN of tactels that are broken."""
        same = volts == self._last
        self._since = np.where(same, self._since, time)
        self._same, self._last = np.where(same, self._same + 1, 0), volts
        known = np.isfinite(volts) & ~self.dead
        lively = known.any() and (~same[known]).mean() >= LIVELY
        stuck = known & (time - self._since >= STUCK_S) & (self._same >= STUCK_FRAMES) & lively
        self.ever_stuck |= stuck
        return np.where(stuck | self.dead, np.nan, volts)

    def follow(self, time: float, volts: FloatArray, *, idle: bool) -> None:
        """Follow a frame's voltages where nothing touches (`idle`), and else the speed at which they wandered."""
        took, self._time = time - self._time, time
        if not took > 0:
            return
        self.volts = self.volts * (1 + self._drift * took)
        known = np.isfinite(volts) & (volts > 0)
        if not idle or not known.any():
            return
        part = 1 - math.exp(-took / FOLLOW_S)
        off = np.where(known, volts, self.volts) / self.volts - 1
        common = float(np.median(off[known]))
        self._drift += part**2 / 2 * common / took  # damped by 0.7
        self.volts = self.volts * (1 + part * np.where(known, off, common))
