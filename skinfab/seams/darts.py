"""Relieve the worst spot of a piece: a seam from there to the boundary by the shortest way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges
from skinfab.seams.graph import edge_graph, shortest_tree, trace

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: A single needle triangle must not draw every dart to itself.
_WORST_D = 50.0


@dataclass(frozen=True, eq=False)
class _Outlook:
    """What a dart to each vertex of a piece would meet; `before` leads from there to the boundary."""

    on_boundary: NDArray[np.bool_]
    before: IntArray
    distance: FloatArray
    excess: FloatArray
    curvature: FloatArray
    size: float


def grow_dart(mesh: Mesh, piece: OpenPiece, d: FloatArray, weight: FloatArray, *, forbidden: NDArray[np.bool_] | None = None) -> IntArray:
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
    forbidden : (e,) bool, optional
        Mesh edges that it does not take: the worst of the vertices that it can reach without them.

    Returns
    -------
    (j,) int64
        None when no vertex lies inside the piece, or none can be reached.
    """
    seen = _look(mesh, piece, d, weight if forbidden is None else np.where(forbidden, np.inf, weight))
    if seen is None or not np.isfinite(worst := _worst(seen)).any():
        return np.zeros(0, dtype=np.int64)
    path = trace(seen.before, int(np.argmax(worst)))
    return mesh_edges(mesh, piece, piece.topology.edge_ids(path))


def _look(mesh: Mesh, piece: OpenPiece, d: FloatArray, weight: FloatArray) -> _Outlook | None:
    topology, n = piece.topology, len(piece.vertices)
    on_boundary = np.zeros(n, dtype=bool)
    on_boundary[topology.E[topology.is_boundary]] = True
    if on_boundary.all():
        return None
    edge_weight = weight[mesh_edges(mesh, piece, np.arange(len(topology.E)))]
    distance, before = shortest_tree(edge_graph(topology, edge_weight, n), np.flatnonzero(on_boundary))
    on_boundary |= ~np.isfinite(distance)  # nor can a dart begin where no way leads to
    area = mesh.face_areas[piece.faces]
    corner = piece.F.ravel()
    around = np.maximum(np.bincount(corner, np.repeat(area, 3), n), np.finfo(float).tiny)
    excess = np.bincount(corner, np.repeat((np.minimum(d, _WORST_D) - 4) * area, 3), n) / around
    curvature = np.abs(2 * np.pi - intrinsic(mesh.V[piece.vertices], piece.F).angle_sum)
    return _Outlook(on_boundary, before, distance, excess, curvature, float(np.sqrt(area.sum())))


def _worst(seen: _Outlook) -> FloatArray:
    reach = np.minimum(seen.distance / seen.size, 0.5)
    return np.where(seen.on_boundary, -np.inf, seen.excess * reach * (1 + 4 * seen.curvature))
