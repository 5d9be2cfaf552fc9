"""Carry a coarse mesh's flat layout to the fine mesh that it was made from.

Every fine vertex has a nearest point on the coarse mesh, found by walking from the vertex it was collapsed
into, so that the two sides of a seam, which lie on each other, are never mixed up. Its place in the plane is a
blend of what the three corners there expect of it, each from its own place and gradient.
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from skinfab.mesh.decimate import Decimated

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Corners walked over in search of the nearest point; more only where the surface has a fold the coarse mesh has not.
_MOST_HOPS = 16


@dataclass(frozen=True, eq=False)
class Carrier:
    """Where the vertices of a fine mesh are on a coarse one.

    Parameters
    ----------
    coarse : Decimated
    face : (n,) int64
        The coarse triangle nearest to each fine vertex.
    barycentric : (n, 3) float
        Of the nearest point in it.
    away : (n, 3) float64, mm
        From that point to the vertex.
    """

    coarse: Decimated
    face: IntArray
    barycentric: FloatArray
    away: FloatArray

    @property
    def interpolation(self) -> csr_array:
        """Values at the coarse vertices to values at the fine ones, (n, k), linear in each triangle."""
        n = len(self.face)
        return csr_array((self.barycentric.ravel(), self.coarse.F[self.face].ravel(), 3 * np.arange(n + 1)), shape=(n, len(self.coarse.V)))

    def carry(self, UV: FloatArray) -> FloatArray:
        """The fine vertices' places (n, 2) mm in a layout (k, 2) mm of the coarse mesh.

        Linear interpolation has errors of second order of one sign, expansion by the corners' gradients the same of
        the other: their mean is exact where the layout is quadratic, so that triangles across a coarse edge do not flip.
        """
        V, corners = self.coarse.V, self.coarse.F[self.face]
        slope = _vertex_gradients(V, self.coarse.F, UV)
        foot = sum((self.barycentric[:, k, None] * V[corners[:, k]] for k in (1, 2)), self.barycentric[:, :1] * V[corners[:, 0]])
        found = np.zeros((len(foot), 2))
        for k in range(3):
            corner, weight = corners[:, k], self.barycentric[:, k, None]
            reach = (foot - V[corner]) / 2 + self.away
            found += weight * (UV[corner] + np.einsum("nij,nj->ni", slope[corner], reach))
        return found


def carrier(V: FloatArray, coarse: Decimated) -> Carrier:
    """Place the fine mesh's vertices on the coarse mesh.

    Parameters
    ----------
    V : (n, 3) float64, mm
    coarse : Decimated

    Examples
    --------
    >>> square = Decimated(np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]), np.array([[0, 1, 2], [0, 2, 3]]), np.array([1, 3]))
    >>> two = carrier(np.array([[3.0, 1.0, 0.5], [1.0, 5.0, 0.0]]), square)
    >>> two.face.tolist(), two.barycentric.tolist()
    ([0, 1], [[0.25, 0.5, 0.25], [0.0, 0.25, 0.75]])
    >>> two.carry(square.V[:, :2]).tolist()
    [[3.0, 1.0], [1.0, 5.0]]
    """
    F = coarse.F
    around = np.argsort(F.ravel(), kind="stable") // 3
    first = np.concatenate([[0], np.cumsum(np.bincount(F.ravel(), minlength=len(coarse.V)))])
    face, barycentric, away = _nearest(V, coarse.V, F, first, around, coarse.onto)
    return Carrier(coarse, face, barycentric, away)


def _vertex_gradients(V: FloatArray, F: IntArray, UV: FloatArray) -> FloatArray:
    """Gradient of the layout at each vertex, the area-weighted mean of its triangles', (n, 2, 3)."""
    p, q = V[F], UV[F]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    normal = np.cross(e1, e2)
    square = np.einsum("ij,ij->i", normal, normal)
    # A triangle's gradient times its double area: one without area says nothing.
    size = np.sqrt(np.where(square > 0, square, np.inf))[:, None]
    g1, g2 = np.cross(e2, normal) / size, np.cross(normal, e1) / size
    slope = (q[:, 1] - q[:, 0])[:, :, None] * g1[:, None] + (q[:, 2] - q[:, 0])[:, :, None] * g2[:, None]
    corner, n = F.T.ravel(), len(V)
    area = np.bincount(corner, np.tile(np.sqrt(square), 3), n)
    total = np.stack([np.bincount(corner, np.tile(part, 3), n) for part in slope.reshape(-1, 6).T], axis=1)
    return (total / np.where(area > 0, area, 1.0)[:, None]).reshape(-1, 2, 3)


@numba.njit(cache=True)
def _nearest(
    V: FloatArray, P: FloatArray, F: IntArray, first: IntArray, around: IntArray, onto: IntArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Nearest point to each vertex among the triangles about its corner, then about the corner nearest to that point, and so on."""
    n = len(V)
    face, weights, away = np.empty(n, dtype=np.int64), np.empty((n, 3)), np.empty((n, 3))
    rest = np.empty(3)
    for v in range(n):
        corner, least = onto[v], np.inf
        for _ in range(_MOST_HOPS):
            for slot in range(first[corner], first[corner + 1]):
                f = around[slot]
                l1, l2 = _closest(P[F[f, 0]], P[F[f, 1]], P[F[f, 2]], V[v])
                square = 0.0
                for k in range(3):
                    rest[k] = V[v, k] - (1 - l1 - l2) * P[F[f, 0], k] - l1 * P[F[f, 1], k] - l2 * P[F[f, 2], k]
                    square += rest[k] * rest[k]
                if square < least:
                    least, face[v] = square, f
                    weights[v, 0], weights[v, 1], weights[v, 2] = 1 - l1 - l2, l1, l2
                    away[v] = rest
            heaviest = F[face[v], np.argmax(weights[v])]
            if heaviest == corner:
                break
            corner = heaviest
    return face, weights, away


@numba.njit(cache=True)
def _closest(a: FloatArray, b: FloatArray, c: FloatArray, p: FloatArray) -> tuple[float, float]:
    """Weights of b and c at the triangle's point closest to p (Ericson 2005, "Real-Time Collision Detection", 5.1.5)."""
    d1 = d2 = bb = cc = bc = 0.0
    for k in range(3):
        u, v, w = b[k] - a[k], c[k] - a[k], p[k] - a[k]
        d1 += u * w
        d2 += v * w
        bb += u * u
        cc += v * v
        bc += u * v
    if not bb * cc - bc * bc > 0:
        # Without area; some other triangle about the corner will be nearer.
        return 0.0, 0.0
    d3, d4, d5, d6 = d1 - bb, d2 - bc, d1 - bc, d2 - cc
    if d1 <= 0 and d2 <= 0:
        return 0.0, 0.0
    if d3 >= 0 and d4 <= d3:
        return 1.0, 0.0
    if d6 >= 0 and d5 <= d6:
        return 0.0, 1.0
    in_c, in_b, in_a = d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4
    if in_c <= 0 and d1 >= 0 and d3 <= 0:
        return d1 / (d1 - d3), 0.0
    if in_b <= 0 and d2 >= 0 and d6 <= 0:
        return 0.0, d2 / (d2 - d6)
    if in_a <= 0 and d4 - d3 >= 0 and d5 - d6 >= 0:
        along = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 1 - along, along
    whole = in_a + in_b + in_c
    return in_b / whole, in_c / whole
