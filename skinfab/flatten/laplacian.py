"""The cotangent Laplacian of a triangle mesh, from edge lengths made safe for needles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.distortion import shaped_areas
from skinfab.flatten.graph_laplacian import GraphLaplacian
from skinfab.mesh.topology import Topology
from skinfab.tolerances import MOLLIFY

if TYPE_CHECKING:
    from scipy.sparse import csc_array

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Intrinsic:
    """Angles and cotangents of every corner, (m, 3) each, from mollified edge lengths."""

    F: NDArray[np.int64]
    n_vertices: int
    angle: FloatArray
    cotangent: FloatArray

    @property
    def angle_sum(self) -> FloatArray:
        """(n,) rad: sum of the corner angles at each vertex."""
        return np.bincount(self.F.ravel(), self.angle.ravel(), self.n_vertices).astype(np.float64)

    def laplacian(self, *, topology: Topology | None = None) -> GraphLaplacian:
        """The positive semidefinite cotangent matrix, (n, n): the quadratic form of the Dirichlet energy."""
        topology = topology or Topology(self.F)
        # Edge k of a face begins at its corner k, opposite corner k + 2.
        weight = np.bincount(topology.FE.ravel(), self.cotangent[:, [2, 0, 1]].ravel() / 2, len(topology.E))
        return GraphLaplacian(topology.E, weight.astype(np.float64, copy=False), self.n_vertices)

    def stiffness(self) -> csc_array:
        """The same for scipy."""
        return self.laplacian().to_sparse()


def intrinsic(V: FloatArray, F: NDArray[np.int64]) -> Intrinsic:
    """Angles and cotangents of a mesh.

    A triangle without area has no cotangents: its edges are lengthened by the least amount that keeps every
    triangle inequality by a margin (Sharp and Crane 2020, "A Laplacian for Nonmanifold Triangle Meshes",
    section 4.5). Triangles that have a shape, needles too, keep it.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64

    Examples
    --------
    >>> t = intrinsic(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    >>> np.degrees(t.angle).round(6).tolist()
    [[90.0, 45.0, 45.0]]
    """
    a, b, c = np.ascontiguousarray(F.T)
    dot = np.zeros((len(F), 3))
    for x in np.ascontiguousarray(V.T):
        ab, bc, ca = x[b] - x[a], x[c] - x[b], x[a] - x[c]
        for corner, (ahead, behind) in enumerate(((ab, ca), (bc, ab), (ca, bc))):
            dot[:, corner] -= ahead * behind
    area, shaped = shaped_areas(V, F)
    twice_area = 2 * area
    if not shaped.all():
        dot[~shaped], twice_area[~shaped] = _from_lengths(mollified_lengths(V, F)[~shaped])
    return Intrinsic(F, len(V), np.arctan2(twice_area[:, None], dot), dot / twice_area[:, None])


def corners_of_lengths(length: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles and cotangents, (m, 3) each, of triangles given by the edges opposite their corners, (m, 3) mm.

    Examples
    --------
    >>> angle, cotangent = corners_of_lengths(np.array([[5.0, 4, 3]]))
    >>> np.degrees(angle).round(6).tolist(), cotangent.round(6).tolist()
    ([[90.0, 53.130102, 36.869898]], [[0.0, 0.75, 1.333333]])
    """
    dot, twice_area = _from_lengths(length)
    return np.arctan2(twice_area[:, None], dot), dot / twice_area[:, None]


def _from_lengths(length: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Dot products at the corners (m, 3) and twice the areas (m,) of triangles given by their edge lengths, mm^2."""
    a, b, c = length.T
    # Kahan's stable form of Heron's rule keeps its digits on needles.
    high, mid, low = np.sort(length, axis=1)[:, ::-1].T
    product = (high + (mid + low)) * (low - (high - mid)) * (low + (high - mid)) * (high + (mid - low))
    dot = np.stack([b**2 + c**2 - a**2, c**2 + a**2 - b**2, a**2 + b**2 - c**2], axis=1) / 2
    return dot, np.sqrt(np.maximum(product, 0)) / 2


def mollified_lengths(V: FloatArray, F: NDArray[np.int64]) -> FloatArray:
    """Edge lengths opposite each corner, (m, 3) mm, all longer by the least amount that leaves no needle."""
    p = V[F]
    length = np.linalg.norm(p[:, [1, 2, 0]] - p[:, [2, 0, 1]], axis=2)
    slack = length[:, [1, 2, 0]] + length[:, [2, 0, 1]] - length
    return length + max(0.0, float(np.max(MOLLIFY * length.mean() - slack, initial=0.0)))
