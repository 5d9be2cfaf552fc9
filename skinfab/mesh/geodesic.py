"""The shortest way over a surface between two of its points: how far two places of the object are apart along its skin.

A first way is found over vertices and the middles of edges. Then, in a corridor of faces about it, a finer one over more points
of each edge, which is pulled taut (the length is convex in where a given row of edges is crossed); and so on until that makes it
no shorter. What comes out is a way, never shorter than the shortest; beside exact ones it was longer by less than two thousandths,
mostly by less than three ten-thousandths.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.tolerances import WEIGHT_SUM

Float = NDArray[np.float64]
Int = NDArray[np.int64]

#: Points on each edge that a way can go through: in the first search, in a corridor, and in a narrow one at last.
_COARSE, _FINE, _FINEST = 1, 5, 16
#: Rounds of searching a corridor; a way on a smooth surface settles in three or four.
_ROUNDS = 12
#: A round that shortens the way by a smaller share was the last.
_SETTLED = 1e-4
#: Half the width of a corridor and of the last one, in mean edge lengths.
_CORRIDOR, _NARROW = 4.0, 0.5


@dataclass(frozen=True, eq=False)
class Geodesic:
    """A shortest way.

    Parameters
    ----------
    points : (k, 3) float, mm
        From the first point to the last; straight across each face.
    """

    points: Float

    @property
    def length(self) -> float:
        """mm."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def __repr__(self) -> str:
        return f"Geodesic({self.length:.2f} mm over {len(self.points) - 1} faces)"


def geodesic(mesh: Mesh, start: tuple[int, ArrayLike], end: tuple[int, ArrayLike]) -> Geodesic:
    """The shortest way over a mesh from one point to another.

    Parameters
    ----------
    mesh : Mesh
    start, end : (face, (3,) weights)
        Points by their faces and the barycentric weights of the faces' corners.

    Raises
    ------
    InputError
        No such face, weights that do not sum to 1, or points on parts of the mesh that are not connected.

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [30, 0, 0], [30, 40, 0], [0, 40, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> geodesic(square, (0, (0, 1, 0)), (1, (0, 0, 1)))
    Geodesic(50.00 mm over 2 faces)
    """
    ends = np.array([_point(mesh, *start), _point(mesh, *end)])
    faces = (int(start[0]), int(end[0]))
    if faces[0] == faces[1]:
        return Geodesic(ends)
    area = _within_reach(mesh, ends, faces)
    nodes, net = _shortest(mesh, area, ends, faces, _COARSE)
    way = net.places(nodes)
    length = np.inf
    for _ in range(_ROUNDS):
        nodes, net = _shortest(mesh, _corridor(mesh, area, way, faces, _CORRIDOR), ends, faces, _FINE)
        way = _taut(net, nodes)
        now = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
        if now > length * (1 - _SETTLED):
            break
        length = now
    nodes, net = _shortest(mesh, _corridor(mesh, area, way, faces, _NARROW), ends, faces, _FINEST)
    last = Geodesic(_taut(net, nodes))
    return min(last, Geodesic(way), key=lambda found: found.length)


def _point(mesh: Mesh, face: int, weights: ArrayLike) -> Float:
    given = np.asarray(weights, dtype=float)
    if not 0 <= int(face) < len(mesh.F):
        raise InputError(f"there is no face {face}; the mesh has {len(mesh.F)}, counted from 0")
    if given.shape != (3,) or not abs(given.sum() - 1) <= WEIGHT_SUM:
        raise InputError(f"a point of a face has three weights of sum 1; these are {given.tolist()}")
    return np.asarray(given @ mesh.V[mesh.F[int(face)]])


