"""Tutte's embedding: a disk laid in a circle with no flip, the safe start when BFF's has one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from skinfab.linalg import Cholesky
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]


def tutte_embedding(V: FloatArray, F: NDArray[np.int64], *, topology: Topology | None = None) -> FloatArray:
    """Every inner vertex at the mean of its neighbours, the boundary on a circle of the disk's area (Tutte 1963).

    Boundary vertices are spaced by edge length, evenly where an edge has no length. Uniform weights, because
    positive ones are what makes the embedding free of flips. Where an inner edge joins two boundary vertices
    the convex position of the circle keeps its triangles open.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        A disk.
    topology : Topology, optional

    Returns
    -------
    (n, 2) float64, mm

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 7]])
    >>> F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> np.abs(tutte_embedding(V, F)[4]).round(9).tolist()
    [0.0, 0.0]
    """
    topology = topology or Topology(F)
    loop = topology.boundary_loops[0]
    length = np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1)
    length = np.maximum(length, length.mean() * 1e-3)
    around = 2 * np.pi * np.concatenate([[0.0], np.cumsum(length)[:-1]]) / length.sum()
    p = V[F]
    area = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2
    uv = np.zeros((len(V), 2))
    uv[loop] = np.sqrt(area / np.pi) * np.stack([np.cos(around), np.sin(around)], axis=1)
    inner = np.ones(len(V), dtype=bool)
    inner[loop] = False
    if inner.any():
        i, j = topology.E.T
        ones = np.ones(len(i))
        A = csc_array(coo_array((np.r_[ones, ones], (np.r_[i, j], np.r_[j, i])), shape=(len(V), len(V))))
        L = csc_array(coo_array((np.asarray(A.sum(axis=0)).ravel(), (np.arange(len(V)), np.arange(len(V)))), shape=A.shape)) - A
        free = np.flatnonzero(inner)
        uv[free] = Cholesky(csc_array(L[free][:, free])).solve(-(L[free][:, loop] @ uv[loop]))
    return uv
