"""How far a sensor is stretched by being worn: the membrane part.

The flat skin is put back on the object by the inverse of the flattening. Along a path of unit direction t
a triangle's map J from the plane to the object stretches the conductor by |J t|.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.locate import Locator
from skinfab.mesh.model import Mesh
from skinfab.paths import Line, Path
from skinfab.pieces import Piece

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WrapStrain:
    """Strain of a conductor from lying flat to being worn, 1 = 100 %; positive is stretched.

    Parameters
    ----------
    mean : float
        Weighted by length: the worn length is (1 + mean) times the printed one.
    max : float
        The strain of the largest size, with its sign.
    """

    mean: float
    max: float


def wrap_strain(mesh: Mesh, piece: Piece, path: Path, *, step: float = 0.25, locator: Locator | None = None) -> WrapStrain:
    """Integrate the stretch of putting `piece` back on `mesh` along a path on it.

    Parameters
    ----------
    mesh : Mesh
    piece : Piece
    path : Path
        In the piece frame.
    step : float, mm
        Longest distance of two samples; the midpoint rule over pieces of at most this length.
    locator : Locator, optional
        Of the piece, where it is at hand: making one takes most of the time.

    Raises
    ------
    InputError
        A part of the path lies outside the piece.

    Examples
    --------
    >>> V, F = np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0]]), np.array([[0, 1, 2]])
    >>> half_size = Piece("P1", np.array([0]), np.array([0, 1, 2]), F, V[:, :2] / 2)
    >>> wrap_strain(Mesh(V, F), half_size, Path((Line((1, 1), (3, 1)),)))
    WrapStrain(mean=1.0, max=1.0)
    """
    points, tangents, lengths = _samples(path, step)
    face = (locator or Locator(piece.UV, piece.F)).faces(points)
    if (face < 0).any():
        x, y = points[np.argmax(face < 0)]
        raise InputError(f"the path leaves piece {piece.id} near ({x:.1f}, {y:.1f}) mm; wrap strain needs all of it on the piece")
    used, at = np.unique(face, return_inverse=True)
    stretch = np.linalg.norm(np.einsum("nij,nj->ni", unflattening(mesh, piece, used)[at], tangents), axis=1)
    strain = stretch - 1
    return WrapStrain(mean=float(strain @ lengths / lengths.sum()), max=float(strain[np.argmax(np.abs(strain))]))


def unflattening(mesh: Mesh, piece: Piece, faces: NDArray[np.int64]) -> Array:
    """Jacobian of each of the piece's triangles from the plane to the object, (len(faces), 3, 2)."""
    corners = piece.F[faces]
    space, flat = piece.V(mesh)[corners], piece.UV[corners]
    edges_space = np.stack([space[:, 1] - space[:, 0], space[:, 2] - space[:, 0]], axis=2)
    edges_flat = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], axis=2)
    return edges_space @ np.linalg.inv(edges_flat)


def _samples(path: Path, step: float) -> tuple[Array, Array, Array]:
    """Midpoints (n, 2) mm of short pieces of the path, its unit tangents there (n, 2), the pieces' lengths (n,) mm."""
    points, tangents, lengths = [], [], []
    for s in path.segments:
        count = max(int(np.ceil(s.length / step)), 1)
        middle = (np.arange(count) + 0.5) / count
        points.append(s.point_at(middle))
        if isinstance(s, Line):
            tangents.append(np.tile((s.end - s.start) / s.length, (count, 1)))
        else:
            angle = s.start_angle + s.sweep * middle + np.sign(s.sweep) * np.pi / 2
            tangents.append(np.column_stack([np.cos(angle), np.sin(angle)]))
        lengths.append(np.full(count, s.length / count))
    return np.concatenate(points), np.concatenate(tangents), np.concatenate(lengths)
