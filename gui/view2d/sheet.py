"""All pieces on one sheet, as arrays: what is drawn, and what a point of it is on the object."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gui.state.derived import Derived
from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.skin import Skin

Float = NDArray[np.float64]
Int = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges round all pieces.

    Parameters
    ----------
    ends : (b, 2, 2) float, mm of the sheet
    mesh : (b,) int64
        Edge of the mesh each was opened from.
    piece : (b,) int64
        Position of its piece.
    side : (b,) int64
        Index into ``Sheet.sides``; -1 for the edge of a hole.
    """

    ends: Float
    mesh: Int
    piece: Int
    side: Int


class Sheet:
    """The flat pieces of a skin, laid out side by side.

    Parameters
    ----------
    skin : Skin
    derived : Derived

    Attributes
    ----------
    UV : (n, 2) float64, mm of the sheet
    F : (m, 3) int32
    face : (m,) int64
        The mesh face of each triangle.
    owner : (m,) int64
        The position of its piece.
    offset : (k, 2) float64, mm
        Where each piece's own (0, 0) lies.
    """

    def __init__(self, skin: Skin, derived: Derived) -> None:
        self.mesh: Mesh = skin.mesh
        self.pieces: tuple[Piece, ...] = skin.pieces
        offsets = derived.offsets(skin.pieces)
        self.offset = np.array([offsets[p.id] for p in skin.pieces]).reshape(-1, 2)
        first = np.cumsum([0, *(len(p.UV) for p in skin.pieces)])
        self.UV = _stacked([p.UV + o for p, o in zip(skin.pieces, self.offset, strict=True)], (0, 2), np.float64)
        self.F = _stacked([p.F + k for p, k in zip(skin.pieces, first, strict=False)], (0, 3), np.int32)
        self.face = _stacked([p.faces for p in skin.pieces], (0,), np.int64)
        self.owner = np.repeat(np.arange(len(skin.pieces)), [len(p.F) for p in skin.pieces])
        self._index = {p.id: k for k, p in enumerate(skin.pieces)}

    def prepared(self) -> Sheet:
        """Itself, with all there is to know of it known."""
        assert self.sides is not None and self.edges is not None and self.box is not None
        assert all(piece.size for piece in self.pieces)
        return self

    @cached_property
    def box(self) -> tuple[Float, Float]:
        """Lower left and upper right corner of all pieces, mm of the sheet."""
        if not len(self.UV):
            return np.zeros(2), np.full(2, 100.0)
        return self.UV.min(axis=0), self.UV.max(axis=0)

    def index(self, piece: str) -> int:
        """Position of the piece of that id; -1 where there is none."""
        return self._index.get(piece, -1)

    def offset_of(self, piece: str) -> Float:
        """(2,) mm to add to coordinates of the piece of that id."""
        k = self.index(piece)
        return self.offset[k] if k >= 0 else np.zeros(2)

    @cached_property
    def sides(self) -> list[SeamSide]:
        """As the drawings have them: the same labels on both sides of a seam."""
        return seam_sides(self.pieces)

    @cached_property
    def edges(self) -> Edges:
        """Of outlines and holes."""
        runs: dict[tuple[int, tuple[float, ...]], int] = {}
        for s, side in enumerate(self.sides):
            for ends in np.concatenate([side.points[:-1], side.points[1:]], axis=1).tolist():
                runs[side.piece, tuple(ends)] = s
        ends, mesh, owner, sides = [], [], [], []
        for k, piece in enumerate(self.pieces):
            topology = piece.topology
            of = np.flatnonzero(topology.is_boundary)
            face, corner = topology.EF[of, 0], topology.EC[of, 0]
            pairs = np.stack([piece.F[face, corner], piece.F[face, (corner + 1) % 3]], axis=1)
            flat = piece.UV[pairs]
            ends.append(flat + self.offset[k])
            mesh.append(self.mesh.topology.edge_ids(piece.vertices[pairs]))
            owner.append(np.full(len(of), k))
            sides.append(np.array([runs.get((k, tuple(e)), -1) for e in flat.reshape(-1, 4).tolist()], dtype=np.int64))
        return Edges(
            _stacked(ends, (0, 2, 2), np.float64),
            _stacked(mesh, (0,), np.int64),
            _stacked(owner, (0,), np.int64),
            _stacked(sides, (0,), np.int64),
        )

    def nearest_edge(self, point: Float) -> tuple[int, float]:
        """Index into `edges` of the one nearest to a point of the sheet, and how far it is, mm; -1 where there is none."""
        ends = self.edges.ends
        if not len(ends):
            return -1, np.inf
        along = ends[:, 1] - ends[:, 0]
        square = np.einsum("ij,ij->i", along, along)
        t = np.clip(np.einsum("ij,ij->i", point - ends[:, 0], along) / np.where(square > 0, square, 1.0), 0.0, 1.0)
        apart = np.hypot(*(point - ends[:, 0] - t[:, None] * along).T)
        k = int(np.argmin(apart))
        return k, float(apart[k])

    def seam_label(self, edge: int) -> str:
        """What the seam is called that the mesh edge lies on; "" where none does."""
        on = np.flatnonzero((self.edges.mesh == edge) & (self.edges.side >= 0))
        return self.sides[int(self.edges.side[on[0]])].label if len(on) else ""

    def seam_lines(self, edge: int) -> list[Float]:
        """Both sides of the seam that the mesh edge lies on, (k, 2) mm of the sheet each."""
        label = self.seam_label(edge)
        return [side.points + self.offset[side.piece] for side in self.sides if label and side.label == label]


def _stacked(parts: list, empty: tuple[int, ...], kind: type) -> NDArray:
    return np.concatenate([np.zeros(empty, dtype=kind), *parts]).astype(kind)
