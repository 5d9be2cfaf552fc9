"""Relieve the worst spot of a piece: a seam from there to the boundary by the shortest way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges
from skinfab.seams.graph import edge_graph, shortest_tree, trace

#: A single needle triangle must not draw every dart to itself.
_WORST_D = 50.0


def grow_dart(mesh: Mesh, piece: OpenPiece, d: NDArray[np.float64], weight: NDArray[np.float64]) -> NDArray[np.int64]:
    """Mesh edges of a dart from the most distorted vertex to the boundary.

    The worst vertex weighs the excess of d about it, its distance to the boundary (a dart from a vertex beside
    the boundary relieves little) and its curvature (where the dart has to end to take it out).

    Parameters
    ----------
    mesh : Mesh
    piece : OpenPiece
        A disk.
    d : (k,) float
        Distortion of each of its faces.
    weight : (e,) float
        Cost of cutting each mesh edge.

    Returns
    -------
    (j,) int64
        None when no vertex lies inside the piece.
    """
    topology, n = piece.topology, len(piece.vertices)
    on_boundary = np.zeros(n, dtype=bool)
    on_boundary[topology.boundary_loops[0]] = True
    if on_boundary.all():
        return np.zeros(0, dtype=np.int64)
    edge_weight = weight[mesh_edges(mesh, piece, np.arange(len(topology.E)))]
    distance, before = shortest_tree(edge_graph(topology, edge_weight, n), np.flatnonzero(on_boundary))
    area = mesh.face_areas[piece.faces]
    corner = piece.F.ravel()
    around = np.maximum(np.bincount(corner, np.repeat(area, 3), n), np.finfo(float).tiny)
    excess = np.bincount(corner, np.repeat((np.minimum(d, _WORST_D) - 4) * area, 3), n) / around
    curvature = np.abs(2 * np.pi - intrinsic(mesh.V[piece.vertices], piece.F).angle_sum)
    reach = np.minimum(distance / np.sqrt(area.sum()), 0.5)
    score = np.where(on_boundary, -np.inf, excess * reach * (1 + 4 * curvature))
    path = trace(before, int(np.argmax(score)))
    return mesh_edges(mesh, piece, topology.edge_ids(path))
