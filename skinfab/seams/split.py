"""Part a piece in two along the cheapest seam between two places that must come apart.

Around each place grows a core; between the cores the minimum cut of the face graph, with seam cost as
capacity, is the cheapest seam there is (max-flow min-cut).
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, dijkstra, maximum_flow

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges
from skinfab.seams.graph import face_graph

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: The seam lies where distance to one place / distance to both is between this and one minus this.
_CORE = 0.3


def farthest_faces(piece: OpenPiece, UV: FloatArray) -> tuple[int, int]:
    """The two faces at the ends of the flat shape's long side (the piece frame's x)."""
    x, y = UV[piece.F].mean(axis=1).T
    order = np.lexsort((y, x))  # y tells two faces above each other apart
    return int(order[0]), int(order[-1])


def overlapping_faces(mesh: Mesh, piece: OpenPiece, UV: FloatArray) -> tuple[int, int]:
    """Of all pairs of flat triangles that lie on each other, the one that is farthest apart on the object."""
    triangles = np.asarray(shapely.polygons(UV[piece.F]))
    one, two = shapely.STRtree(triangles).query(triangles, predicate="intersects")
    apart = one < two
    one, two = one[apart], two[apart]
    area = shapely.area(shapely.intersection(triangles[one], triangles[two]))
    real = area > 1e-9 * shapely.area(triangles).sum()
    one, two = one[real], two[real]
    if not len(one):
        return farthest_faces(piece, UV)
    centre = mesh.V[mesh.F[piece.faces]].mean(axis=1)
    steps = _centre_steps(piece, centre)
    few = np.unique(np.linspace(0, len(one) - 1, 12).astype(int))
    far = [dijkstra(steps, indices=int(one[k]))[two[k]] for k in few]
    best = few[int(np.argmax(far))]
    return int(one[best]), int(two[best])


def split(mesh: Mesh, piece: OpenPiece, ends: tuple[int, int], weight: FloatArray) -> IntArray:
    """Mesh edges of the cheapest seam that parts `piece` between two of its faces.

    Parameters
    ----------
    mesh : Mesh
    piece : OpenPiece
    ends : two ints
        Positions in ``piece.faces``.
    weight : (e,) float
        Cost of cutting each mesh edge, > 0.
    """
    steps = _centre_steps(piece, mesh.V[mesh.F[piece.faces]].mean(axis=1))
    a, b = dijkstra(steps, indices=list(ends))
    share = a / np.maximum(a + b, np.finfo(float).tiny)
    return part(mesh, piece, share < _CORE, share > 1 - _CORE, weight)


def part(mesh: Mesh, piece: OpenPiece, one: BoolArray, other: BoolArray, weight: FloatArray) -> IntArray:
    """Mesh edges of the cheapest seam that parts two sets of a piece's faces, (k,) bool each; none where one is empty."""
    topology, m = piece.topology, len(piece.F)
    inner = np.flatnonzero(topology.EF[:, 1] >= 0)
    f, g = topology.EF[inner].T
    cost = weight[mesh_edges(mesh, piece, inner)]
    # Integer capacities whose sum stays far inside 32 bits.
    capacity = np.maximum(np.round(cost / cost.sum() * 2**28), 1).astype(np.int32)
    source, sink, endless = m, m + 1, np.int32(2**30)
    ka, kb = np.flatnonzero(one), np.flatnonzero(other)
    rows = np.r_[f, g, np.full(len(ka), source), kb]
    columns = np.r_[g, f, ka, np.full(len(kb), sink)]
    data = np.r_[capacity, capacity, np.full(len(ka) + len(kb), endless)]
    network = coo_array((data, (rows, columns)), shape=(m + 2, m + 2)).tocsr()
    residual = network - maximum_flow(network, source, sink).flow
    residual.eliminate_zeros()
    side = np.zeros(m + 2, dtype=bool)
    side[breadth_first_order(residual, source, return_predecessors=False)] = True
    return mesh_edges(mesh, piece, inner[side[f] != side[g]])


def _centre_steps(piece: OpenPiece, centre: FloatArray) -> csr_array:
    topology = piece.topology
    f, g = topology.EF.T
    step = np.linalg.norm(centre[f] - centre[g], axis=1)
    return face_graph(topology, np.maximum(step, step.mean() * 1e-9))
