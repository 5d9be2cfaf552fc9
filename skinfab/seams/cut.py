"""Open a mesh along its seam edges.

A seam set is one boolean per edge of ``mesh.topology``. Faces stay together across every edge that is not
cut; corners become one vertex just when such edges join them, so a seam that ends inside a piece (a dart)
opens it as naturally as one that parts it.
"""

from __future__ import annotations

from dataclasses import InitVar, dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.joined import joined
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology

IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class OpenPiece:
    """Faces that hang together, with their own vertices.

    Parameters
    ----------
    faces : (k,) int64
        Mesh faces, ascending.
    vertices : (p,) int64
        The mesh vertex of each piece vertex.
    F : (k, 3) int64
        The faces by piece vertices.
    known : Topology, optional
        Of `F`, where it is at hand.
    """

    faces: IntArray
    vertices: IntArray
    F: IntArray
    known: InitVar[Topology | None] = None

    def __post_init__(self, known: Topology | None) -> None:
        if known is not None:
            vars(self)["topology"] = known  # as `topology` itself would keep it

    @cached_property
    def topology(self) -> Topology:
        return Topology(self.F)

    @property
    def is_disk(self) -> bool:
        """One boundary loop and Euler number 1 (pieces are connected by construction)."""
        return self.topology.euler == 1 and len(self.topology.boundary_loops) == 1


def open_pieces(mesh: Mesh, cut: BoolArray, *, faces: IntArray | None = None) -> list[OpenPiece]:
    """The pieces that `mesh` falls into, ordered by their first face.

    Parameters
    ----------
    mesh : Mesh
    cut : (e,) bool
    faces : (k,) int64, optional
        Only these faces, as if the rest of the mesh were not there.

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> cut = np.zeros(5, dtype=bool)
    >>> len(open_pieces(square, cut)), len(open_pieces(square, cut | True))
    (1, 2)
    """
    topology = mesh.topology
    if faces is None and not (cut & ~topology.is_boundary).any() and topology.is_oriented_manifold and topology.face_components()[0] == 1:
        return [_whole(mesh)]
    m = len(mesh.F)
    chosen = np.arange(m) if faces is None else np.sort(faces)
    local = np.full(m + 1, -1)
    local[chosen] = np.arange(len(chosen))
    edges = np.unique(topology.FE[chosen]) if faces is not None else np.arange(len(topology.E))
    EF, EC = local[topology.EF[edges]], topology.EC[edges]
    kept = (EF >= 0).all(axis=1) & ~cut[edges]
    (f, g), (i, j) = EF[kept].T, EC[kept].T
    F = mesh.F[chosen]

    count, label = joined(f, g, len(F))
    a0, a1 = 3 * f + i, 3 * f + (i + 1) % 3
    b0, b1 = 3 * g + j, 3 * g + (j + 1) % 3
    same_way = F[f, i] == F[g, j]  # the two faces run along the edge in one direction: inconsistent winding
    b0, b1 = np.where(same_way, b0, b1), np.where(same_way, b1, b0)
    _, corner = joined(np.r_[a0, a1], np.r_[b0, b1], 3 * len(F))
    corner = corner.reshape(-1, 3)

    order = np.argsort(label, kind="stable")
    bounds = np.searchsorted(label[order], np.arange(count + 1))
    pieces = []
    for k in range(count):
        mine = order[bounds[k] : bounds[k + 1]]
        _, first, inverse = np.unique(corner[mine], return_index=True, return_inverse=True)
        pieces.append(OpenPiece(chosen[mine], F[mine].ravel()[first], inverse.reshape(-1, 3).astype(np.int64)))
    return pieces


def _whole(mesh: Mesh) -> OpenPiece:
    """All of a mesh in one piece with nothing to open: its vertices, without those that no face uses."""
    used = mesh.topology.used_vertices
    if len(used) == len(mesh.V):
        return OpenPiece(np.arange(len(mesh.F)), used, mesh.F, mesh.topology)
    number = np.full(len(mesh.V), -1)
    number[used] = np.arange(len(used))
    return OpenPiece(np.arange(len(mesh.F)), used, number[mesh.F])


def mesh_edges(mesh: Mesh, piece: OpenPiece, edges: IntArray) -> IntArray:
    """Mesh edge ids of the piece's edges `edges`."""
    topology = piece.topology
    return mesh.topology.FE[piece.faces[topology.EF[edges, 0]], topology.EC[edges, 0]]


def seam_length(mesh: Mesh, cut: BoolArray) -> float:
    """Length of the cut edges, each once, without the mesh's own boundary; mm."""
    return float(mesh.edge_lengths[cut & ~mesh.topology.is_boundary].sum())
