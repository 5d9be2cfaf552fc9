"""Shortest paths over edges and faces against a plain Bellman-Ford."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.topology import Topology
from skinfab.seams.graph import edge_graph, face_graph, shortest_tree, trace


@pytest.mark.parametrize("seed", range(4))
def test_shortest_tree_and_its_paths(seed: int) -> None:
    V, F = shapes.random_disk(seed, 30)
    topology = Topology(F)
    weight = np.random.default_rng(seed).uniform(0.1, 1, len(topology.E))
    sources = np.array([3, 17])
    want = np.full(len(V), np.inf)
    want[sources] = 0
    for _ in V:
        for (i, j), w in zip(topology.E.tolist(), weight, strict=True):
            want[i], want[j] = min(want[i], want[j] + w), min(want[j], want[i] + w)
    distance, before = shortest_tree(edge_graph(topology, weight, len(V)), sources)
    np.testing.assert_allclose(distance, want)
    for v in range(len(V)):
        path = trace(before, v)
        assert weight[topology.edge_ids(path)].sum() == pytest.approx(want[v])
        assert (path[-1, 1] in sources) if v not in sources else len(path) == 0


def test_faces_are_joined_across_inner_edges_only() -> None:
    _, F = shapes.grid(3, 1)
    topology = Topology(F)
    graph = face_graph(topology, np.arange(len(topology.E)) + 1.0)
    inner = np.flatnonzero(~topology.is_boundary)
    assert graph.nnz == 2 * len(inner) == 10
    for e in inner:
        f, g = topology.EF[e]
        assert graph[f, g] == graph[g, f] == e + 1
