"""A few as-rigid-as-possible steps: the cheap way to near the least d.

Every step turns each triangle's own shape to fit the present layout and lays all of them out again by one
solve (Liu et al. 2008, "A Local/Global Approach to Mesh Parameterization"). One factorisation of an (n, n)
matrix serves all steps, where a Newton step on d factors a (2n, 2n) one: from BFF's layout the first step
comes within half a percent of the least d.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from skinfab.flatten.isometric import rest_triangles
from skinfab.linalg import Cholesky
from skinfab.tolerances import NEWTON_RIDGE, RIGID_WEIGHT

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def rigid_steps(V: FloatArray, F: IntArray, UV: FloatArray, *, steps: int, rest: FloatArray | None = None) -> FloatArray:
    """`UV` after that many local/global steps, (n, 2) mm; triangles may be flipped afterwards.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
    UV : (n, 2) float64, mm
    steps : int
    rest : (m, 2, 2) float64, mm, optional
        `rest_triangles` of the mesh, where they are at hand.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> F = np.array([[0, 1, 2], [0, 2, 3]])
    >>> bent = V[:, :2] * [1.2, 0.9]
    >>> rigid_steps(V, F, bent, steps=50).max(axis=0).round(3).tolist()
    [1.1, 0.95]
    """
    n = len(V)
    # Negative weights would push triangles over.
    rest = rest_triangles(V, F) if rest is None else rest
    weight = np.maximum(_cotangents(rest), RIGID_WEIGHT) / 2
    i, j, w = F[:, [1, 2, 0]].ravel(), F[:, [2, 0, 1]].ravel(), weight.ravel()
    low, high = np.minimum(i, j), np.maximum(i, j)
    diagonal = np.bincount(i, w, n) + np.bincount(j, w, n)
    everyone = np.arange(n)
    lower = coo_array(
        (np.concatenate([-w, diagonal * (1 + NEWTON_RIDGE)]), (np.concatenate([high, everyone]), np.concatenate([low, everyone]))),
        shape=(n, n),
    )
    solver = Cholesky(csc_array(lower))
    u = np.ascontiguousarray(UV)
    for _ in range(steps):
        # The ridge pulls towards where the layout is, not towards the origin.
        u = solver.solve(_turned_edges(u, F, rest, weight) + NEWTON_RIDGE * diagonal[:, None] * u)
    return u


def _cotangents(rest: FloatArray) -> FloatArray:
    """At each corner of the triangles (0, 0), (base, 0), (x, y): (m, 3)."""
    base, x, y = rest[:, 0, 0], rest[:, 1, 0], rest[:, 1, 1]
    return np.stack([x / y, (base - x) / y, (y * y - x * (base - x)) / (base * y)], axis=1)


@numba.njit(cache=True)
def _turned_edges(u: FloatArray, F: IntArray, rest: FloatArray, weight: FloatArray) -> FloatArray:
    """The right side of the global step: weighted edges of the rest triangles, each turned to fit the layout."""
    out = np.zeros_like(u)
    x = np.zeros((3, 2))
    for f in range(F.shape[0]):
        x[1], x[2] = rest[f, 0], rest[f, 1]
        c = s = 0.0
        for k in range(3):
            p, q = (k + 1) % 3, (k + 2) % 3
            ex, ey = x[p, 0] - x[q, 0], x[p, 1] - x[q, 1]
            ux, uy = u[F[f, p], 0] - u[F[f, q], 0], u[F[f, p], 1] - u[F[f, q], 1]
            c += weight[f, k] * (ex * ux + ey * uy)
            s += weight[f, k] * (ex * uy - ey * ux)
        size = np.hypot(c, s)
        if size == 0.0:
            c, size = 1.0, 1.0
        c, s = c / size, s / size
        for k in range(3):
            p, q = (k + 1) % 3, (k + 2) % 3
            ex, ey = x[p, 0] - x[q, 0], x[p, 1] - x[q, 1]
            tx, ty = weight[f, k] * (c * ex - s * ey), weight[f, k] * (s * ex + c * ey)
            out[F[f, p], 0] += tx
            out[F[f, p], 1] += ty
            out[F[f, q], 0] -= tx
            out[F[f, q], 1] -= ty
    return out
