"""Edges, loops and Euler numbers against counting by hand."""

from collections import Counter

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.mesh.topology import Topology, _order_of_pairs

few = settings(max_examples=25, deadline=None)


@pytest.mark.parametrize(
    ("mesh", "euler", "loops"),
    [
        (shapes.wavy(), 1, 1),
        (shapes.sphere(), 2, 0),
        (shapes.torus(), 0, 0),
        (shapes.holed(holes=((5, 5),)), 0, 2),
        (shapes.holed(), -1, 3),
        (shapes.cap(), 1, 1),
        (shapes.cube(3), 2, 0),
    ],
    ids=["disk", "sphere", "torus", "ring", "two holes", "cap", "cube"],
)
def test_euler_number_and_loops(mesh, euler: int, loops: int) -> None:
    topology = Topology(mesh[1])
    assert (topology.euler, len(topology.boundary_loops)) == (euler, loops)


@few
@given(st.integers(0, 10_000))
def test_tables_agree_with_a_count(seed: int) -> None:
    _, F = shapes.random_disk(seed, 40)
    rng = np.random.default_rng(seed)
    F = F[rng.random(len(F)) < 0.8]  # torn: holes, touching corners, several parts
    topology = Topology(F)
    count = Counter(frozenset((int(f[k]), int(f[(k + 1) % 3]))) for f in F for k in range(3))
    assert {frozenset(e): c for e, c in zip(topology.E.tolist(), topology.edge_count.tolist(), strict=True)} == count
    assert (topology.E[:, 0] < topology.E[:, 1]).all()
    for k in range(3):
        np.testing.assert_array_equal(topology.E[topology.FE[:, k]], np.sort(np.stack([F[:, k], F[:, (k + 1) % 3]], axis=1), axis=1))
    for side in (0, 1):
        e = np.flatnonzero(topology.EF[:, side] >= 0)
        np.testing.assert_array_equal(topology.FE[topology.EF[e, side], topology.EC[e, side]], e)
    assert ((topology.EF >= 0).sum(axis=1) == np.minimum(topology.edge_count, 2)).all()
    assert (topology.EF[:, 0] != topology.EF[:, 1]).all()
    assert topology.euler == len(np.unique(F)) - len(count) + len(F)
    # Every boundary edge is in just one loop, walked as its face runs.
    half = {(int(f[k]), int(f[(k + 1) % 3])) for f in F for k in range(3)}
    walked = [(int(a), int(b)) for loop in topology.boundary_loops for a, b in zip(loop, np.roll(loop, -1), strict=True)]
    assert len(walked) == len(set(walked)) == topology.is_boundary.sum()
    assert set(walked) <= half and {frozenset(e) for e in walked} == {e for e, c in count.items() if c == 1}


@few
@given(st.integers(0, 10_000))
def test_edge_ids_find_edges_and_nothing_else(seed: int) -> None:
    _, F = shapes.random_disk(seed, 20)
    topology = Topology(F)
    pairs = np.random.default_rng(seed).integers(-3, 25, (200, 2))
    place = {frozenset(e): k for k, e in enumerate(topology.E.tolist())}
    assert topology.edge_ids(pairs).tolist() == [place.get(frozenset(p), -1) for p in pairs.tolist()]
    assert topology.edge_ids(topology.E[:, ::-1]).tolist() == list(range(len(topology.E)))


def test_loops_that_touch_keep_to_their_fans() -> None:
    bow_tie = Topology(np.array([[0, 1, 2], [0, 3, 4]]))
    assert sorted(set(loop.tolist()) for loop in bow_tie.boundary_loops) == [{0, 1, 2}, {0, 3, 4}]
    assert (bow_tie.euler, bow_tie.face_components()[0]) == (1, 2)
    # Two holes that touch at a corner: one walk goes round both, as the one fan between them does.
    _, F = shapes.holed(6, holes=((2, 2), (3, 3)))
    assert sorted(len(loop) for loop in Topology(F).boundary_loops) == [8, 24]


def test_longest_loop_comes_first() -> None:
    _, F = shapes.holed(8, holes=((3, 3), (4, 3)))
    assert [len(loop) for loop in Topology(F).boundary_loops] == [32, 6]


def test_nonmanifold_edges_are_counted() -> None:
    book = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]])
    topology = Topology(book)
    spine = topology.edge_ids(np.array([[0, 1]]))[0]
    assert topology.edge_count[spine] == 4 and topology.is_nonmanifold.sum() == 1
    assert topology.EF[spine].tolist() == [0, 1]
    assert len(topology.boundary_loops) >= 1


