"""The map between the object and one of its flat pieces, both ways, for many points at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.flatten.locate import Locator
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.tolerances import WEIGHT_SUM

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on the object.

    Parameters
    ----------
    face : (n,) int64
        Faces of the mesh; -1 where there is no such point.
    barycentric : (n, 3) float
        Weights of the face's corners; NaN where there is no such point.
    xyz : (n, 3) float64, mm
    """

    face: IntArray
    barycentric: FloatArray
    xyz: FloatArray


class FlatMap:
    """Object to flat piece and back: build once, ask for many points at a time.

    Parameters
    ----------
    mesh : Mesh
    piece : Piece
        Of that mesh, without overlap; where it has one, a flat point has several places, of which one is given.

    Examples
    --------
    >>> mesh = Mesh(np.array([[0.0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> two = Piece("P1", np.arange(2), np.arange(4), mesh.F, 10 * mesh.V[:, :2])
    >>> both_ways = FlatMap(mesh, two)
    >>> both_ways.to_flat([1], [[0.5, 0.0, 0.5]]).tolist()
    [[0.0, 5.0]]
    >>> both_ways.to_object([[9.0, 1.0]]).xyz.round(9).tolist()
    [[0.9, 0.1, 5.0]]
    >>> uv, away = both_ways.nearest([[0.25, 0.5, 7.0]])
    >>> uv.tolist(), away.tolist()
    ([[2.5, 5.0]], [2.0])
    """

    def __init__(self, mesh: Mesh, piece: Piece) -> None:
        self._piece = piece
        self._V = piece.V(mesh)
        self._locator = Locator(piece.UV, piece.F)
        self._local = np.full(len(mesh.F), -1)
        self._local[piece.faces] = np.arange(len(piece.faces))

    def to_flat(self, face: ArrayLike, barycentric: ArrayLike) -> FloatArray:
        """Where points of the object lie on the piece.

        Parameters
        ----------
        face : (n,) int
            Faces of the mesh.
        barycentric : (n, 3) float

        Returns
        -------
        (n, 2) float64, mm

        Raises
        ------
        InputError
            A face that is not on this piece, or not three weights of sum 1 for each face.
        """
        faces, weights = np.asarray(face, dtype=np.int64).reshape(-1), np.asarray(barycentric, dtype=np.float64)
        if weights.shape != (len(faces), 3):
            raise InputError(f"{len(faces)} faces need as many rows of three barycentric weights; these have the shape {weights.shape}")
        wrong = ~(np.abs(weights.sum(axis=1) - 1) <= WEIGHT_SUM)
        if wrong.any():
            k = int(np.argmax(wrong))
            raise InputError(f"point {k}: barycentric weights sum to 1; these are {weights[k].tolist()}")
        inside = (faces >= 0) & (faces < len(self._local))
        local = np.where(inside, self._local[np.where(inside, faces, 0)], -1)
        if (local < 0).any():
            k = int(np.argmax(local < 0))
            raise InputError(f"point {k}: face {faces[k]} is not on piece {self._piece.id}; ask the piece that has it")
        return _weighted(self._piece.UV, self._piece.F[local], weights)

    def to_object(self, points_uv: ArrayLike) -> SurfacePoints:
        """Where points (n, 2) mm of the piece lie on the object; -1 and NaN for those beside the piece."""
        local, weights = self._locator.barycentric(points_uv)
        beside = local < 0
        weights[beside] = np.nan
        xyz = _weighted(self._V, self._piece.F[local], weights)
        return SurfacePoints(np.where(beside, -1, self._piece.faces[local]), weights, xyz)

    def nearest(self, points_xyz: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """The piece's points nearest to points (n, 3) mm in space: their flat places (n, 2) mm, and how far they are (n,) mm.

        Raises
        ------
        InputError
            A coordinate is not finite.
        """
        import igl

        points = np.ascontiguousarray(np.asarray(points_xyz, dtype=np.float64).reshape(-1, 3))
        if not np.isfinite(points).all():
            raise InputError(f"point {int(np.argmin(np.isfinite(points).all(axis=1)))} has a coordinate that is not a finite number")
        F = self._piece.F
        _, local, foot = igl.point_mesh_squared_distance(points, self._V, F)
        weights = _barycentric(self._V[F[local]], foot)
        return _weighted(self._piece.UV, F[local], weights), np.linalg.norm(points - foot, axis=1)


def _weighted(values: FloatArray, F: IntArray, weights: FloatArray) -> FloatArray:
    # Three takes and sums are several times as fast as one (n, 3, d) gather.
    return sum((weights[:, k, None] * values[F[:, k]] for k in (1, 2)), weights[:, :1] * values[F[:, 0]])


def _barycentric(triangle: FloatArray, p: FloatArray) -> FloatArray:
    """Weights (n, 3) of the corners (n, 3, 3) at points (n, 3) on the triangles; a triangle without area gives its longest edge's."""
    a, b, c = np.moveaxis(triangle, 1, 0)
    normal = np.cross(b - a, c - a)
    double = np.einsum("ni,ni->n", normal, normal)
    size = np.where(double > 0, double, 1.0)
    weights = np.column_stack(
        [np.einsum("ni,ni->n", np.cross(c - b, p - b), normal), np.einsum("ni,ni->n", np.cross(a - c, p - c), normal)]
    )
    weights /= size[:, None]
    result = np.column_stack([weights, 1 - weights.sum(axis=1)])
    for n in np.flatnonzero(double == 0):
        result[n] = _on_longest_edge(triangle[n], p[n])
    return result


def _on_longest_edge(corners: FloatArray, p: FloatArray) -> FloatArray:
    edge = np.roll(corners, -1, axis=0) - corners
    k = int(np.argmax(np.einsum("ki,ki->k", edge, edge)))
    square = float(edge[k] @ edge[k])
    t = float(np.clip((p - corners[k]) @ edge[k] / square, 0, 1)) if square > 0 else 0.0
    weights = np.zeros(3)
    weights[k], weights[(k + 1) % 3] = 1 - t, t
    return weights