def _within_reach(mesh: Mesh, ends: Float, faces: tuple[int, int]) -> Int:
    """Faces that a shortest way can cross: along the edges it takes so far at most, and farther round none does."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    E = mesh.topology.E
    long = np.linalg.norm(mesh.V[E[:, 0]] - mesh.V[E[:, 1]], axis=1)
    graph = coo_array((np.maximum(long, np.finfo(float).tiny), (E[:, 0], E[:, 1])), shape=(len(mesh.V),) * 2).tocsr()
    first, last = mesh.F[faces[0]], mesh.F[faces[1]]
    apart = dijkstra(graph, directed=False, indices=first)[:, last]
    detour = np.linalg.norm(mesh.V[first] - ends[0], axis=1)[:, None] + apart + np.linalg.norm(mesh.V[last] - ends[1], axis=1)[None]
    most = float(detour.min())
    if not np.isfinite(most):
        raise InputError("the two points lie on parts of the mesh that are not connected; choose points of one part")
    corners = mesh.V[mesh.F]
    centre = corners.mean(axis=1)
    radius = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    around = np.linalg.norm(centre - ends[0], axis=1) + np.linalg.norm(centre - ends[1], axis=1) - 2 * radius
    return np.flatnonzero(around <= most * (1 + 1e-9))


def _corridor(mesh: Mesh, area: Int, way: Float, faces: tuple[int, int], width: float) -> Int:
    """Faces of an area near a way, and all that the way itself needs."""
    from scipy.spatial import cKDTree

    corners = mesh.V[mesh.F[area]]
    edge = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    steps = np.maximum(np.ceil(np.linalg.norm(np.diff(way, axis=0), axis=1) / edge), 1).astype(np.int64)
    t = np.concatenate([np.arange(n) / n for n in steps])
    which = np.repeat(np.arange(len(steps)), steps)
    dense = np.vstack([way[which] + t[:, None] * (way[which + 1] - way[which]), way[-1:]])
    centre = corners.mean(axis=1)
    radius = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    near = cKDTree(dense).query(centre)[0] <= radius + width * edge
    return np.unique(np.concatenate([area[near], faces]))


@dataclass(frozen=True, eq=False)
class _Net:
    """Points that a way can go through: vertices, `per_edge` points on each edge, the two ends; numbered in that order."""

    mesh: Mesh
    per_edge: int
    ends: Float

    def on_edge(self, nodes: Int) -> tuple[Int, Float]:
        """Edge of each node, -1 for vertices and ends, and how far along it the node lies."""
        n, count = len(self.mesh.V), len(self.mesh.topology.E) * self.per_edge
        inside = (nodes >= n) & (nodes < n + count)
        edge, k = np.divmod(nodes - n, self.per_edge)
        return np.where(inside, edge, -1), (k + 1) / (self.per_edge + 1)

    def places(self, nodes: Int) -> Float:
        """(k, 3) mm."""
        n, count = len(self.mesh.V), len(self.mesh.topology.E) * self.per_edge
        edge, t = self.on_edge(nodes)
        a, b = self.mesh.V[self.mesh.topology.E[edge]].transpose(1, 0, 2)
        at = a + t[:, None] * (b - a)
        corner = nodes < n
        at[corner] = self.mesh.V[nodes[corner]]
        last = nodes >= n + count
        at[last] = self.ends[nodes[last] - n - count]
        return at


def _shortest(mesh: Mesh, area: Int, ends: Float, faces: tuple[int, int], per_edge: int) -> tuple[Int, _Net]:
    """Nodes of the shortest way through the net over some faces, from the first end to the last."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    net, n, m = _Net(mesh, per_edge, ends), len(mesh.V), per_edge
    total = n + len(mesh.topology.E) * m + 2
    FE, E, F = mesh.topology.FE[area], mesh.topology.E, mesh.F[area]
    on = n + FE[:, :, None] * m + np.arange(m)  # (faces, 3 edges, m)
    pairs = []
    for k in range(3):
        following = on[:, (k + 1) % 3]
        # Edge k runs from corner k to corner k + 1: across the face from it is the corner before.
        pairs.append(np.stack(np.broadcast_arrays(on[:, k, :, None], following[:, None, :]), axis=-1).reshape(-1, 2))
        pairs.append(np.stack(np.broadcast_arrays(F[:, k, None], following), axis=-1).reshape(-1, 2))
    used = np.unique(FE)
    along = np.concatenate([E[used, :1], n + used[:, None] * m + np.arange(m), E[used, 1:]], axis=1)
    pairs.append(np.stack([along[:, :-1], along[:, 1:]], axis=-1).reshape(-1, 2))
    for k, face in enumerate(faces):
        about = np.concatenate([mesh.F[face], (n + mesh.topology.FE[face][:, None] * m + np.arange(m)).ravel()])
        pairs.append(np.stack([np.full(len(about), total - 2 + k), about], axis=1))
    links = np.concatenate(pairs)
    names, small = np.unique(links, return_inverse=True)
    small = small.reshape(-1, 2)
    at = net.places(names)
    # Links of no length would be none: the way through a vertex that is an end itself.
    long = np.maximum(np.linalg.norm(at[small[:, 0]] - at[small[:, 1]], axis=1), np.finfo(float).tiny)
    graph = coo_array((long, (small[:, 0], small[:, 1])), shape=(len(names),) * 2).tocsr()
    first, last = np.searchsorted(names, [total - 2, total - 1])
    before = dijkstra(graph, directed=False, indices=int(first), return_predecessors=True)[1]
    way = [int(last)]
    while way[-1] != first:
        way.append(int(before[way[-1]]))
    return names[way[::-1]], net


def _taut(net: _Net, nodes: Int) -> Float:
    """Places of the nodes, those on edges slid along them until the way is shortest."""
    from scipy.optimize import minimize

    way = net.places(nodes)
    edge, t0 = net.on_edge(nodes)
    free = np.flatnonzero(edge >= 0)
    if not len(free):
        return way
    a, b = net.mesh.V[net.mesh.topology.E[edge[free]]].transpose(1, 0, 2)

    def length(t: Float) -> tuple[float, Float]:
        way[free] = a + t[:, None] * (b - a)
        step = np.diff(way, axis=0)
        long = np.linalg.norm(step, axis=1)
        unit = step / np.maximum(long, np.finfo(float).tiny)[:, None]
        pull = np.einsum("ij,ij->i", unit[free - 1] - unit[free], b - a)
        return float(long.sum()), pull

    found = minimize(
        length, t0[free], jac=True, method="L-BFGS-B", bounds=[(0.0, 1.0)] * len(free), options={"maxiter": 500, "ftol": 1e-13}
    )
    way[free] = a + found.x[:, None] * (b - a)
    return way


def angle_between(one: ArrayLike, two: ArrayLike) -> float:
    """Angle between two directions, rad from 0 to pi; 0 where one of them has no length.

    Of two ways that leave the inside of a face, both first steps lie in its plane, and this is the angle on the surface.

    Examples
    --------
    >>> round(float(np.degrees(angle_between((1, 0, 0), (0, 2, 0)))), 9)
    90.0
    """
    a, b = np.asarray(one, dtype=float), np.asarray(two, dtype=float)
    lengths = float(np.linalg.norm(a) * np.linalg.norm(b))
    # More exact near 0 and pi than the arc cosine of the product.
    if lengths == 0:
        return 0.0
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    return float(2 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))
