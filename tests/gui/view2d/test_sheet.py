"""The pieces as arrays: nothing is lost, and both sides of a seam are known by one label."""

from dataclasses import replace

import numpy as np
import pytest

from gui.state.derived import Derived
from gui.view2d.sheet import Sheet


def test_faces_and_places_are_those_of_the_pieces(skin):
    sheet = Sheet(skin, Derived())
    assert sorted(sheet.face.tolist()) == list(range(len(skin.mesh.F)))
    for k, piece in enumerate(skin.pieces):
        mine = sheet.owner == k
        assert np.array_equal(sheet.UV[sheet.F[mine]] - sheet.offset_of(piece.id), piece.UV[piece.F])
    low, high = sheet.box
    assert (low <= sheet.UV).all() and (sheet.UV <= high).all() and sheet.index("P2") == 1 and sheet.index("P9") == -1


def test_a_seam_has_two_sides_with_one_label_and_the_border_none(skin):
    sheet = Sheet(skin, Derived())
    topology = skin.mesh.topology
    seam = int(topology.edge_ids(skin.seams[3:4])[0])
    one, two = sheet.seam_lines(seam)
    assert sheet.seam_label(seam) == "1" and len(one) == len(two) == 13
    assert np.allclose(one - sheet.offset[0], [[60.0, 5 * k] for k in range(13)]) and (two[:, 0] == sheet.offset[1, 0]).all()
    border = int(np.flatnonzero(topology.is_boundary)[0])
    assert sheet.seam_label(border) == "" and sheet.seam_lines(border) == []


def test_the_nearest_edge_is_found_from_either_side(skin):
    sheet = Sheet(skin, Derived())
    k, apart = sheet.nearest_edge(np.array([58.5, 22.0]) + sheet.offset_of("P1"))
    assert apart == pytest.approx(1.5) and sorted(skin.mesh.V[skin.mesh.topology.E[sheet.edges.mesh[k]]][:, 1].tolist()) == [20.0, 25.0]


def test_without_pieces_there_is_nothing(skin):
    sheet = Sheet(replace(skin, pieces=(), sensors=()), Derived())
    assert sheet.UV.shape == (0, 2) and sheet.F.shape == (0, 3) and sheet.nearest_edge(np.zeros(2)) == (-1, np.inf)
