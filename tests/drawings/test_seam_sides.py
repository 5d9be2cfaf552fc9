"""Both sides of a seam carry the same number and notch the same point of the object."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from numpy.typing import NDArray

from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.pieces import Piece
from skinfab.skin import Skin


def on_object(skin: Skin, side: SeamSide, point: NDArray[np.float64]) -> NDArray[np.float64]:
    """A point of the flat outline, taken back to the object along its outline edge."""
    piece = skin.pieces[side.piece]
    loop = piece.topology.boundary_loops[0]
    for a, b in zip(loop, np.roll(loop, -1), strict=True):
        along = piece.UV[b] - piece.UV[a]
        t = (point - piece.UV[a]) @ along / (along @ along)
        if 0 <= t <= 1 and np.allclose(piece.UV[a] + t * along, point, atol=1e-9):
            va, vb = skin.mesh.V[piece.vertices[[a, b]]]
            return va + t * (vb - va)
    raise AssertionError("the point is not on the outline")


def test_cube_of_two_pieces(skin: Skin) -> None:
    sides = seam_sides(skin.pieces)
    # Four upright edges are darts of the cross; the lid's four edges meet its four arms.
    assert Counter((s.piece, s.kind) for s in sides) == {(0, "dart"): 8, (0, "seam"): 4, (1, "seam"): 4}
    assert Counter(s.label for s in sides) == {str(k): 2 for k in range(1, 9)}
    for label in {s.label for s in sides}:
        one, two = (s for s in sides if s.label == label)
        np.testing.assert_allclose(on_object(skin, one, one.notch), on_object(skin, two, two.notch), atol=1e-9)
        lengths = [np.hypot(*np.diff(s.points, axis=0).T).sum() for s in (one, two)]
        assert lengths == pytest.approx([45, 45])


def test_sides_cover_the_outline_in_order(skin: Skin) -> None:
    for k, piece in enumerate(skin.pieces):
        mine = [s for s in seam_sides(skin.pieces) if s.piece == k]
        walked = np.vstack([s.points[:-1] for s in mine])
        first = int(np.flatnonzero((piece.outline == walked[0]).all(axis=1))[0])
        np.testing.assert_array_equal(walked, np.roll(piece.outline, -first, axis=0))


def test_notches_point_into_the_piece(skin: Skin) -> None:
    import shapely

    for side in seam_sides(skin.pieces):
        outline = shapely.Polygon(skin.pieces[side.piece].outline)
        assert outline.contains(shapely.Point(side.notch + 0.01 * side.inward))
        assert not outline.contains(shapely.Point(side.notch - 0.01 * side.inward))


def test_two_disks_sewn_all_round_are_one_seam() -> None:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    UV = np.vstack([[0, 0], np.c_[np.cos(angle), np.sin(angle)]]) * 20
    F = np.array([[0, k + 1, (k + 1) % 12 + 1] for k in range(12)])
    back = np.arange(13)
    back[0], back[1:] = 13, np.roll(np.arange(12, 0, -1), 5)
    one = Piece("P1", np.arange(12), np.arange(13), F, UV - UV.min(axis=0))
    two = Piece("P2", np.arange(12, 24), back, F, UV - UV.min(axis=0))
    sides = seam_sides([one, two])
    assert [(s.label, s.kind, len(s.points)) for s in sides] == [("1", "seam", 13), ("1", "seam", 13)]


def test_open_object_has_a_border_without_a_number() -> None:
    plate = Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0.0, 0], [4, 0], [4, 3], [0, 3]]))
    (side,) = seam_sides([plate])
    assert side.kind == "border" and side.label == "" and len(side.points) == 5
