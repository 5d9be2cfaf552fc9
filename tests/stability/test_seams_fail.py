"""Where cutting fails: each test first shows the plain method fail, then what is done instead."""

import numpy as np
import pytest
import shapely
import shapes

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.seams.auto import find_seams
from skinfab.seams.cut import open_pieces
from skinfab.seams.disk import cut_to_disk
from skinfab.seams.graph import edge_graph, shortest_tree, trace
from skinfab.seams.judge import Limits
from skinfab.seams.refine import refine_seams
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import OVERLAP_FRACTION


def uncut(mesh: Mesh) -> np.ndarray:
    return np.zeros(len(mesh.topology.E), dtype=bool)


def accepted(mesh: Mesh, pieces) -> bool:
    covered = np.sort(np.concatenate([p.faces for p, _ in pieces]))
    return bool((covered == np.arange(len(mesh.F))).all()) and all(p.is_disk and v.accepted for p, v in pieces)


@pytest.mark.parametrize("mean", [4.001, 4.05])
def test_ramp_of_720_degrees(mean: float) -> None:
    """Distortion 4, no flip: all that was asked of a flattening, and half of it lies on the other half."""
    mesh = Mesh(*shapes.helicoid(2.0))
    flat = measure(mesh.V, mesh.F, flatten_isometric(mesh.V, mesh.F))
    assert flat.max < 4.001 and flat.flipped == 0
    assert flat.overlap_mm2 > 0.4 * mesh.area
    _, pieces = refine_seams(mesh, uncut(mesh), Limits(mean=mean), seam_weights(mesh))
    assert accepted(mesh, pieces) and len(pieces) <= 4
    assert sum(v.distortion.overlap_mm2 for _, v in pieces) <= OVERLAP_FRACTION * mesh.area


def test_nets_that_touch_themselves() -> None:
    """The dodecahedron's net closes its darts to points: no simple outline, but no overlap."""
    mesh = shapes.object_mesh("dodecahedron")
    ((net, verdict),) = find_seams(mesh, Limits()).pieces
    assert verdict.accepted and verdict.distortion.overlap_mm2 <= OVERLAP_FRACTION * mesh.area
    outline = verdict.UV[net.topology.boundary_loops[0]]
    assert shapely.Polygon(outline).area == pytest.approx(mesh.area, rel=1e-6)


