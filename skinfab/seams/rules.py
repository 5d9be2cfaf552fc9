"""What a person's marks mean for each edge: what it costs to cut, whether it stays a seam, whether it never becomes one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from skinfab.mesh.model import Mesh
from skinfab.seams.weights import seam_weights
from skinfab.skin import SeamMarks

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]

#: A seam through attracting faces costs a quarter, one through avoided faces four times as much: a detour of that length pays.
_PREFERENCE = 4.0

#: An automatic search may plan across a forbidden edge where nothing else is left (and is then refused that edge): this many
#: times dearer, no detour on a mesh is too long, and the integer capacities of a minimum cut still tell other edges apart.
_FORBIDDEN = 1000.0


@dataclass(frozen=True, eq=False)
class EdgeRules:
    """The marks by edges of a mesh.

    Parameters
    ----------
    factor : (e,) float64
        What the cost of cutting is multiplied by.
    locked : (e,) bool
        Stays a seam.
    forbidden : (e,) bool
        Never is a seam.
    """

    factor: FloatArray
    locked: BoolArray
    forbidden: BoolArray

    def weights(self, mesh: Mesh) -> FloatArray:
        """(e,) cost of cutting each edge for an automatic search; forbidden edges are very dear, not endlessly."""
        return seam_weights(mesh) * self.factor * np.where(self.forbidden, _FORBIDDEN, 1.0)


def edge_rules(mesh: Mesh, marks: SeamMarks) -> EdgeRules:
    """The marks of `mesh` by edge.

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> avoid_one = SeamMarks(np.array([[0, 2]]), np.zeros((0, 2), dtype=int), np.array([-1, 0], dtype=np.int8))
    >>> rules = edge_rules(square, avoid_one)
    >>> square.topology.E.tolist(), rules.factor.tolist()
    ([[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]], [4.0, 2.0, 1.0, 4.0, 1.0])
    >>> rules.locked.nonzero()[0].tolist()
    [1]
    """
    topology = mesh.topology
    first, second = topology.EF.T
    liked = marks.preference.astype(np.float64)
    mean = (liked[first] + liked[np.where(second >= 0, second, first)]) / 2
    return EdgeRules(_PREFERENCE**-mean, edge_mask(mesh, marks.locked), edge_mask(mesh, marks.forbidden))


def edge_mask(mesh: Mesh, pairs: NDArray[np.int64]) -> BoolArray:
    """(e,) bool: the edges that (k, 2) vertex pairs name; a pair that is no edge names none."""
    named = np.zeros(len(mesh.topology.E), dtype=bool)
    edges = mesh.topology.edge_ids(np.asarray(pairs).reshape(-1, 2))
    named[edges[edges >= 0]] = True
    return named


def coarse_rules(mesh: Mesh, rules: EdgeRules, small: Mesh, locked: BoolArray) -> EdgeRules:
    """Rules of a mesh on a simplified one, whose edges `locked` (e,) stand for the locked seams.

    A forbidden edge has no likeness on other triangles: there the way along it is only made dear.
    """
    middles = mesh.V[mesh.topology.E].mean(axis=1)
    nearest = cKDTree(middles).query(small.V[small.topology.E].mean(axis=1))[1]
    factor = rules.factor[nearest] * np.where(rules.forbidden[nearest], _FORBIDDEN, 1.0)
    return EdgeRules(factor, locked, np.zeros(len(small.topology.E), dtype=bool))
