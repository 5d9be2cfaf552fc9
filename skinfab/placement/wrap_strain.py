"""How far a sensor is stretched by being worn, and what that does to its resistance.

The flat skin is put back on the object by the inverse of the flattening. Along a path of unit direction t a triangle's
map J from the plane to a surface stretches what lies there by |J t|. Two surfaces count:

* the skin's neutral one, half-way through its thickness unless said otherwise: what is stretched there is the *membrane*
  part. It is nothing where that surface was flattened without distortion, and what a skin lacks in girth where the
  object's own surface was flattened;
* the one the conductor lies in, as high over the skin's inner side as it was printed over the floor of the mould. What it
  is stretched beyond the neutral one is the *bending* part: normal curvature along the path times the distance of the
  two surfaces, positive where a conductor outside the neutral surface goes round something convex. Each side of a sharp
  edge has an offset of its own, so that a flat face does not bend; what an edge bends is where a path crosses it
  (`skinfab.placement.fold_strain`).

The flat pieces are seen from outside the object, and are cast and printed that way up: the side on the mould's floor is
the inner one, which lies on the object. A printed line keeps its volume, so that its resistance goes with (1 + e)^2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.locate import Locator
from skinfab.mesh.creases import split_at_creases
from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import offset_mesh, outward_steps
from skinfab.paths import Line, Path
from skinfab.pieces import Piece
from skinfab.placement.fold_strain import fold_lengthening

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Strain:
    """One part of the strain along a path, 1 = 100 %; positive is stretched.

    Parameters
    ----------
    mean : float
        Weighted by length.
    max : float
        The strain of the largest size, with its sign.
    """

    mean: float
    max: float


@dataclass(frozen=True)
class WrapStrain:
    """Strain of a conductor from lying flat to being worn, 1 = 100 %; positive is stretched.

    Parameters
    ----------
    mean : float
        Weighted by length: the worn length is (1 + mean) times the printed one.
    max : float
        The strain of the largest size, with its sign.
    membrane, bending : Strain
        The parts; their means add up to `mean`.
    worn_length : float, mm
        On the object.
    resistance_factor : float
        Resistance of the worn line over that of the flat one: (1 + e)^2 averaged along it.
    """

    mean: float
    max: float
    membrane: Strain
    bending: Strain
    worn_length: float
    resistance_factor: float


@dataclass(frozen=True, eq=False)
class WornSkin:
    """The surfaces of a worn skin that matter to its conductors.

    Parameters
    ----------
    neutral : Mesh
        That is not stretched by bending.
    conductor : Mesh
        In which the conductors lie; same faces, with vertices doubled along sharp edges, whose sides are apart there.
    beyond : float, mm
        How far outside the neutral surface that is.
    even : float, mm
        Strain is averaged over this length of path: a skin bridges what is shorter than it is thick, as the bumps of a scan. So is
        bending before, by itself: a skin cannot follow an edge but bends over about as much path as it is thick.
    """

    neutral: Mesh
    conductor: Mesh
    beyond: float = 0.0
    even: float = 0.0


@dataclass(frozen=True, eq=False)
class StrainAlong:
    """Strain of short pieces of a path, in their order.

    Parameters
    ----------
    points : (n, 2) mm
        Their middles, in the piece frame.
    lengths : (n,) mm
    membrane, bending : (n,)
    """

    points: Array
    lengths: Array
    membrane: Array
    bending: Array

    @property
    def together(self) -> Array:
        """(n,) membrane and bending."""
        return self.membrane + self.bending


def worn_skin(
    object_mesh: Mesh, flattened: Mesh, *, flattened_at: float, neutral_at: float, conductor_at: float, even: float = 0.0
) -> WornSkin:
    """The neutral surface and the conductors' one, at their distances outside an object.

    Parameters
    ----------
    object_mesh : Mesh
    flattened : Mesh
        The surface that was flattened; same faces and vertices.
    flattened_at, neutral_at, conductor_at : float, mm
        Distance outside the object of the surface that was flattened (0: the object's own), of the neutral one and of the
        conductors' one.
    even : float, mm
        See `WornSkin`.
    """
    if neutral_at == flattened_at:
        neutral = flattened
    elif flattened_at > 0:
        step = (flattened.V - object_mesh.V) / flattened_at
        neutral = Mesh(object_mesh.V + neutral_at * step, object_mesh.F, object_mesh.name)
    else:
        neutral = offset_mesh(object_mesh, neutral_at, round_off=True).mesh
    beyond = conductor_at - neutral_at
    if beyond == 0:
        return WornSkin(neutral, neutral, even=even)
    apart = split_at_creases(neutral)
    return WornSkin(neutral, Mesh(apart.V + beyond * outward_steps(apart), apart.F, apart.name), beyond=beyond, even=even)


def wrap_strain(worn: WornSkin | Mesh, piece: Piece, path: Path, *, step: float = 0.25, locator: Locator | None = None) -> WrapStrain:
    """Integrate the stretch of putting `piece` back on the object along a path on it.

    Parameters
    ----------
    worn : WornSkin or Mesh
        A mesh stands for a skin without thickness on it.
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
    >>> strain = wrap_strain(Mesh(V, F), half_size, Path((Line((1, 1), (3, 1)),)))
    >>> strain.mean, strain.max, strain.bending.mean, strain.worn_length, strain.resistance_factor
    (1.0, 1.0, 0.0, 4.0, 4.0)
    """
    return summary(strain_along(worn, piece, path, step=step, locator=locator), even=worn.even if isinstance(worn, WornSkin) else 0.0)


def strain_along(worn: WornSkin | Mesh, piece: Piece, path: Path, *, step: float = 0.25, locator: Locator | None = None) -> StrainAlong:
    """As `wrap_strain`, point by point and not averaged."""
    if isinstance(worn, Mesh):
        worn = WornSkin(worn, worn)
    points, tangents, lengths, ends = _samples(path, step)
    face = (locator or Locator(piece.UV, piece.F)).faces(points)
    if (face < 0).any():
        x, y = points[np.argmax(face < 0)]
        raise InputError(f"the path leaves piece {piece.id} near ({x:.1f}, {y:.1f}) mm; wrap strain needs all of it on the piece")
    used, at = np.unique(face, return_inverse=True)

    def stretch(mesh: Mesh) -> Array:
        length: Array = np.linalg.norm(np.einsum("nij,nj->ni", unflattening(mesh, piece, used)[at], tangents), axis=1)
        return length

    neutral = stretch(worn.neutral)
    bending = np.zeros(len(points))
    if worn.conductor is not worn.neutral:
        bending = stretch(worn.conductor) - neutral + fold_lengthening(worn.neutral, piece, ends, worn.beyond) / lengths
        bending = running_mean(bending, lengths, worn.even)
    return StrainAlong(points, lengths, neutral - 1, bending)


def summary(along: StrainAlong, *, even: float = 0.0) -> WrapStrain:
    """Mean and extremes of the strain along a path, and what follows from it.

    Parameters
    ----------
    along : StrainAlong
    even : float, mm
        Extremes and resistance are those of the mean over this length of path.
    """
    together = _strain(along.together, along.lengths, even)
    evened = running_mean(along.together, along.lengths, even)
    length = float(along.lengths.sum())
    return WrapStrain(
        mean=together.mean,
        max=together.max,
        membrane=_strain(along.membrane, along.lengths, even),
        bending=_strain(along.bending, along.lengths, even),
        worn_length=(1 + together.mean) * length,
        resistance_factor=float((1 + evened) ** 2 @ along.lengths / length),
    )


def running_mean(values: Array, lengths: Array, window: float) -> Array:
    """Mean of `values` (n,) over `window` mm about the middle of each piece of a path, which goes on beyond its ends as in a mirror.

    So the mean of the whole stays what it was.

    Examples
    --------
    >>> running_mean(np.array([0.0, 3, 0, 0]), np.ones(4), 3.0).tolist()
    [1.0, 1.0, 1.0, 0.0]
    """
    if window <= 0:
        return values
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    total = np.concatenate([[0.0], np.cumsum(values * lengths)])
    middle, half = (ends[1:] + ends[:-1]) / 2, min(window / 2, ends[-1])
    # The integral of what is even about either end.
    ends = np.concatenate([-ends[:0:-1], ends, 2 * ends[-1] - ends[-2::-1]])
    total = np.concatenate([-total[:0:-1], total, 2 * total[-1] - total[-2::-1]])
    mean: Array = (np.interp(middle + half, ends, total) - np.interp(middle - half, ends, total)) / (2 * half)
    return mean


def unflattening(mesh: Mesh, piece: Piece, faces: NDArray[np.int64]) -> Array:
    """Jacobian of each of the piece's triangles from the plane to the object, (len(faces), 3, 2)."""
    space, flat = mesh.V[mesh.F[piece.faces[faces]]], piece.UV[piece.F[faces]]
    edges_space = np.stack([space[:, 1] - space[:, 0], space[:, 2] - space[:, 0]], axis=2)
    edges_flat = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], axis=2)
    return edges_space @ np.linalg.inv(edges_flat)


def _strain(values: Array, lengths: Array, even: float) -> Strain:
    evened = running_mean(values, lengths, even)
    return Strain(mean=float(values @ lengths / lengths.sum()), max=float(evened[np.argmax(np.abs(evened))]))


def _samples(path: Path, step: float) -> tuple[Array, Array, Array, Array]:
    """Short pieces of the path: middles (n, 2) mm, unit tangents there (n, 2), lengths (n,) mm, starts and ends (n, 2, 2) mm."""
    points, tangents, lengths, ends = [], [], [], []
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
        between = s.point_at(np.arange(count + 1) / count)
        ends.append(np.stack([between[:-1], between[1:]], axis=1))
    return np.concatenate(points), np.concatenate(tangents), np.concatenate(lengths), np.concatenate(ends)
