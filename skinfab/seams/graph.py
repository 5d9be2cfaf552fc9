"""Shortest paths over a mesh's edges and over its faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def edge_graph(topology: Topology, weight: FloatArray, n_vertices: int) -> csr_array:
    """Vertices joined by edges, both ways, (n, n)."""
    i, j = topology.E.T
    return csr_array(coo_array((np.r_[weight, weight], (np.r_[i, j], np.r_[j, i])), shape=(n_vertices, n_vertices)))


def shortest_tree(graph: csr_array, sources: IntArray) -> tuple[FloatArray, IntArray]:
    """Distance to the nearest source and the vertex before each on the way there (negative at a source)."""
    distance, before, _ = dijkstra(graph, indices=np.atleast_1d(sources), min_only=True, return_predecessors=True)
    return distance, before.astype(np.int64)


def trace(before: IntArray, vertex: int) -> IntArray:
    """Vertex pairs from `vertex` back to its source, (k, 2)."""
    pairs = []
    while before[vertex] >= 0:
        pairs.append((vertex, before[vertex]))
        vertex = int(before[vertex])
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def face_graph(topology: Topology, weight: FloatArray) -> csr_array:
    """Faces joined across interior edges, both ways, (m, m)."""
    inner = np.flatnonzero(topology.EF[:, 1] >= 0)
    f, g = topology.EF[inner].T
    w = weight[inner]
    return csr_array(coo_array((np.r_[w, w], (np.r_[f, g], np.r_[g, f])), shape=(len(topology.F), len(topology.F))))