def test_vertex_pairs_beyond_32_bits() -> None:
    """0 and 32768 times 131072 vertices are the same number in 32 bits."""
    n = 131_072
    F = np.array([[0, 5, n - 1], [32_768, 6, n - 1]], dtype=np.int32)
    low, high = F[:, 0], F[:, 2]
    naive = low * np.int32(n) + high
    assert naive[0] == naive[1]
    topology = Topology(F)
    assert len(topology.E) == 6 and topology.is_boundary.all()
    assert (topology.edge_ids(np.array([[0, n - 1], [n - 1, 32_768]])) >= 0).all()
    assert topology.edge_ids(np.array([[5, 6]]))[0] == -1


def test_faces_are_grouped_across_edges_that_are_not_cut() -> None:
    V, F = shapes.grid(4, 4)
    topology = Topology(np.vstack([F, F + len(V)]))
    count, label = topology.face_components()
    assert count == 2 and (label == np.repeat(label[[0, -1]], len(F))).all()
    assert topology.face_components(np.ones(len(topology.E), dtype=bool))[0] == 2 * len(F)
    across = np.isclose(V[topology.E % len(V)][:, :, 0], 0.5).all(axis=1)  # down the middle of both
    assert topology.face_components(across)[0] == 4


def test_no_faces() -> None:
    topology = Topology(np.zeros((0, 3), dtype=np.int64))
    assert (len(topology.E), topology.euler, topology.boundary_loops) == (0, 0, [])
    assert topology.edge_ids(np.array([[0, 1]])).tolist() == [-1]
    assert topology.face_components()[0] == 0


def test_many_faces_are_ordered_as_few_are() -> None:
    """Numbers of many sizes are sorted; the tables must not show how."""
    _, F = shapes.random_disk(5, 900)
    rng = np.random.default_rng(5)
    F = rng.permutation(F[rng.random(len(F)) < 0.9])
    assert 3 * len(F) > 4096
    topology = Topology(F)
    half = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    E, first, inverse, count = np.unique(half, axis=0, return_index=True, return_inverse=True, return_counts=True)
    np.testing.assert_array_equal(topology.E, E)
    np.testing.assert_array_equal(topology.edge_count, count)
    np.testing.assert_array_equal(topology.FE, inverse.reshape(3, -1).T)
    np.testing.assert_array_equal(topology.EF[:, 0], first % len(F))
    np.testing.assert_array_equal(topology.EC[:, 0], first // len(F))
    # A vertex number that is none, as in a mesh not yet looked over, is no shift.
    assert len(Topology(np.where(F == 7, -1, F)).E) == len(E)


def test_oriented_manifold() -> None:
    for V, F in (shapes.wavy(), shapes.sphere(), shapes.torus(), shapes.holed(), shapes.cube(3)):
        assert Topology(F).is_oriented_manifold
        again = np.random.default_rng(1).permutation(F)
        assert Topology(again).is_oriented_manifold
        assert not Topology(np.vstack([F, [[0, len(V), len(V) + 1]]])).is_oriented_manifold  # a second fan at vertex 0
        assert not Topology(np.vstack([F, [F[3]]])).is_oriented_manifold  # a face twice
        assert not Topology(np.vstack([F[:5, ::-1], F[5:]])).is_oriented_manifold  # some wound the other way


@pytest.mark.parametrize(
    "F",
    [
        [[0, 1, 2], [2, 1, 0]],  # both sides of one triangle
        [[0, 1, 1], [0, 1, 2]],
        [[0, 1, 2], [1, 0, 3], [0, 1, 4]],
        [[0, 1, 2], [0, 3, 4]],
        # Two tetrahedra that touch at vertex 0: no edge shows it.
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 5, 4], [0, 4, 6], [4, 5, 6], [5, 0, 6]],
        np.zeros((0, 3), dtype=np.int64),
    ],
    ids=["flap", "corner twice", "fin", "bow-tie", "tips", "nothing"],
)
def test_not_an_oriented_manifold(F) -> None:
    assert not Topology(np.array(F)).is_oriented_manifold


@pytest.mark.parametrize("step", [1, 2**20, 2**40])
def test_pairs_too_large_for_one_number_are_sorted_in_parts(step: int) -> None:
    """Three numbers share 63 bits: here they need up to 130."""
    rng = np.random.default_rng(1)
    low, high = rng.integers(0, 50, (2, 3000), dtype=np.int64) * step
    np.testing.assert_array_equal(_order_of_pairs(low, high), np.lexsort((high, low)))
