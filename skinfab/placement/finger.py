"""Strain sensors: along what bends, across its joint; a finger's middle one unless a joint is named."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.base import Pattern
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.search import Poses, first_fit, poses_around
from skinfab.placement.sensor import Sensor
from skinfab.placement.space import Footprint, Space, need_of
from skinfab.placement.wrap_strain import unflattening

Array = NDArray[np.float64]

#: A finger is this long, mm, from a child's to a large robot's.
_FINGER_LENGTH = (30.0, 130.0)
#: And at least this many times as long as it is wide.
_FINGER_SLENDERNESS = 2.0
#: The paper's two sensors, robot and human finger: l1, l2, b.
_SEED_SIZES = ((60.0, 54.0, 6.0), (53.0, 43.0, 6.0))
#: Then the human one made smaller.
_SMALLER = (0.85, 0.7, 0.6, 0.5, 0.4, 0.32)
#: The joint lies within the middle part of what senses: this fraction of its span to either side.
_SPAN = 0.25
#: Angles tried off the finger's axis as it runs on the flat piece, rad.
_TURNS = tuple(np.deg2rad([0.0, 5.0, -5.0, 10.0, -10.0]))
_PLACES = 1500
#: Places are compared by room to spare among those equally near to the joint, in steps of this, mm.
_NEARNESS = 3.0
#: A place faces a direction where the surface's normal is no farther from it than this: cosine of 45 degrees.
_FACING = 0.5**0.5


@dataclass(frozen=True, eq=False)
class Joint:
    """Where something bends, and how.

    Parameters
    ----------
    at : (3,) float, mm
        A point of the joint: inside it, or on the side of it that the sensor is to be on.
    along : (3,) float
        Direction that is stretched by bending, of length 1.
    facing : (3,) float, optional
        The sensor goes where the surface faces this way, to 45 degrees: the back of a finger, for instance. Of length 1.
    near : bool
        Whether places near `at` come first; otherwise all those at its height are equal.
    """

    at: Array
    along: Array
    facing: Array | None = None
    near: bool = True

    @staticmethod
    def middle_of(mesh: Mesh, *, facing: Array | None = None) -> Joint:
        """Half-way along the object's long axis: the middle joint of a finger, for want of more knowledge."""
        axis = long_axis(mesh)[0][0]
        along = mesh.V[np.unique(mesh.F)] @ axis
        return Joint((along.min() + along.max()) / 2 * axis, axis, facing, near=False)


def facing_faces(mesh: Mesh, space: Space, facing: Array | None) -> NDArray[np.bool_]:
    """Which faces of a piece look in a direction, (k,) bool; all of them for None."""
    if facing is None:
        return np.ones(len(space.piece.F), dtype=bool)
    return np.asarray(mesh.face_normals[space.piece.faces] @ facing >= _FACING)


def long_axis(mesh: Mesh) -> tuple[Array, Array]:
    """Directions (3, 3), one a row, longest extent first, and the extents of the object along them, (3,) mm.

    The directions are the principal axes of the surface, each triangle weighted by its area.
    """
    centres = mesh.V[mesh.F].mean(axis=1)
    weights = mesh.face_areas / mesh.face_areas.sum()
    from_middle = centres - weights @ centres
    _, axes = np.linalg.eigh((from_middle * weights[:, None]).T @ from_middle)
    rows = axes.T
    extents = np.ptp(mesh.V[np.unique(mesh.F)] @ axes, axis=0)
    order = np.argsort(-extents, kind="stable")
    return rows[order], extents[order]


def is_finger(mesh: Mesh) -> bool:
    """Whether an object is taken for a finger: 30 to 130 mm long and at least twice as long as wide or deep.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [90, 0, 0], [0, 20, 0], [90, 20, 18]])
    >>> is_finger(Mesh(V, np.array([[0, 1, 2], [1, 3, 2]]))), is_finger(Mesh(V / 4, np.array([[0, 1, 2], [1, 3, 2]])))
    (True, False)
    """
    _, extents = long_axis(mesh)
    low, high = _FINGER_LENGTH
    return bool(low <= extents[0] <= high and extents[0] >= _FINGER_SLENDERNESS * extents[1])


def strain_sizes(material: Material) -> Iterator[StrainLines]:
    """Strain sensors from the largest to the smallest that the material's bead and gap allow."""
    l1, l2, b = _SEED_SIZES[-1]
    narrow = max(b * 0.75, 3 * (material.ink.bead_width + material.gap))
    smaller = [(round(l1 * k, 1), round(l2 * k, 1), b if k > 0.6 else narrow) for k in _SMALLER]
    for size in (*_SEED_SIZES, *smaller):
        try:
            yield StrainLines(l1=size[0], l2=size[1], b=size[2], bead=material.ink.bead_width, gap=material.gap, pad=material.pad)
        except InputError:
            continue  # a wide bead leaves no room for this size


