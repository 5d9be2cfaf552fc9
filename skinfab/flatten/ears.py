"""Ears and other triangles without an inner vertex: on a straight side of a target shape they have no room."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Halved:
    """The same surface with its chords halved.

    Parameters
    ----------
    V : (n + k, 3) float64, mm
        The given vertices, then the chords' middles.
    F : (l, 3) int64
    face_of : (l,) int64
        The given triangle that each is a part of.
    chords : (k, 2) int64
        Ends of the halved edges.
    """

    V: FloatArray
    F: IntArray
    face_of: IntArray
    chords: IntArray

    def __repr__(self) -> str:
        return f"Halved({len(self.F)} triangles, {len(self.chords)} chords halved)"


def halve_chords(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> Halved:
    """Halve every chord: an inner edge from border to border. Then each triangle has an inner vertex to stand up by.

    An ear (two edges on the border) hangs on a chord. A layout that puts its three corners on one straight side leaves
    it no area; halved, it is two triangles about a vertex inside. A lone triangle has no chord and stays.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
    topology : Topology, optional
        Of `F`, where it is at hand.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
    >>> halved = halve_chords(V, np.array([[0, 1, 2], [0, 2, 3]]))
    >>> len(halved.F), halved.chords.tolist(), halved.V[4].tolist()
    (4, [[0, 2]], [1.0, 1.0, 0.0])
    """
    topology = topology or Topology(F)
    on_border = np.zeros(len(V), dtype=bool)
    on_border[topology.E[topology.is_boundary].ravel()] = True
    chord = ~topology.is_boundary & on_border[topology.E].all(axis=1)
    middle = np.full(len(topology.E), -1, dtype=np.int64)
    middle[chord] = len(V) + np.arange(chord.sum())
    # Edge k of a face runs from its corner k to k + 1.
    halves = middle[topology.FE]
    count = (halves >= 0).sum(axis=1)
    faces, owners = [F[count == 0]], [np.flatnonzero(count == 0)]
    for n, parts in _PARTS.items():
        which = np.flatnonzero(count == n)
        # Turned so that the halved edges come first; of three, any may.
        first = np.argmax((halves[which] >= 0) & (np.roll(halves[which], 1, axis=1) < 0), axis=1)
        turn = (first[:, None] + np.arange(3)) % 3
        six = np.take_along_axis(np.hstack([F[which], halves[which]]), np.hstack([turn, turn + 3]), axis=1)
        faces += [six[:, part] for part in parts]
        owners += [which] * len(parts)
    face_of = np.concatenate(owners)
    order = np.argsort(face_of, kind="stable")
    ends = topology.E[chord]
    return Halved(np.vstack([V, V[ends].mean(axis=1)]), np.concatenate(faces)[order], face_of[order], ends)


#: Triangles, by the number of halved edges, among corners 0, 1, 2 and the middles 3, 4, 5 of the edges 0-1, 1-2, 2-0.
_PARTS = {
    1: ([0, 3, 2], [3, 1, 2]),
    2: ([0, 3, 4], [3, 1, 4], [0, 4, 2]),
    3: ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]),
}
