"""Faces without area, taken out of the surface without moving it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.fans import relative_heights
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DEGENERATE_HEIGHT

Points = NDArray[np.float64]
IntArray = NDArray[np.int64]

# A mesh with more flat faces than this is no surface with a slip in it; leave it to be refused.
_MOST_FLAT = 0.5
# Each round takes flat faces that do not touch; rows of them need a few.
_ROUNDS = 20


def merge_flat_faces(V: Points, F: IntArray) -> tuple[IntArray, int]:
    """Merge faces without area into their neighbours.

    A side of no length is contracted. Otherwise the middle corner lies on the longest side, which is
    flipped: the face across it is split there, and takes the flat face's place. At a border the flat
    face is dropped.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
        No face with a corner twice.

    Returns
    -------
    F : (k, 3) int64
        Over the same vertices, some of them no longer used.
    merged : int
        How many were merged; those that would tie a knot stay.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]])
    >>> merge_flat_faces(V, np.array([[0, 1, 2], [0, 2, 3]]))[0].tolist()  # 0-1-2 is flat: 0-2-3 is split at 1
    [[2, 3, 1], [1, 3, 0]]
    """
    merged = 0
    for _ in range(_ROUNDS):
        flat = np.flatnonzero(relative_heights(V, F) <= DEGENERATE_HEIGHT)
        if not 0 < len(flat) <= _MOST_FLAT * len(F):
            break
        step = _Round(V, F)
        done = sum(step.merge(f) for f in flat.tolist())
        if not done:
            break
        merged += done
        F = step.result()
    return F, merged


class _Round:
    """One round: changes that do not touch each other, decided on the mesh before it."""

    def __init__(self, V: Points, F: IntArray) -> None:
        self.V, self.before, self.top = V, F, Topology(F)
        self.F = F.copy()
        self.drop = np.zeros(len(F), dtype=bool)
        self.moved = np.arange(len(V))
        self.touched = np.zeros(len(V), dtype=bool)
        self._corners = np.argsort(F, axis=None, kind="stable")
        self._first = np.searchsorted(F.ravel()[self._corners], np.arange(len(V) + 1))

    def result(self) -> IntArray:
        F = self.moved[self.F][~self.drop]
        return F[~(F == np.roll(F, 1, axis=1)).any(axis=1)]

    def merge(self, f: int) -> bool:
        """Merge face `f` if that harms nothing; True if it was."""
        corners = self.before[f]
        if self.touched[corners].any():
            return False
        sides = np.linalg.norm(self.V[np.roll(corners, -1)] - self.V[corners], axis=1)
        shortest, longest = int(np.argmin(sides)), int(np.argmax(sides))
        if sides[shortest] == 0:
            return self._contract(int(corners[shortest]), int(corners[(shortest + 1) % 3]))
        count = int(self.top.edge_count[self.top.FE[f, longest]])
        if count == 1:
            self.drop[f] = True
            self.touched[corners] = True
            return True
        return count == 2 and self._flip(f, longest)

    def _faces_of(self, v: int) -> IntArray:
        return self._corners[self._first[v] : self._first[v + 1]] // 3

    def _contract(self, keep: int, gone: int) -> bool:
        """Contract an edge where the link condition holds, so that no sheets meet that did not."""
        near_keep, near_gone = self._faces_of(keep), self._faces_of(gone)
        around = np.concatenate([near_keep, near_gone])
        if self.touched[self.before[around]].any():
            return False
        shared = np.intersect1d(self.before[near_keep], self.before[near_gone])
        between = np.unique(self.before[np.intersect1d(near_keep, near_gone)])
        edge = int(self.top.edge_ids(np.array([[keep, gone]]))[0])
        border = self.top.is_boundary
        both_on_border = border[self.top.FE[near_keep]].any() and border[self.top.FE[near_gone]].any()
        if len(shared) != len(between) or (both_on_border and not border[edge]):
            return False
        self.moved[gone] = keep
        self.touched[self.before[around]] = True
        return True

    def _flip(self, f: int, side: int) -> bool:
        """Flip the longest side of `f` where the new edge is new and both faces get taller."""
        a, b, c = (int(self.before[f, (side + s) % 3]) for s in range(3))
        e = self.top.FE[f, side]
        across = int(self.top.EF[e, 0] == f)
        g, j = int(self.top.EF[e, across]), int(self.top.EC[e, across])
        d = int(self.before[g, (j + 2) % 3])
        if c == d or self.touched[d] or self.before[g, j] != b or self.top.edge_ids(np.array([[c, d]]))[0] >= 0:
            return False
        new = np.array([[a, d, c], [c, d, b]])
        if relative_heights(self.V, new).min() <= relative_heights(self.V, self.before[[f, g]]).min():
            return False
        self.F[[f, g]] = new
        self.touched[[a, b, c, d]] = True
        return True