def place_strain(
    mesh: Mesh,
    spaces: Sequence[Space],
    patterns: Sequence[Pattern],
    *,
    material: Material,
    rng: np.random.Generator,
    joint: Joint | None = None,
) -> Sensor | None:
    """One strain sensor, the first of `patterns` that fits, along what is stretched and with its span across the joint.

    The direction is pulled back to the flat piece by the flattening's Jacobian where the sensor lies.

    Parameters
    ----------
    mesh : Mesh
    spaces : sequence of Space
    patterns : sequence of Pattern
    material : Material
    rng : Generator
    joint : Joint, optional
        Else half-way along the long axis.

    Returns
    -------
    Sensor or None
        With its id and channel still open; None where none fits.
    """
    joint = joint or Joint.middle_of(mesh)
    band = max((p.span for p in patterns), default=0.0) * _SPAN
    near = _places_near(mesh, spaces, joint, band=band, rng=rng)
    for pattern in patterns:
        footprint = Footprint.of(pattern)
        best: list[tuple[float, float, int, Poses, int]] = []
        for which, (space, found) in enumerate(zip(spaces, near, strict=True)):
            ok = np.abs(found.offsets) <= _SPAN * pattern.span
            if not ok.any():
                continue
            for turn in (*_TURNS, *(t + np.pi for t in _TURNS)):
                need = need_of(pattern, material)
                poses = poses_around(space.raster, footprint, found.places[ok], found.directions[ok] + turn, need=need)
                nearness = np.floor(found.away[ok] / _NEARNESS)
                k = np.lexsort((-poses.slack, nearness))
                k = k[poses.slack[k] > -space.raster.step][:3]
                best += [(nearness[i], -poses.slack[i], which, poses, int(i)) for i in k]
        for _, _, which, poses, i in sorted(best, key=lambda c: c[:3])[:24]:
            sensor = first_fit(spaces[which], pattern, footprint, poses, [i], between_creases=False)
            if sensor:
                return sensor
    return None


@dataclass(frozen=True, eq=False)
class _Near:
    """Places on a piece near a joint: (n, 2) mm; the direction to be sensed there (n,) rad; how far along it the joint is (n,) mm, and
    how far away altogether (n,) mm."""

    places: Array
    directions: Array
    offsets: Array
    away: Array


def _places_near(mesh: Mesh, spaces: Sequence[Space], joint: Joint, *, band: float, rng: np.random.Generator) -> list[_Near]:
    """For each piece the places no more than `band` from the joint along what is stretched, on the side that it names."""
    found = [_places_on(mesh, space, joint, band=band, rng=rng) for space in spaces]
    # A joint inside the object is as far from its whole circumference: that much is nobody's fault.
    beside = [np.sqrt(np.maximum(away**2 - offsets**2, 0.0)) for _, _, offsets, away in found]
    least = min((float(b.min()) for b in beside if len(b)), default=0.0)
    excess = [b - least if joint.near else np.zeros(len(b)) for b in beside]
    return [_Near(p, d, o, np.hypot(o, e)) for (p, d, o, _), e in zip(found, excess, strict=True)]


def _places_on(mesh: Mesh, space: Space, joint: Joint, *, band: float, rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
    """Places, directions, offsets along, and distances from the joint's point."""
    raster, piece = space.raster, space.piece
    none = np.zeros((0, 2)), np.zeros(0), np.zeros(0), np.zeros(0)
    from_joint = piece.V(mesh) - joint.at
    heights = from_joint @ joint.along
    if heights.min() > band or heights.max() < -band:
        return none
    places = raster.centres(raster.clearance > space.material.margin)
    face, weights = space.locator.barycentric(places)
    corners = piece.F[face]
    offset = np.einsum("nk,nk->n", weights, heights[corners])
    keep = np.flatnonzero((face >= 0) & (np.abs(offset) <= band) & facing_faces(mesh, space, joint.facing)[face])
    if len(keep) > _PLACES:
        keep = np.sort(rng.choice(keep, _PLACES, replace=False))
    if not len(keep):
        return none
    J = unflattening(mesh, piece, face[keep])
    # The flat direction that runs up the axis fastest: the gradient J^T a, made a direction by the metric J^T J.
    flat = np.linalg.solve(np.swapaxes(J, 1, 2) @ J, (np.swapaxes(J, 1, 2) @ joint.along)[..., None])[..., 0]
    away = np.linalg.norm(np.einsum("nk,nkd->nd", weights[keep], from_joint[corners[keep]]), axis=1)
    return places[keep], np.arctan2(flat[:, 1], flat[:, 0]), offset[keep], away
