"""The intrinsic Delaunay triangulation: the same surface and vertices, edges flipped until no weight is negative.

An edge is flipped inside the surface, along the straight line of the two unfolded triangles (Fisher et al. 2007, "An
Algorithm for the Construction of Intrinsic Delaunay Triangulations with Applications to Digital Geometry Processing").
A map that is harmonic over it lays far fewer triangles of an obtuse mesh upside down. Edges of a vertex that has
only three left stay: flipped on, they would leave vertices with one neighbour, and a harmonic map drops those onto it.
Those few edges get a small positive weight instead of their negative one.

libigl's `intrinsic_delaunay_triangulation` flips those too, takes five times as long at 200,000 triangles, and never
returns from an edge without length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.graph_laplacian import GraphLaplacian
from skinfab.flatten.laplacian import Intrinsic, corners_of_lengths, mollified_lengths
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DELAUNAY_COTANGENT, LEAST_EDGE_WEIGHT

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: In exact arithmetic flipping ends by itself; where rounding makes two needles change places for ever, this ends it.
_MOST_FLIPS_PER_FACE = 50


@dataclass(frozen=True, eq=False)
class DelaunayCorners(Intrinsic):
    """Angles and cotangents over the intrinsic Delaunay triangulation; `F` and `length` are its own.

    Parameters
    ----------
    length : (m, 3) float64, mm
        The edge opposite each corner.
    on_border : (n,) bool
    """

    length: FloatArray
    on_border: NDArray[np.bool_]

    def laplacian(self, *, topology: Topology | None = None) -> GraphLaplacian:
        """The cotangent matrix, (n, n), without negative weights but along and across the border."""
        L = super().laplacian(topology=topology)
        # Between two border vertices a weight moves no inner vertex, and the border's own is part of its curvature.
        negative = (L.weight < -DELAUNAY_COTANGENT) & ~self.on_border[L.E].all(axis=1)
        return replace(L, weight=np.where(negative, LEAST_EDGE_WEIGHT, L.weight))


def delaunay_corners(V: FloatArray, F: IntArray, *, topology: Topology | None = None) -> DelaunayCorners:
    """Flip edges until the triangulation is Delaunay.

    Parameters
    ----------
    V : (n, 3) float64, mm
        Finite.
    F : (m, 3) int64
        An oriented manifold, with or without a boundary.
    topology : Topology, optional
        Of `F`, where it is at hand.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [2, -0.1, 0], [4, 0, 0], [2, 0.1, 0]])
    >>> t = delaunay_corners(V, np.array([[0, 1, 2], [0, 2, 3]]))  # the long diagonal gives way to the short one
    >>> np.sort(t.F, axis=1).tolist(), float(t.length.min().round(6))
    ([[1, 2, 3], [0, 1, 3]], 0.2)
    """
    topology = topology or Topology(F)
    G, length = np.array(F, dtype=np.int64, order="C"), np.ascontiguousarray(mollified_lengths(V, F))
    # Half-edge 3 f + k is the one opposite corner k of face f; the topology counts it from corner k + 1.
    inner = topology.edge_count == 2
    here, there = (3 * topology.EF[inner] + (topology.EC[inner] + 2) % 3).T
    twin = np.full(3 * len(F), -1)
    twin[here], twin[there] = there, here
    on_border = np.zeros(len(V), dtype=bool)
    on_border[topology.E[topology.is_boundary]] = True
    # A border vertex is laid down by the border itself, however few edges it keeps.
    spare = np.bincount(topology.E.ravel(), minlength=len(V)) - 3
    spare[on_border] = len(F)
    _flip(G, length, twin, spare, _MOST_FLIPS_PER_FACE * len(F), DELAUNAY_COTANGENT)
    angle, cotangent = corners_of_lengths(length)
    return DelaunayCorners(G, len(V), angle, cotangent, length, on_border)


@numba.njit(cache=True)
def _twice_area(a: float, b: float, c: float) -> float:
    """Of a triangle with these sides: Kahan's stable form of Heron's rule."""
    if a < b:
        a, b = b, a
    if b < c:
        b, c = c, b
    if a < b:
        a, b = b, a
    return np.sqrt(max((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0.0)) / 2


@numba.njit(cache=True)
def _flip(F: IntArray, length: FloatArray, twin: IntArray, spare: IntArray, most: int, slack: float) -> int:
    """Flip in place; how many edges were flipped.

    Where `bc` parts the triangles (a, b, c) and (d, c, b), they become (a, b, d) and (d, c, a).
    """
    waiting = [h for h in range(3 * F.shape[0]) if twin[h] > h]
    queued = np.zeros(3 * F.shape[0], dtype=np.bool_)
    queued[np.array(waiting, dtype=np.int64)] = True
    beside, outer = np.empty(4, dtype=np.int64), np.empty(4, dtype=np.int64)
    flips = 0
    while len(waiting) > 0 and flips < most:
        h = waiting.pop()
        queued[h] = False
        t = twin[h]
        if t < 0:
            continue
        f, k, g, l = h // 3, h % 3, t // 3, t % 3  # noqa: E741 - l to g as k to f
        k1, k2, l1, l2 = (k + 1) % 3, (k + 2) % 3, (l + 1) % 3, (l + 2) % 3
        a, b, c, d = F[f, k], F[f, k1], F[f, k2], F[g, l]
        if f == g or a == d or spare[b] <= 0 or spare[c] <= 0:
            continue
        bc, ca, ab, bd, dc = length[f, k], length[f, k1], length[f, k2], length[g, l1], length[g, l2]
        up, down = _twice_area(bc, ca, ab), _twice_area(bc, bd, dc)
        if not (up > 0.0 and down > 0.0):
            continue
        cot_a, cot_d = (ca * ca + ab * ab - bc * bc) / (2 * up), (bd * bd + dc * dc - bc * bc) / (2 * down)
        if cot_a + cot_d >= -slack * (1.0 + abs(cot_a) + abs(cot_d)):
            continue
        # Unfolded: b at the origin, c along x, a above and d below.
        ax, dx = (ab * ab + bc * bc - ca * ca) / (2 * bc), (bd * bd + bc * bc - dc * dc) / (2 * bc)
        ad = np.hypot(ax - dx, (up + down) / bc)
        if not (_twice_area(ad, ab, bd) > 0.0 and _twice_area(ad, ca, dc) > 0.0):
            continue  # convex it is, but not in these digits
        spare[b], spare[c], spare[a], spare[d] = spare[b] - 1, spare[c] - 1, spare[a] + 1, spare[d] + 1
        # The four sides a-b, c-a, b-d, d-c: where they were, what is beside them, where they are now.
        old = (3 * f + k2, 3 * f + k1, 3 * g + l1, 3 * g + l2)
        new = (3 * f + 2, 3 * g, 3 * f, 3 * g + 2)
        for i in range(4):
            outer[i] = beside[i] = twin[old[i]]
            for j in range(4):
                if beside[i] == old[j]:  # two of the four are sides of the same edge
                    outer[i] = new[j]
        F[f, 0], F[f, 1], F[f, 2] = a, b, d
        F[g, 0], F[g, 1], F[g, 2] = d, c, a
        length[f, 0], length[f, 1], length[f, 2] = bd, ad, ab
        length[g, 0], length[g, 1], length[g, 2] = ca, ad, dc
        for i in range(4):
            twin[new[i]] = outer[i]
            if outer[i] >= 0:
                twin[outer[i]] = new[i]
                if not queued[new[i]]:
                    queued[new[i]] = True
                    waiting.append(new[i])
        twin[3 * f + 1], twin[3 * g + 1] = 3 * g + 1, 3 * f + 1
        flips += 1
    return flips
