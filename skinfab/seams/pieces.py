"""From a seam search to the pieces of a skin: named, largest first."""

from __future__ import annotations

from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.seams.refine import Judged


def to_pieces(mesh: Mesh, judged: list[Judged]) -> tuple[Piece, ...]:
    """Pieces P1, P2, ... by falling area (by first face where equal)."""
    order = sorted(judged, key=lambda item: (-round(float(mesh.face_areas[item[0].faces].sum()), 6), int(item[0].faces[0])))
    return tuple(
        Piece(f"P{number}", piece.faces, piece.vertices, piece.F, verdict.UV) for number, (piece, verdict) in enumerate(order, start=1)
    )
