"""Who touches whom: edges, faces across edges, boundary loops, Euler number."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.joined import joined

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
        corner = F.T.ravel()
        next_corner = F[:, [1, 2, 0]].T.ravel()
        low, high = np.minimum(corner, next_corner), np.maximum(corner, next_corner)
        self._n = n = int(F.max()) + 1 if count else 0
        order = _order_of_pairs(low, high)
        low, high = low[order], high[order]
        new = np.ones(3 * count, dtype=bool)
        new[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
        first = np.flatnonzero(new)
        self.edge_count = np.diff(first, append=3 * count)
        self.E = np.column_stack([low[first], high[first]])
        # int64 keys: u * n + v overflows 32 bits above 46k vertices.
        self._keys = self.E[:, 0] * n + self.E[:, 1]
        edge = np.empty(3 * count, dtype=np.int64)
        edge[order] = np.cumsum(new) - 1
        self.FE = edge.reshape(3, count).T.copy()
        self.EF = np.full((len(first), 2), -1)
        self.EC = np.full((len(first), 2), -1)
        self.EC[:, 0], self.EF[:, 0] = np.divmod(order[first], max(count, 1))
        paired = self.edge_count >= 2
        self.EC[paired, 1], self.EF[paired, 1] = np.divmod(order[first[paired] + 1], max(count, 1))

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
        used = np.zeros(self._n, dtype=bool)
        used[self.F] = True
        return np.flatnonzero(used)

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
        if cut is None:
            return self._components
        return self._joined_over(~cut)

    @cached_property
    def _components(self) -> tuple[int, IntArray]:
        count, label = self._joined_over(np.ones(len(self.E), dtype=bool))
        label.flags.writeable = False  # handed out to everyone who asks
        return count, label

    def _joined_over(self, edges: NDArray[np.bool_]) -> tuple[int, IntArray]:
        a, b = self.EF[edges & (self.EF[:, 1] >= 0)].T
        return joined(a, b, len(self.F))

    @cached_property
    def is_oriented_manifold(self) -> bool:
        """Two faces at most at each edge, wound alike; one fan of faces at each vertex; no two faces with the same corners.

        False, too, where a vertex has more than `_MOST_STEPS` faces: nothing is said of such a mesh.
        """
        return _is_oriented_manifold(self)

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


# What a number that is not negative has.
_BITS = 63
# Steps around all vertices at once: a mesh with larger fans takes the general way.
_MOST_STEPS = 64


def _order_of_pairs(low: IntArray, high: IntArray) -> IntArray:
    """The stable order of pairs of numbers by `low`, then `high`."""
    count = len(low)
    if not count:
        return np.zeros(0, dtype=np.int64)
    least, middle, most = int(low.min()), int(low.min() + low.max() + 1) // 2, int(low.max())
    bits = [int(top).bit_length() for top in (most - least, high.max(), count - 1)]
    if sum(bits) <= _BITS and high.min() >= 0:
        # Sorting numbers is several times faster than sorting their places, so that each carries its own.
        key = ((low - least) << (bits[1] + bits[2])) | (high << bits[2]) | np.arange(count)
        key.sort()
        key &= (1 << bits[2]) - 1
        return key
    if least == most:
        return np.argsort(high, kind="stable")
    below = low < middle
    parts = np.flatnonzero(below), np.flatnonzero(~below)
    return np.concatenate([part[_order_of_pairs(low[part], high[part])] for part in parts])


def _is_oriented_manifold(top: Topology) -> bool:
    if not len(top.F) or top.edge_count.max() > 2 or (top.E[:, 0] == top.E[:, 1]).any():
        return False
    # Half-edge 3 f + c starts at corner c of face f.
    flat = top.F.ravel()
    edge_half = 3 * top.EF + top.EC
    two = top.edge_count == 2
    here, there = edge_half[two].T
    if (flat[here] == flat[there]).any():  # run along the edge in the same direction
        return False
    before = np.arange(len(flat)).reshape(-1, 3)[:, [2, 0, 1]].ravel()
    if (flat[before[here]] == flat[before[there]]).any():  # the same third corner
        return False
    twin = np.full(len(flat), -1)
    twin[here], twin[there] = there, here
    following = twin[before]  # the next corner around the same vertex
    start = np.full(top._n, -1)
    start[flat] = np.arange(len(flat))
    border = edge_half[~two, 0]
    start[flat[border]] = border  # where nothing comes before
    # Walk around all vertices at once: with one fan at each, every corner is met just once.
    first = at = start[start >= 0]
    met = 0
    for _ in range(_MOST_STEPS):
        met += len(at)
        at = following[at]
        going = (at >= 0) & (at != first)
        first, at = first[going], at[going]
        if not len(at):
            return met == len(flat)
    return False
