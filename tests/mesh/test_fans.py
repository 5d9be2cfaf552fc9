"""Fans, windings and pairings on small meshes one can draw."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from skinfab.mesh.fans import bowties, components, corner_fans, surplus_faces, unbalanced_edges, winding
from skinfab.mesh.topology import Topology

SQUARE = np.array([[0, 1, 2], [0, 2, 3]])
FIN = np.array([[0, 1, 2], [0, 2, 3], [0, 2, 4]])
TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_a_fin_is_one_component_and_no_bowtie() -> None:
    top = Topology(FIN)
    assert components(top)[0] == 1
    assert not bowties(top, 5).any()
    assert top.E[unbalanced_edges(top, np.zeros(3, bool))].tolist() == [[0, 2]]


def test_bowtie() -> None:
    top = Topology(np.array([[0, 1, 2], [0, 3, 4]]))
    assert components(top)[0] == 2
    assert bowties(top, 5).tolist() == [True, False, False, False, False]
    assert corner_fans(top)[0] == 6


@given(st.lists(st.booleans(), min_size=4, max_size=4))
def test_winding_mends_any_turned_faces(turned: list[bool]) -> None:
    F = np.where(np.array(turned)[:, None], TETRAHEDRON[:, ::-1], TETRAHEDRON)
    found = winding(Topology(F))
    assert not found.one_sided.any()
    assert found.turn.sum() == min(sum(turned), 4 - sum(turned))
    mended = np.where(found.turn[:, None], F[:, ::-1], F)
    assert not winding(Topology(mended)).turn.any()
    assert not bowties(Topology(F), 4).any()  # whichever way the faces are wound


def test_surplus_faces() -> None:
    again = np.array([[1, 2, 0]])
    assert surplus_faces(np.vstack([SQUARE, again])).tolist() == [False, False, True]
    assert surplus_faces(np.vstack([SQUARE, again[:, ::-1]])).tolist() == [False, False, True]
    # A flap of no thickness on a closed surface: both its faces go.
    flap = np.array([[0, 1, 4], [1, 0, 4]])
    assert surplus_faces(np.vstack([TETRAHEDRON, flap])).tolist() == [False] * 4 + [True] * 2