def test_slit_of_one_edge_opens_nothing() -> None:
    tetrahedron = Mesh(np.eye(4)[:, :3], np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    topology = tetrahedron.topology
    distance, before = shortest_tree(edge_graph(topology, tetrahedron.edge_lengths, 4), np.array([0]))
    naive = uncut(tetrahedron)
    naive[topology.edge_ids(trace(before, int(np.argmax(distance))))] = True
    assert naive.sum() == 1 and not open_pieces(tetrahedron, naive)[0].is_disk
    assert len(cut_to_disk(topology, tetrahedron.edge_lengths, 4)) == 2
    seams = find_seams(tetrahedron, Limits(), neck=0.1)
    assert accepted(tetrahedron, seams.pieces) and seams.pieces[0][1].distortion.mean == pytest.approx(4, abs=1e-9)


def test_vertex_pairs_beyond_32_bits() -> None:
    """Above 46341 vertices u * n + v leaves 32 bits: edges come back as others."""
    V, F = shapes.grid(220, 220)
    F = F.astype(np.int32)
    n = np.int32(len(V))
    assert n > 46_341
    low, high = np.minimum(F[:, 0], F[:, 1]), np.maximum(F[:, 0], F[:, 1])
    naive = np.unique(low * n + high)
    assert (naive < 0).any() and not np.isin(naive // n, low).all()
    mesh = Mesh(V, F)
    assert mesh.topology.euler == 1 and np.isin(mesh.topology.E, F).all()
    across = mesh.topology.edge_ids(np.stack([np.arange(220) + 110 * 221, np.arange(220) + 110 * 221 + 1], axis=1))
    assert (across >= 0).all()
    cut = uncut(mesh)
    cut[across] = True
    halves = open_pieces(mesh, cut)
    assert [len(p.faces) for p in halves] == [len(F) // 2] * 2 and all(p.is_disk for p in halves)


def test_several_components_each_by_itself() -> None:
    V, F = shapes.sphere(2)
    W, G = shapes.wavy()
    mesh = Mesh(np.vstack([V, W + 5, V + 20]), np.vstack([F, G + len(V), F + len(V) + len(W)]))
    with pytest.raises(InputError, match="3 components"):
        flatten_isometric(mesh.V, mesh.F)
    seams = find_seams(mesh, Limits(), neck=0.1)
    assert accepted(mesh, seams.pieces) and len(seams.pieces) == 3


ODD = {
    "one triangle": (np.array([[0.0, 0, 0], [30, 0, 0], [0, 40, 9]]), np.array([[0, 1, 2]])),
    "strip without inner vertices": shapes.grid(30, 1, lambda s, t: 30 * np.stack([np.cos(5 * s), np.sin(5 * s) + t, s], axis=1)),
    "unused vertex": (np.vstack([shapes.wavy()[0], [9, 9, 9]]), shapes.wavy()[1]),
    "triangles without area": (lambda V, F: (np.where(np.arange(len(V))[:, None] == 60, V[61], V), F))(*shapes.wavy()),
    "touching at a corner": (
        np.vstack([shapes.wavy()[0], -shapes.wavy()[0][1:]]),
        np.vstack([shapes.wavy()[1], np.where(shapes.wavy()[1] == 0, 0, shapes.wavy()[1] + 168)]),
    ),
    "torn": (shapes.random_disk(2, 80, 0)[0], shapes.random_disk(2, 80, 0)[1][::3]),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_shapes(name: str) -> None:
    mesh = Mesh(*ODD[name])
    seams = find_seams(mesh, Limits(), neck=0.01)
    assert accepted(mesh, seams.pieces)
    assert len(seams.pieces) == mesh.topology.face_components()[0]


def moebius():
    N = 40
    i, s = np.repeat(np.arange(N), 3), np.tile([-0.3, 0, 0.3], N)
    t = 2 * np.pi * i / N
    V = np.stack([(1 + s * np.cos(t / 2)) * np.cos(t), (1 + s * np.cos(t / 2)) * np.sin(t), s * np.sin(t / 2)], axis=1)
    F = []
    for i in range(N):
        for k in range(2):
            a, b = 3 * i + k, 3 * i + k + 1
            c, d = (a + 3, b + 3) if i < N - 1 else (2 - k, 1 - k)
            F += [[a, c, d], [a, d, b]]
    return V, np.array(F)


def test_one_sided_strip_is_cut_where_its_sides_meet() -> None:
    """Cut anywhere else, a Moebius strip is a disk with half its faces the wrong way up."""
    mesh = Mesh(*moebius())
    assert mesh.topology.euler == 0
    naive = uncut(mesh)
    ring = mesh.topology.edge_ids(np.array([[60, 61], [61, 62]]))  # across, half way round
    naive[ring] = True
    (piece,) = open_pieces(mesh, naive)
    V = mesh.V[piece.vertices]
    half = measure(V, piece.F, tutte_embedding(V, piece.F)).flipped
    assert piece.topology.euler == 1 and 0.3 < half / len(mesh.F) < 0.7
    seams = find_seams(mesh, Limits(), neck=0.1)
    assert accepted(mesh, seams.pieces) and len(seams.pieces) == 1


def test_bounds_that_only_exact_nets_keep() -> None:
    """At d <= 4 + 1e-7 a sphere must fall into developable parts: it ends, and they are."""
    mesh = Mesh(*shapes.sphere(1))
    seams = find_seams(mesh, Limits(mean=4 + 1e-7), neck=0.1)
    assert accepted(mesh, seams.pieces) and max(v.distortion.mean for _, v in seams.pieces) <= 4 + 1e-7


def test_bounds_that_nothing_keeps_are_told() -> None:
    with pytest.raises(RefusedError, match="over the bound"):
        find_seams(Mesh(*shapes.sphere(1)), Limits(mean=3.9), neck=0.1)


def test_a_triangle_larger_than_the_bed_is_told() -> None:
    V, F = shapes.cube()
    with pytest.raises(RefusedError, match=r"does not fit the bed \(30 x 30 mm\); subdivide"):
        find_seams(Mesh(40 * V, F), Limits(size=(30, 30)))
    V, F = shapes.cube(4)
    fine = Mesh(40 * V, F)  # and subdivided it is done
    assert accepted(fine, find_seams(fine, Limits(size=(30, 30))).pieces)


def test_coordinates_that_are_no_numbers() -> None:
    V, F = shapes.wavy()
    V[60] = np.nan
    with pytest.raises(InputError, match="vertex 60 has a coordinate that is not a finite number"):
        find_seams(Mesh(V, F), Limits())


def sheets_at_one_edge():
    V, F = shapes.wavy()
    return np.vstack([V, [0.5, 0.5, 1.0]]), np.vstack([F, [60, 61, len(V)]])


def wound_both_ways():
    V, F = shapes.wavy()
    F[::2] = F[::2, ::-1]
    return V, F


def face_twice():
    V, F = shapes.wavy()
    return V, np.vstack([F, F[50:51]])


@pytest.mark.parametrize("surface", [sheets_at_one_edge, wound_both_ways, face_twice])
def test_what_is_no_surface_is_told(surface) -> None:
    mesh = Mesh(*surface())
    whole = open_pieces(mesh, uncut(mesh))[0]
    opened = cut_to_disk(whole.topology, np.ones(len(whole.topology.E)), len(whole.vertices))
    assert not whole.is_disk and len(Topology(whole.F).E[opened]) < len(whole.topology.E)  # tree and cotree have nothing left to cut
    with pytest.raises(InputError, match=r"no seam opens .* to a disk: edges are non-manifold or wound both ways; use --repair"):
        find_seams(mesh, Limits())
