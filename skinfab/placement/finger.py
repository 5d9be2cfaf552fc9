"""Strain sensors for fingers: along the finger, across its middle joint."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
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
#: The joint lies within the middle part of the loops: this fraction of l2 to either side.
_SPAN = 0.25
#: Angles tried off the finger's axis as it runs on the flat piece, rad.
_TURNS = tuple(np.deg2rad([0.0, 5.0, -5.0, 10.0, -10.0]))
_PLACES = 1500
#: Places are compared by room to spare among those equally near to the joint, in steps of this, mm.
_NEARNESS = 3.0


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
    mesh: Mesh, spaces: Sequence[Space], patterns: Sequence[StrainLines], *, material: Material, rng: np.random.Generator
) -> Sensor | None:
    """One strain sensor, the first of `patterns` that fits, along the long axis with its loops across the middle of the length.

    The middle stands for the middle joint for want of more knowledge. The axis is pulled back to the flat
    piece by the flattening's Jacobian where the sensor lies.

    Returns
    -------
    Sensor or None
        With its id and channel still open; None where none fits.
    """
    axis = long_axis(mesh)[0][0]
    along = mesh.V[np.unique(mesh.F)] @ axis
    joint = (along.min() + along.max()) / 2
    band = max((p.l2 for p in patterns), default=0.0) * _SPAN
    near = [_places_near(mesh, space, axis, joint, band=band, rng=rng) for space in spaces]
    for pattern in patterns:
        footprint = Footprint.of(pattern)
        best: list[tuple[float, float, int, Poses, int]] = []
        for which, (space, (places, directions, offsets)) in enumerate(zip(spaces, near, strict=True)):
            ok = np.abs(offsets) <= _SPAN * pattern.l2
            if not ok.any():
                continue
            for turn in (*_TURNS, *(t + np.pi for t in _TURNS)):
                poses = poses_around(space.raster, footprint, places[ok], directions[ok] + turn, need=need_of(pattern, material))
                nearness = np.floor(np.abs(offsets[ok]) / _NEARNESS)
                k = np.lexsort((-poses.slack, nearness))
                k = k[poses.slack[k] > -space.raster.step][:3]
                best += [(nearness[i], -poses.slack[i], which, poses, int(i)) for i in k]
        for _, _, which, poses, i in sorted(best, key=lambda c: c[:3])[:24]:
            found = first_fit(spaces[which], pattern, footprint, poses, [i], between_creases=False)
            if found:
                return found
    return None


def _places_near(
    mesh: Mesh, space: Space, axis: Array, joint: float, *, band: float, rng: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Places (n, 2) mm on a piece no more than `band` from the joint, the axis' direction there (n,) rad, the offset (n,) mm."""
    raster, piece = space.raster, space.piece
    heights = piece.V(mesh) @ axis - joint
    if heights.min() > band or heights.max() < -band:
        return np.zeros((0, 2)), np.zeros(0), np.zeros(0)
    places = raster.centres(raster.clearance > space.material.margin)
    face, weights = space.locator.barycentric(places)
    offset = np.einsum("nk,nk->n", weights, heights[piece.F[face]])
    keep = np.flatnonzero((face >= 0) & (np.abs(offset) <= band))
    if len(keep) > _PLACES:
        keep = np.sort(rng.choice(keep, _PLACES, replace=False))
    if not len(keep):
        return np.zeros((0, 2)), np.zeros(0), np.zeros(0)
    J = unflattening(mesh, piece, face[keep])
    # The flat direction that runs up the axis fastest: the gradient J^T a, made a direction by the metric J^T J.
    flat = np.linalg.solve(np.swapaxes(J, 1, 2) @ J, (np.swapaxes(J, 1, 2) @ axis)[..., None])[..., 0]
    return places[keep], np.arctan2(flat[:, 1], flat[:, 0]), offset[keep]
