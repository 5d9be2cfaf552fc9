"""What tactels read when nothing touches them: measured at first, followed while they are untouched, and left out where they are broken.

Capacitors warm up, and their rest wanders by more than a light touch within minutes. What all have in common is followed at once and with
its speed, so that it does not lag: it is the median of the tactels that nothing touches, be it all of them or those far from a contact.
What each does beside that is followed no faster than so much, so that a slow press is not taken for it. What a contact may reach goes on
as fast as before, for a while, and so do all where it leaves too few untouched.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Time constants of following what all tactels do, and each, s; by how much a second each is followed at most beside what all do, as a
#: part of the gap: what 0.4 N a minute read, so that a press which grows faster is told; over how long each one's speed is measured, s.
COMMON_S, FOLLOW_S, OWN_MOST, OWN_S = 0.5, 1.5, 3e-4, 10.0
#: Under a contact without tactels to follow they go on for so long, s, at no more than this part a second; and as few will do, of all.
FORGET_S, FASTEST, FEWEST = 20.0, 1e-3, 0.18
#: What all do at once and by more than this, half of what 0.1 N read, is stepped over.
JUMP = 2e-3
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
        # s, by what part a second all of them wander, and each beside that
        self._time, self._drift, self._own = math.nan, 0.0, np.zeros(rest_v.shape)
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

    def step_back(self, volts: FloatArray, *, least: float) -> float:
        """Follow at once where all tactels are off alike, within `least` and by more than that: nothing touches all of them so.

        Returns
        -------
        float
            By what part.
        """
        off = (volts / self.volts - 1)[np.isfinite(volts) & ~self.dead]
        common = float(np.median(off)) if off.size else 0.0
        if abs(common) <= least or np.abs(off - common).max() >= least:
            return 0.0
        self.volts = self.volts * (1 + common)
        return common

    def follow(self, time: float, volts: FloatArray, *, idle: bool, untouched: BoolArray | None = None) -> None:
        """Follow a frame's voltages where nothing touches (`idle`), and else those `untouched`, which a contact does not reach."""
        took, self._time = time - self._time, time
        if not took > 0:
            return
        self.volts = self.volts * (1 + self._drift * took)
        known = np.isfinite(volts) & (volts > 0) & ~self.dead
        if not idle:
            known &= untouched if untouched is not None else False
        if not known.any() or (not idle and known.sum() < FEWEST * known.size):
            self._drift = float(np.clip(self._drift, -FASTEST, FASTEST)) * math.exp(-took / FORGET_S)
            known[:] = False
        else:
            self._follow(took, volts, known)
        # What is not read goes on as it did, ever more slowly.
        self.volts = np.where(known, self.volts, self.volts * (1 + self._own * took))
        self._own = np.where(known, self._own, self._own * math.exp(-took / FORGET_S))

    def _follow(self, took: float, volts: FloatArray, known: BoolArray) -> None:
        part, all_part = 1 - math.exp(-took / FOLLOW_S), 1 - math.exp(-took / COMMON_S)
        off = np.where(known, volts, self.volts) / self.volts - 1
        common = float(np.median(off[known]))
        if abs(common) > JUMP:
            self.volts, off, common = self.volts * (1 + common), off - common, 0.0
        self._drift += all_part**2 / 2 * common / took  # damped by 0.7
        beside = np.where(known, np.clip(off - common, -OWN_MOST * FOLLOW_S, OWN_MOST * FOLLOW_S), 0.0)
        self.volts = self.volts * (1 + all_part * common + part * beside)
        self._own = np.where(known, self._own + (1 - math.exp(-took / OWN_S)) * (part * beside / took - self._own), self._own)

    def renew(self, volts: FloatArray) -> None:
        """Take these voltages for the rest."""
        self.volts = np.where(np.isfinite(volts) & (volts > 0), volts, self.volts)
        self._drift, self._own = 0.0, np.zeros(volts.shape)
