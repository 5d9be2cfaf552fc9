"""Ways for darts: from the boundary, the cheapest, to spots far from each other."""

import numpy as np
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.graph import edge_graph, shortest_tree
from skinfab.seams.outlook import dart_ways
from skinfab.seams.sheet import Sheet, Surface, lay_out, sheet_of
from skinfab.seams.weights import seam_weights


def sheet(mesh: Mesh, cut: np.ndarray | None = None) -> Sheet:
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    opened = sheet_of(Surface(mesh, seam_weights(mesh), none), none if cut is None else cut)
    assert opened is not None
    return lay_out(opened)


def test_the_cheapest_ways_from_the_boundary() -> None:
    mesh = Mesh(*shapes.random_disk(1, count=200))
    flat = sheet(mesh)
    ways = dart_ways(flat, count=8, apart=0.1)
    distance, _ = shortest_tree(edge_graph(mesh.topology, flat.surface.weight, len(mesh.V)), flat.origin[flat.loop])
    assert len(ways) == 8
    for way in ways:
        assert way.vertices[0] in flat.loop and not np.isin(way.vertices[1:], flat.loop).any()
        path = flat.origin[way.vertices]
        np.testing.assert_array_equal(mesh.topology.E[way.edges], np.sort(np.stack([path[:-1], path[1:]], axis=1), axis=1))
        np.testing.assert_allclose(flat.surface.weight[way.edges].sum(), distance[path[-1]])
    tips = mesh.V[flat.origin[[way.vertices[-1] for way in ways]]]
    gaps = np.linalg.norm(tips[:, None] - tips[None], axis=2)[~np.eye(len(tips), dtype=bool)]
    assert gaps.min() >= 0.1


def test_ways_begin_on_the_side_of_a_seam_that_they_leave() -> None:
    """At a seam a vertex of the surface is two of the sheet: each way's first edge is one of its own faces'."""
    mesh = Mesh(*shapes.cap(12))
    way = dart_ways(sheet(mesh), count=1, apart=0.1)[0]
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[way.edges] = True
    opened = sheet(mesh, cut)
    from_seam = [w for w in dart_ways(opened, count=40, apart=0.05) if opened.origin[w.vertices[0]] in mesh.topology.E[cut]]
    assert from_seam
    for w in from_seam:
        assert (opened.F[opened.EF[w.edges[0]]] == w.vertices[0]).any(axis=1).all()


def test_no_way_where_all_is_boundary() -> None:
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    assert dart_ways(sheet(mesh), count=3, apart=0.1) == []
