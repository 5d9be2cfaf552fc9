"""The way of a seam from one vertex of a mesh to any other, quick enough to follow a pointer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from skinfab.mesh.model import Mesh
from skinfab.seams.graph import edge_graph
from skinfab.seams.rules import edge_rules
from skinfab.seams.weights import seam_weights
from skinfab.skin import SeamMarks, Skin

IntArray = NDArray[np.int64]


class Ways:
    """The cheapest ways of a seam over a mesh, to be kept while the pointer moves.

    The search from one vertex is done once and kept until another vertex is asked for, so that following the pointer
    only reads off a way.

    Parameters
    ----------
    mesh : Mesh
    marks : SeamMarks, optional
        Attracting faces make a way through them cheaper, avoided ones dearer; forbidden edges are never on a way.

    Examples
    --------
    >>> kite = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 2, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> Ways(kite).path(1, 3).tolist()
    [1, 0, 3]
    """

    def __init__(self, mesh: Mesh, marks: SeamMarks | None = None) -> None:
        self.mesh, self.marks = mesh, marks
        weight = seam_weights(mesh)
        self._forbidden = np.zeros(len(weight), dtype=bool)
        if marks is not None:
            rules = edge_rules(mesh, marks)
            self._forbidden = rules.forbidden
            weight = np.where(rules.forbidden, np.inf, weight * rules.factor)
        self._graph = edge_graph(mesh.topology, weight, len(mesh.V))
        self._start = -1
        self._before = np.zeros(0, dtype=np.int64)

    def suit(self, skin: Skin) -> bool:
        """Whether they are ways over that skin as it is now."""
        return skin.mesh is self.mesh and skin.marks is self.marks

    def path(self, start: int, end: int) -> IntArray:
        """Vertices of the cheapest way, (k,), both ends included; an edge between the two is always the way.

        Empty where no way leads there; one vertex where `start` is `end`.
        """
        edge = int(self.mesh.topology.edge_ids(np.array([[start, end]]))[0])
        if start == end or (edge >= 0 and not self._forbidden[edge]):
            return np.array([start, end][: 1 if start == end else 2], dtype=np.int64)
        if start != self._start:
            _, before = dijkstra(self._graph, indices=start, return_predecessors=True)
            self._start, self._before = start, before.astype(np.int64)
        if self._before[end] < 0:
            return np.zeros(0, dtype=np.int64)
        back = [end]
        while back[-1] != start:
            back.append(int(self._before[back[-1]]))
        return np.array(back[::-1], dtype=np.int64)
