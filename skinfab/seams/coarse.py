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


def transfer(small: Mesh, cut: NDArray[np.bool_], mesh: Mesh) -> NDArray[np.bool_]:
    """The seams of `small` on `mesh`: each cut edge becomes the cheapest path between the nearest vertices of its ends."""
    seams = np.flatnonzero(cut & ~small.topology.is_boundary)
    used = mesh.topology.used_vertices
    ends = used[cKDTree(mesh.V[used]).query(small.V[small.topology.E[seams]].reshape(-1, 3))[1]].reshape(-1, 2)
    weight = seam_weights(mesh)
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
