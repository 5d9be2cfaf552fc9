"""Search on a small mesh, cut on the fine one."""

from __future__ import annotations

import igl
import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from skinfab.mesh.model import Mesh
from skinfab.seams.graph import edge_graph, trace
from skinfab.seams.weights import seam_weights


def coarsen(mesh: Mesh, faces: int) -> Mesh:
    """A mesh of about `faces` triangles of the same topology (quadric edge collapses), or `mesh` itself when it is small."""
    if len(mesh.F) <= 1.5 * faces:
        return mesh
    V, F = igl.qslim(np.asfortranarray(mesh.V), np.asfortranarray(mesh.F), faces)[:2]
    used, F = np.unique(np.asarray(F, dtype=np.int64), return_inverse=True)
    return Mesh(np.asarray(V)[used], F.reshape(-1, 3), mesh.name)


def transfer(
    small: Mesh,
    cut: NDArray[np.bool_],
    mesh: Mesh,
    *,
    weight: NDArray[np.float64] | None = None,
    pinned: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None,
) -> NDArray[np.bool_]:
    """The seams of `small` on `mesh`: each cut edge becomes the cheapest path between the nearest vertices of its ends.

    Parameters
    ----------
    small, mesh : Mesh
    cut : (e,) bool
        Per edge of `small`.
    weight : (f,) float64, optional
        Cost of cutting each edge of `mesh`; default `seam_weights`.
    pinned : two arrays of int64, optional
        Vertices of `small`, and the vertices of `mesh` to which these, instead of to the nearest of all, are taken.
    """
    seams = np.flatnonzero(cut & ~small.topology.is_boundary)
    used = mesh.topology.used_vertices
    nearest = np.zeros(len(small.V), dtype=np.int64)
    asked = np.unique(small.topology.E[seams])
    nearest[asked] = used[cKDTree(mesh.V[used]).query(small.V[asked])[1]]
    if pinned is not None and len(pinned[0]) and len(pinned[1]):
        nearest[pinned[0]] = pinned[1][cKDTree(mesh.V[pinned[1]]).query(small.V[pinned[0]])[1]]
    ends = nearest[small.topology.E[seams]]
    weight = seam_weights(mesh) if weight is None else weight
    graph = edge_graph(mesh.topology, weight, len(mesh.V))
    fine = np.zeros(len(mesh.topology.E), dtype=bool)
    for (a, b), length in zip(ends.tolist(), small.edge_lengths[seams].tolist(), strict=True):
        if a == b:
            continue
        for reach in (2 * length, np.inf):
            distance, before = dijkstra(graph, indices=a, return_predecessors=True, limit=reach)
            if np.isfinite(distance[b]):
                fine[mesh.topology.edge_ids(trace(before.astype(np.int64), b))] = True
                break
    return fine
