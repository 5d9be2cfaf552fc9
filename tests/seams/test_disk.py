"""Any genus, any number of holes: one disk, by a seam not much longer than it must be."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.seams.disk import cut_to_disk


def opened(mesh: Mesh, edges: np.ndarray) -> list[OpenPiece]:
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[edges] = True
    return open_pieces(mesh, cut)


def double_torus():
    """Two tori joined where each lost a triangle."""
    V, F = shapes.torus(columns=10, rows=6)
    (a, b, c), n = F[0], len(V)
    G = F[1:] + n
    for mine, others in ((a, a), (b, c), (c, b)):
        G[G == mine + n] = others
    used, H = np.unique(np.vstack([F[1:], G]), return_inverse=True)
    return np.vstack([V, V * [1, 1, -1] + [9, 0, 0]])[used], H.reshape(-1, 3)


SURFACES = {
    "sphere": (shapes.sphere(2), 2),
    "torus": (shapes.torus(columns=12, rows=8), 0),
    "double torus": (double_torus(), -2),
    "two holes": (shapes.holed(), -1),
    "touching holes": (shapes.holed(holes=((5, 5), (6, 6))), None),
    "tetrahedron": ((np.eye(4)[:, :3], np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])), 2),
    "disk": (shapes.wavy(), 1),
}


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(SURFACES)), st.integers(0, 10_000), st.booleans())
def test_becomes_one_disk_whatever_the_weights(name: str, seed: int, uneven: bool) -> None:
    (V, F), euler = SURFACES[name]
    V, F, _ = shapes.relabelled(V, F, seed)
    whole = open_pieces(Mesh(V, F), np.zeros(len(Mesh(V, F).topology.E), dtype=bool))[0]  # a corner where holes touch becomes two
    mesh = Mesh(V[whole.vertices], whole.F)
    assert euler is None or mesh.topology.euler == euler
    rng = np.random.default_rng(seed)
    weight = 10 ** rng.uniform(-3, 3, len(mesh.topology.E)) if uneven else mesh.edge_lengths
    cut = cut_to_disk(mesh.topology, weight, len(mesh.V))
    pieces = opened(mesh, cut)
    assert len(pieces) == 1 and pieces[0].is_disk
    if "torus" in name:  # closed, with handles: a dead end would open nothing
        ends = np.bincount(mesh.topology.E[cut].ravel())
        assert ends[ends > 0].min() >= 2


def test_disks_are_left_whole() -> None:
    mesh = Mesh(*shapes.wavy())
    assert len(cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))) == 0


@pytest.mark.parametrize(("major", "minor", "columns", "rows"), [(3.0, 1.0, 36, 16), (3.0, 0.5, 60, 12), (2.0, 1.0, 30, 20)])
def test_torus_is_cut_by_little_more_than_its_generators(major: float, minor: float, columns: int, rows: int) -> None:
    mesh = Mesh(*shapes.torus(major, minor, columns, rows))
    cut = cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))
    length = mesh.edge_lengths[cut].sum()
    assert length <= 1.3 * 2 * np.pi * (major - minor + minor)
    # No dead end: every vertex of the seam is on a way through.
    assert np.bincount(mesh.topology.E[cut].ravel())[np.unique(mesh.topology.E[cut])].min() >= 2


def test_holes_are_joined_to_the_border_by_the_shortest_way() -> None:
    for holes, shortest in ((((5, 5),), 5), (((3, 3), (8, 8)), 6), (((2, 5), (4, 5)), 3)):
        mesh = Mesh(*shapes.holed(holes=holes))
        cut = cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))
        assert mesh.edge_lengths[cut].sum() == pytest.approx(shortest)


def test_sphere_is_slit_from_pole_to_pole() -> None:
    mesh = Mesh(*shapes.sphere(3))
    cut = cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))
    assert 0.9 * np.pi < mesh.edge_lengths[cut].sum() < 1.15 * np.pi


def test_grows_from_where_it_is_told() -> None:
    mesh = Mesh(*shapes.torus())
    for start in (0, 100, 333):
        cut = cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V), start=start)
        assert opened(mesh, cut)[0].is_disk
    ball = Mesh(*shapes.sphere())
    assert 50 in ball.topology.E[cut_to_disk(ball.topology, ball.edge_lengths, len(ball.V), start=50)]


@pytest.mark.parametrize("seed", range(8))
def test_far_points_joined_by_one_edge(seed: int) -> None:
    """On six random points the two farthest often share an edge; a slit of one edge opens nothing."""
    from scipy.spatial import ConvexHull

    V = np.random.default_rng(seed).standard_normal((6, 3)) * [1, 1, 8]
    F = ConvexHull(V).simplices.astype(np.int64)
    outward = np.einsum("ij,ij->i", Mesh(V, F).face_cross, V[F].mean(axis=1) - V.mean(axis=0)) > 0
    F[~outward] = F[~outward][:, ::-1]
    used, F = np.unique(F, return_inverse=True)
    mesh = Mesh(V[used], F.reshape(-1, 3))
    cut = cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))
    assert len(cut) >= 2 and opened(mesh, cut)[0].is_disk
