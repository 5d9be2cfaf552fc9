"""Who touches whom: edges, faces across edges, boundary loops, Euler number."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

IntArray = NDArray[np.int64]


class Topology:
    """Edges of a triangle list and how faces meet at them.

    Parameters
    ----------
    F : (m, 3) int64

    Attributes
    ----------
    E : (e, 2) int64
        Edges, smaller vertex first, sorted.
    FE : (m, 3) int64
        Edge k of a face runs from its corner k to its corner k+1.
    EF : (e, 2) int64
        The two faces at an edge; -1 where there is none. At a non-manifold edge, the first two.
    EC : (e, 2) int64
        The position 0..2 of the edge in each of those faces; -1 where there is none.
    edge_count : (e,) int64
        How many faces meet at the edge: 1 boundary, 2 interior, more non-manifold.

    Examples
    --------
    >>> t = Topology(np.array([[0, 1, 2], [0, 2, 3]]))
    >>> t.E.tolist(), t.is_boundary.sum(), t.euler
    ([[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]], np.int64(4), 1)
    """

    def __init__(self, F: IntArray) -> None:
        self.F = F = np.ascontiguousarray(F, dtype=np.int64)
        count = len(F)
        half = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
        low, high = half.min(axis=1), half.max(axis=1)
        # int64 keys: u * n + v overflows 32 bits above 46k vertices.
        n = int(F.max()) + 1 if count else 0
        keys, inverse, self.edge_count = np.unique(low * n + high, return_inverse=True, return_counts=True)
        self._keys, self._n = keys, n
        self.E = np.column_stack([keys // max(n, 1), keys % max(n, 1)])
        self.FE = inverse.reshape(3, count).T.copy()
        order = np.argsort(inverse, kind="stable")
        first = np.concatenate([[0], np.cumsum(self.edge_count)[:-1]]).astype(np.int64) if count else np.zeros(0, np.int64)
        self.EF = np.full((len(keys), 2), -1)
        self.EC = np.full((len(keys), 2), -1)
        one = order[first]
        self.EF[:, 0], self.EC[:, 0] = one % max(count, 1), one // max(count, 1)
        paired = self.edge_count >= 2
        two = order[first[paired] + 1]
        self.EF[paired, 1], self.EC[paired, 1] = two % max(count, 1), two // max(count, 1)

    @property
    def is_boundary(self) -> NDArray[np.bool_]:
        """(e,) one face only."""
        return self.edge_count == 1

    @property
    def is_nonmanifold(self) -> NDArray[np.bool_]:
        """(e,) more than two faces."""
        return self.edge_count > 2

    @cached_property
    def used_vertices(self) -> IntArray:
        """Vertices that some face uses, sorted."""
        return np.unique(self.F)

    @property
    def euler(self) -> int:
        """V - E + F over the vertices in use: 1 for a disk, 2 for a sphere."""
        return len(self.used_vertices) - len(self.E) + len(self.F)

    def edge_ids(self, pairs: IntArray) -> IntArray:
        """Index into `E` of each vertex pair, (k,); -1 where it is not an edge."""
        pairs = np.asarray(pairs, dtype=np.int64).reshape(-1, 2)
        if not len(self._keys):
            return np.full(len(pairs), -1)
        outside = (pairs < 0).any(axis=1) | (pairs >= self._n).any(axis=1)
        key = pairs.min(axis=1) * self._n + pairs.max(axis=1)
        at = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        return np.where((self._keys[at] == key) & ~outside, at, -1)

    def face_components(self, cut: NDArray[np.bool_] | None = None) -> tuple[int, IntArray]:
        """Number of face groups joined across edges, and each face's group (m,); `cut` edges do not join."""
        joins = self.EF[:, 1] >= 0
        if cut is not None:
            joins &= ~cut
        a, b = self.EF[joins].T
        graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(len(self.F), len(self.F)))
        count, label = connected_components(graph, directed=False)
        return int(count), label.astype(np.int64)

    @cached_property
    def boundary_loops(self) -> list[IntArray]:
        """Boundary vertices in face order, one array a loop, longest first.

        At a vertex where loops touch (a bow-tie) the walk keeps to the fan of faces it came along,
        so that every boundary edge is in just one loop.
        """
        edges = np.flatnonzero(self.is_boundary)
        face, corner = self.EF[edges, 0], self.EC[edges, 0]
        start, end = self.F[face, corner], self.F[face, (corner + 1) % 3]
        leaving: dict[int, list[int]] = {}
        for k, v in enumerate(start.tolist()):
            leaving.setdefault(v, []).append(k)
        unused = np.ones(len(edges), dtype=bool)
        loops = []
        for k0 in range(len(edges)):
            if not unused[k0]:
                continue
            loop, k = [], k0
            while k >= 0 and unused[k]:
                unused[k] = False
                loop.append(int(start[k]))
                k = self._next_boundary(k, face, end, leaving)
            loops.append(np.array(loop, dtype=np.int64))
        return sorted(loops, key=len, reverse=True)

    def _next_boundary(self, k: int, face: IntArray, end: IntArray, leaving: dict[int, list[int]]) -> int:
        options = leaving.get(int(end[k]), [])
        if len(options) <= 1:
            return options[0] if options else -1
        # Turn about the vertex from face to face until an edge with nothing behind it.
        v, f = int(end[k]), int(face[k])
        for _ in range(len(self.F)):
            c = int(np.flatnonzero(self.F[f] == v)[0])
            e = int(self.FE[f, c])
            if self.edge_count[e] == 1:
                return next(j for j in options if int(face[j]) == f)
            f = int(self.EF[e, 1] if self.EF[e, 0] == f else self.EF[e, 0])
        return options[0]
