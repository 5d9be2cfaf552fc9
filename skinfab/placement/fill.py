"""Filling a part of a piece with contact sensors, the largest first."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from skinfab.patterns.base import Pattern
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.placement.raster import Raster
from skinfab.placement.search import Poses, first_fit, nudged_fit, poses_in
from skinfab.placement.sensor import Sensor
from skinfab.placement.space import Footprint, Space, need_of

#: Terminals point in so many directions, evenly spread from the direction of the piece's longest edge on.
_DIRECTIONS = 24


@dataclass(frozen=True, eq=False)
class Region:
    """A part of a piece that is filled by itself.

    Parameters
    ----------
    space : Space
        The piece.
    cells : (rows, columns) bool
        Of the piece's raster.
    between_creases : bool
        Whether sensors keep off the creases.
    """

    space: Space
    cells: NDArray[np.bool_]
    between_creases: bool

    @property
    def raster(self) -> Raster:
        """The one that `cells` belong to."""
        return self.space.facets if self.between_creases else self.space.raster

    @cached_property
    def area(self) -> float:
        """mm^2, but for the cells that edges run through."""
        return float(self.cells.sum() * self.raster.step**2)

    @cached_property
    def axes(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Its middle (2,) mm, and the directions of its greatest and its least extent, the columns of (2, 2)."""
        places = self.raster.centres(self.cells)
        middle = places.mean(axis=0)
        return middle, np.linalg.eigh(np.cov((places - middle).T))[1][:, ::-1]

    def copy(self) -> Region:
        """The same region on a copy of its piece, to try on."""
        twin = Region(self.space.copy(), self.cells, self.between_creases)
        if "axes" in self.__dict__:
            twin.__dict__["axes"] = self.axes
        return twin


def regions_of(space: Space, pattern: Pattern, *, between_creases: bool) -> list[Region]:
    """Connected parts of a piece that may have room for a pattern, the roomiest first."""
    raster = space.facets if between_creases else space.raster
    count, label = raster.regions()
    if not count:
        return []
    least = Footprint.of(pattern).reach + need_of(pattern, space.material) - raster.step
    room = np.asarray(ndimage.maximum(raster.clearance, label, np.arange(1, count + 1)))
    return [Region(space, label == k + 1, between_creases) for k in np.argsort(-room, kind="stable") if room[k] >= least]


def fill(region: Region, spirals: Sequence[ContactSpiral], limit: int, rng: np.random.Generator, *, beside: float) -> list[Sensor]:
    """Up to `limit` spirals from the largest down: spread out where as large ones fit so, else packed from one end.

    Parameters
    ----------
    region : Region
        Left as it is.
    spirals : sequence of ContactSpiral
        The largest first.
    limit : int
    rng : Generator
    beside : float, mm
        A second sensor beside another is at least this large.
    """
    found = _series(region, spirals, limit, rng, packed=False, beside=beside)
    # As many as may be, all of the largest size, cannot be bettered by packing.
    if limit > 1 and _covered(found) < limit * spirals[0].s ** 2:
        packed = _series(region, spirals, limit, rng, packed=True, beside=beside)
        if _covered(packed) > _covered(found):
            found = packed
    return found


def _series(
    region: Region, spirals: Sequence[ContactSpiral], limit: int, rng: np.random.Generator, *, packed: bool, beside: float
) -> list[Sensor]:
    """One sensor after the other on a copy of the region, up to `limit`."""
    found: list[Sensor] = []
    trial = region.copy() if limit > 1 else region
    k = 0
    while k < len(spirals) and len(found) < limit:
        sensor = None if found and spirals[k].s < beside else best_in(trial, spirals[k], rng, packed=packed)
        if sensor is None:
            k += 1
            continue
        found.append(dataclasses.replace(sensor, id=f"trial {len(found)}"))
        if len(found) < limit:
            trial.space.add(found[-1])
    return found


def _covered(sensors: Sequence[Sensor]) -> float:
    """Area of their discs, but for the factor pi/4, mm^2."""
    return float(sum(s.pattern.s**2 for s in sensors if isinstance(s.pattern, ContactSpiral)))


def best_in(region: Region, pattern: Pattern, rng: np.random.Generator, *, packed: bool) -> Sensor | None:
    """Where a pattern fits in a region: in the roomiest place, or `packed` towards one end; None where it does not fit."""
    footprint = Footprint.of(pattern)
    turns = region.space.main_direction + np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS
    poses = poses_in(region.raster, region.cells, footprint, turns, need=need_of(pattern, region.space.material), rng=rng)
    if not len(poses.slack):
        return None
    space, between_creases = region.space, region.between_creases
    roomiest = np.argsort(-np.round(poses.slack, 2), kind="stable")
    for order in (_from_one_end(region, poses) if packed else _far_from_others(region, poses), roomiest):
        sensor = first_fit(space, pattern, footprint, poses, order, between_creases=between_creases)
        if sensor:
            return sensor
    return nudged_fit(space, pattern, footprint, poses, int(roomiest[0]), between_creases=between_creases)


def _far_from_others(region: Region, poses: Poses) -> NDArray[np.int64]:
    """Poses with some room to spare, those farthest from the sensors that are there first; none where there is no sensor yet."""
    ok = np.flatnonzero(poses.slack >= region.raster.step / 2)
    middles = np.array([(curves.low.min(axis=0) + curves.high.max(axis=0)) / 2 for curves in region.space.taken])
    if not len(ok) or not len(middles):
        return ok[:0]
    apart = np.hypot(*np.moveaxis(poses.places[ok, None] - middles, 2, 0)).min(axis=1)
    # Whole millimetres, so that room has a say too.
    return ok[np.lexsort((-poses.slack[ok], -np.round(apart)))]


def _from_one_end(region: Region, poses: Poses) -> NDArray[np.int64]:
    """Poses with some room to spare, those nearest to one end of the region first."""
    ok = np.flatnonzero(poses.slack >= region.raster.step / 2)
    if not len(ok):
        return ok
    middle, axes = region.axes
    from_end, across = ((poses.places[ok] - middle) @ axes).T
    # Whole millimetres, so that the second direction has a say too.
    return ok[np.lexsort((-poses.slack[ok], np.round(across), np.round(from_end)))]
