"""Opening along seams: every vertex in as many copies as there are fans, every seam on two sides."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.mesh.model import Mesh
from skinfab.seams.creases import borders
from skinfab.seams.cut import mesh_edges, open_pieces, seam_length

few = settings(max_examples=30, deadline=None)
seeds = st.integers(0, 10_000)
SURFACES = {
    "disk": shapes.wavy(6),
    "sphere": shapes.sphere(1),
    "torus": shapes.torus(columns=8, rows=6),
    "holes": shapes.holed(6, ((1, 1), (4, 4))),
}
surfaces = st.sampled_from(sorted(SURFACES)).map(lambda name: Mesh(*SURFACES[name]))


def fans(mesh: Mesh, cut: np.ndarray) -> int:
    """Groups of faces about each vertex that hang together across edges at that vertex, counted one by one."""
    total, topology = 0, mesh.topology
    for v in range(len(mesh.V)):
        around = set(np.flatnonzero((mesh.F == v).any(axis=1)).tolist())
        spokes = [e for e in np.flatnonzero((topology.E == v).any(axis=1)) if not cut[e] and topology.EF[e, 1] >= 0]
        while around:
            total += 1
            fan = {around.pop()}
            while True:
                more = {f for e in spokes for f in topology.EF[e].tolist() if f in around and fan & set(topology.EF[e].tolist())}
                if not more:
                    break
                fan |= more
                around -= more
    return total


@few
@given(surfaces, seeds, st.floats(0, 1))
def test_any_cut_opens_every_vertex_into_its_fans(mesh: Mesh, seed: int, share: float) -> None:
    cut = np.random.default_rng(seed).random(len(mesh.topology.E)) < share
    pieces = open_pieces(mesh, cut)
    assert sum(len(p.vertices) for p in pieces) == fans(mesh, cut)
    assert len(pieces) == mesh.topology.face_components(cut)[0]
    assert sorted(np.concatenate([p.faces for p in pieces]).tolist()) == list(range(len(mesh.F)))
    assert [int(p.faces[0]) for p in pieces] == sorted(int(p.faces.min()) for p in pieces)
    for p in pieces:
        np.testing.assert_array_equal(p.vertices[p.F], mesh.F[p.faces])
        assert len(p.topology.used_vertices) == len(p.vertices)


@few
@given(surfaces, seeds, st.integers(1, 6))
def test_seams_are_on_two_sides_and_euler_numbers_add_up(mesh: Mesh, seed: int, labels: int) -> None:
    label = np.random.default_rng(seed).integers(0, labels, len(mesh.F))
    cut = borders(mesh, label)
    pieces = open_pieces(mesh, cut)
    sides = np.concatenate([mesh_edges(mesh, p, np.flatnonzero(p.topology.is_boundary)) for p in pieces])
    times = np.bincount(sides, minlength=len(cut))
    np.testing.assert_array_equal(times, 2 * cut + mesh.topology.is_boundary)
    around = sum(Mesh(mesh.V[p.vertices], p.F).edge_lengths[p.topology.is_boundary].sum() for p in pieces)
    rim = mesh.edge_lengths[mesh.topology.is_boundary].sum()
    assert around == pytest.approx(2 * seam_length(mesh, cut) + rim)
    # Opened: as many faces, every cut edge twice, every vertex once a fan.
    assert sum(p.topology.euler for p in pieces) == fans(mesh, cut) - (len(mesh.topology.E) + cut.sum()) + len(mesh.F)


@pytest.mark.parametrize("name", SURFACES)
def test_all_or_nothing(name: str) -> None:
    V, F = SURFACES[name]
    mesh = Mesh(np.vstack([V, V + 9]), np.vstack([F, F + len(V)]))
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    whole = open_pieces(mesh, none)
    assert [len(p.faces) for p in whole] == [len(F), len(F)]
    assert sum(p.topology.euler for p in whole) == mesh.topology.euler
    assert [p.is_disk for p in whole] == [name == "disk"] * 2
    single = open_pieces(mesh, ~none)
    assert len(single) == len(mesh.F) and all(len(p.vertices) == 3 and p.is_disk for p in single)


@few
@given(surfaces, seeds)
def test_some_faces_as_if_the_rest_were_not_there(mesh: Mesh, seed: int) -> None:
    rng = np.random.default_rng(seed)
    faces = np.flatnonzero(rng.random(len(mesh.F)) < 0.6)
    if not len(faces):
        return
    cut = rng.random(len(mesh.topology.E)) < 0.2
    alone = Mesh(mesh.V, mesh.F[faces])
    cut_alone = np.zeros(len(alone.topology.E), dtype=bool)
    cut_alone[alone.topology.FE] = cut[mesh.topology.FE[faces]]
    got, want = open_pieces(mesh, cut, faces=rng.permutation(faces)), open_pieces(alone, cut_alone)
    assert [p.faces.tolist() for p in got] == [faces[p.faces].tolist() for p in want]
    assert [p.F.tolist() for p in got] == [p.F.tolist() for p in want]


@few
@given(surfaces, seeds)
def test_faces_wound_the_other_way_hang_together_all_the_same(mesh: Mesh, seed: int) -> None:
    rng = np.random.default_rng(seed)
    F = mesh.F.copy()
    turned = rng.random(len(F)) < 0.5
    F[turned] = F[turned, ::-1]
    mixed = Mesh(mesh.V, F)
    none = np.zeros(len(mixed.topology.E), dtype=bool)
    assert len(open_pieces(mixed, none)[0].vertices) == len(mesh.V)


def test_seams_inside_a_surface() -> None:
    V, F = shapes.grid(4, 4)
    mesh = Mesh(V, F)

    def opened(*vertices: int) -> tuple[int, int]:
        cut = np.zeros(len(mesh.topology.E), dtype=bool)
        cut[mesh.topology.edge_ids(np.stack([vertices[:-1], vertices[1:]], axis=1))] = True
        (piece,) = open_pieces(mesh, cut)
        return len(piece.vertices) - len(V), len(piece.topology.boundary_loops)

    assert opened(12, 13) == (0, 2 - 1)  # one inner edge opens nothing
    assert opened(11, 12, 13) == (1, 2)  # two make a slit
    assert opened(10, 11, 12) == (2, 1)  # from the boundary: a dart, a vertex more for each that is not its tip
    assert seam_length(mesh, mesh.topology.is_boundary) == 0


@pytest.mark.parametrize("name", sorted(SURFACES))
def test_nothing_to_open_gives_what_opening_would(name: str) -> None:
    V, F = SURFACES[name]
    F = np.random.default_rng(4).permutation(F)
    mesh = Mesh(np.vstack([V, [[9.0, 9.0, 9.0]]]), F)  # one vertex that no face uses
    (quick,) = open_pieces(mesh, mesh.topology.is_boundary)
    (general,) = open_pieces(mesh, mesh.topology.is_boundary, faces=np.arange(len(F)))
    np.testing.assert_array_equal(quick.faces, general.faces)
    np.testing.assert_array_equal(quick.vertices[quick.F], general.vertices[general.F])
    assert len(quick.vertices) == len(general.vertices) == len(V)
    # Without such a vertex the mesh's own tables do.
    whole = Mesh(V, F)
    (piece,) = open_pieces(whole, whole.topology.is_boundary)
    assert piece.topology is whole.topology and np.array_equal(piece.topology.F, piece.F)
