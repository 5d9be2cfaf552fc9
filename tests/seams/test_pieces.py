"""Pieces are named by falling area, whatever order they were found in."""

import numpy as np
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.creases import borders
from skinfab.seams.cut import open_pieces
from skinfab.seams.judge import Limits, judge
from skinfab.seams.pieces import to_pieces


def test_largest_first_then_by_first_face() -> None:
    mesh = Mesh(*shapes.grid(12, 1, lambda s, t: np.stack([12 * s, t, 0 * s], axis=1)))
    cell = np.arange(24) // 2
    label = np.select([cell < 2, cell < 7, cell < 9], [0, 1, 2], 3)  # 2, 5, 2 and 3 cells
    judged = [(p, judge(mesh, p, Limits())) for p in open_pieces(mesh, borders(mesh, label))]
    for order in (judged, judged[::-1]):
        pieces = to_pieces(mesh, order)
        assert [p.id for p in pieces] == ["P1", "P2", "P3", "P4"]
        assert [round(p.area) for p in pieces] == [5, 3, 2, 2]
        assert [int(p.faces[0]) for p in pieces] == [4, 18, 0, 14]
    piece = pieces[0]
    assert np.linalg.norm(piece.V(mesh)[piece.F[0, 0]] - piece.V(mesh)[piece.F[0, 1]]) > 0
    np.testing.assert_array_equal(piece.vertices[piece.F], mesh.F[piece.faces])
    assert piece.UV is judged[1][1].UV
