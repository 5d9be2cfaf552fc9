"""Cut a piece of any genus and any number of holes open to one disk, with short seams.

Tree-cotree (Erickson and Whittlesey 2005, "Greedy optimal homotopy and homology generators"): a shortest-path
tree grown from the boundary (or from one point of a closed piece), a dual spanning tree that crosses the
edges whose detour through the first tree is longest, and the few edges in neither close the cut.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import minimum_spanning_tree

from skinfab.mesh.topology import Topology
from skinfab.seams.graph import edge_graph, shortest_tree, trace

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cut_to_disk(topology: Topology, weight: FloatArray, n_vertices: int, *, start: int | None = None) -> IntArray:
    """Edges whose opening turns a connected piece into a disk.

    Parameters
    ----------
    topology : Topology
        Of the piece: connected, manifold, every vertex in use.
    weight : (e,) float
        Cost of cutting each edge, > 0: length, cheaper on creases.
    n_vertices : int
    start : int, optional
        For a closed piece: the vertex to grow the cut from; a sphere's slit begins there. Default: the best of a few far ones.

    Returns
    -------
    (k,) int64
        Edge ids; none when it is a disk.

    Examples
    --------
    >>> ring = Topology(np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]]))
    >>> len(cut_to_disk(ring, np.ones(len(ring.E)), 6))
    1
    """
    graph = edge_graph(topology, weight, n_vertices)
    boundary = np.unique(topology.E[topology.is_boundary])
    if len(boundary):
        return _tree_cotree(topology, weight, shortest_tree(graph, boundary))
    sources = far_points(graph, 4) if start is None else np.array([start])
    if topology.euler == 2:
        distance, before = shortest_tree(graph, sources[:1])
        slit = topology.edge_ids(trace(before, int(np.argmax(distance))))
        return slit if len(slit) > 1 else _lengthen(topology, weight, int(slit[0]))
    cuts = [_prune(topology, _tree_cotree(topology, weight, shortest_tree(graph, np.array([s])))) for s in sources]
    return min(cuts, key=lambda c: float(weight[c].sum()))


def _tree_cotree(topology: Topology, weight: FloatArray, tree: tuple[FloatArray, IntArray]) -> IntArray:
    distance, before = tree
    in_tree = np.zeros(len(topology.E), dtype=bool)
    child = np.flatnonzero(before >= 0)
    in_tree[topology.edge_ids(np.stack([child, before[child]], axis=1))] = True
    crossable = np.flatnonzero((topology.EF[:, 1] >= 0) & ~in_tree)
    detour = distance[topology.E].sum(axis=1) + weight
    f, g = topology.EF[crossable].T
    # Two faces may share two edges: keep the one whose detour is longer.
    low, high = np.minimum(f, g), np.maximum(f, g)
    order = np.lexsort((-detour[crossable], high, low))
    first = np.r_[True, (np.diff(low[order]) != 0) | (np.diff(high[order]) != 0)] if len(order) else np.zeros(0, dtype=bool)
    kept = order[first]
    cost = detour[crossable].max(initial=0.0) * 2 + 1 - detour[crossable]
    m = len(topology.F)
    spanning = minimum_spanning_tree(coo_array((cost[kept], (low[kept], high[kept])), shape=(m, m)).tocsr()).tocoo()
    crossed = set(zip(spanning.row.tolist(), spanning.col.tolist(), strict=True))
    crossed_edge = np.zeros(len(topology.E), dtype=bool)
    for k in kept.tolist():
        if (int(low[k]), int(high[k])) in crossed:
            crossed_edge[crossable[k]] = True
    closing = crossable[~crossed_edge[crossable]]
    cut = np.zeros(len(topology.E), dtype=bool)
    cut[closing] = True
    for v in topology.E[closing].ravel().tolist():
        cut[topology.edge_ids(trace(before, v))] = True
    return np.flatnonzero(cut)


def _lengthen(topology: Topology, weight: FloatArray, edge: int) -> IntArray:
    """The edge and the cheapest next to it: between two vertices alone a slit does not open."""
    cost = np.where(np.isin(topology.E, topology.E[edge]).any(axis=1), weight, np.inf)
    cost[edge] = np.inf
    return np.array([edge, np.argmin(cost)])


def _prune(topology: Topology, cut: IntArray) -> IntArray:
    """Drop the tails of a closed piece's cut: a dead end opens nothing."""
    kept = set(cut.tolist())
    at: dict[int, set[int]] = {}
    for e in kept:
        for v in topology.E[e].tolist():
            at.setdefault(v, set()).add(e)
    ends = [v for v, edges in at.items() if len(edges) == 1]
    while ends:
        v = ends.pop()
        if len(at[v]) != 1:
            continue
        e = at[v].pop()
        kept.discard(e)
        other = int(topology.E[e].sum()) - v
        at[other].discard(e)
        if len(at[other]) == 1:
            ends.append(other)
    return np.array(sorted(kept), dtype=np.int64)


def far_points(graph: csr_array, count: int) -> IntArray:
    """Points far from each other, the first two about a diameter apart."""
    points = [int(np.argmax(shortest_tree(graph, np.array([0]))[0]))]
    while len(points) < count:
        points.append(int(np.argmax(shortest_tree(graph, np.array(points))[0])))
    return np.array(points)
