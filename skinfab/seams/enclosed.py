"""Pieces that a person's locked seams part off all round, and that are too small to handle: nothing but a sentence can be done."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.seams.naming import named_edges
from skinfab.seams.rules import edge_mask
from skinfab.skin import Skin


def enclosed_pieces(mesh: Mesh, pieces: Sequence[Piece], locked: NDArray[np.bool_], width: float) -> list[Piece]:
    """Pieces narrower than `width` (mm) whose whole border is locked: no search may join them to what lies about them.

    Parameters
    ----------
    mesh : Mesh
    pieces : sequence of Piece
    locked : (e,) bool
        Per edge of the mesh.
    width : float, mm
    """
    narrow = [(piece, _border(mesh, piece)) for piece in pieces if min(piece.size) < width]
    return [piece for piece, border in narrow if len(border) and locked[border].all()]


def enclosed_text(mesh: Mesh, pieces: Sequence[Piece], locked: NDArray[np.bool_], width: float) -> list[tuple[str, Piece]]:
    """A sentence about the first of `enclosed_pieces`, and which it is; none where there are none.

    Examples
    --------
    >>> from skinfab.seams.cut import open_pieces
    >>> square = Mesh(np.array([[0.0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> locked = square.topology.edge_ids(np.array([[0, 2]])) == np.arange(5)
    >>> flat = [Piece(f"P{k}", p.faces, p.vertices, p.F, square.V[p.vertices, :2]) for k, p in enumerate(open_pieces(square, locked), 1)]
    >>> [(text, piece)] = enclosed_text(square, flat, locked, 4.0)
    >>> for part in text.split(" and parted off "):
    ...     print(part)
    P1 (1 triangle, 3.0 x 3.0 mm) and 1 more are narrower than the 4 mm that survive handling
    all round by locked seams (P1: 0-2); unlock some of them
    """
    small = enclosed_pieces(mesh, pieces, locked, width)
    if not small:
        return []
    first, others = small[0], len(small) - 1
    count = f"{len(first.faces)} triangle" + ("" if len(first.faces) == 1 else "s")
    who = f"{first.id} ({count}, {first.size[0]:.1f} x {first.size[1]:.1f} mm)"
    along = named_edges(mesh, _border(mesh, first))
    who, along = (f"{who} and {others} more are", f"{first.id}: {along}") if others else (f"{who} is", along)
    why = f"narrower than the {width:g} mm that survive handling and parted off all round by locked seams ({along})"
    return [(f"{who} {why}; unlock some of them", first)]


def enclosed_words(skin: Skin, width: float) -> list[str]:
    """As `enclosed_text`, of the pieces and the locked seams of a document."""
    if skin.marks is None:
        return []
    return [text for text, _ in enclosed_text(skin.mesh, skin.pieces, edge_mask(skin.mesh, skin.marks.locked), width)]


def _border(mesh: Mesh, piece: Piece) -> NDArray[np.int64]:
    """Mesh edges that part the piece from others: without those that its own darts run along, and the mesh's own border."""
    topology = mesh.topology
    inside = np.zeros(len(mesh.F), dtype=bool)
    inside[piece.faces] = True
    edges = np.unique(topology.FE[piece.faces])
    edges = edges[~topology.is_boundary[edges]]
    chosen: NDArray[np.int64] = edges[~inside[topology.EF[edges]].all(axis=1)]
    return chosen
