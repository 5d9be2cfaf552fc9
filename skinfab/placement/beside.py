"""Copies of sensors where there is room for them, as near to their originals as may be."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import RefusedError
from skinfab.material import Material
from skinfab.placement import arrange
from skinfab.placement.edit import Sensors, find, middle_of
from skinfab.placement.raster import Raster
from skinfab.placement.search import first_fit, poses_around, poses_in
from skinfab.placement.sensor import Sensor
from skinfab.placement.space import Footprint, Space, need_of
from skinfab.skin import Skin

Array = NDArray[np.float64]

#: In line with its original a copy may lie so much farther off than elsewhere: a row is easier to look at and to wire.
_IN_LINE = 1.25
#: About so many places of the raster are looked at.
_PLACES = 20_000
#: So many of them at a time, the nearest first.
_AT_ONCE = 1000
#: Of places that the raster is too coarse to judge, so many are looked at exactly.
_VERIFIED = 100
#: A single sensor that finds no room as it lies is turned by multiples of this, rad.
_TURN = np.pi / 12


def copy_beside(skin: Skin, ids: Sequence[str], *, material: Material) -> tuple[Sensors, tuple[str, ...]]:
    """Add a copy of each of some sensors, those of one piece side by side as the originals are; a single one is turned where it must be.

    Parameters
    ----------
    skin : Skin
    ids : sequence of str
    material : Material
        With the margin that the printer needs.

    Returns
    -------
    sensors : tuple of Sensor
    new : tuple of str
        Ids of the copies, in the order of `ids`.

    Raises
    ------
    InputError
        No such sensor.
    RefusedError
        There is no room for the copies on their piece.
    """
    chosen = [find(skin.sensors, id) for id in ids]
    sensors, new = arrange.copy(skin.sensors, ids, reserved=[each.sensor for each in skin.lifted])
    placed: dict[str, Sensor] = {}
    for piece in dict.fromkeys(s.piece for s in chosen):
        group = [(s, id) for s, id in zip(chosen, new, strict=True) if s.piece == piece]
        for (_, id), at in zip(group, _beside(skin, [s for s, _ in group], material), strict=True):
            placed[id] = at
    return tuple(_at(s, placed[s.id]) if s.id in placed else s for s in sensors), new


def _at(sensor: Sensor, place: Sensor) -> Sensor:
    """A sensor where another one lies."""
    return dataclasses.replace(sensor, x=place.x, y=place.y, angle=place.angle)


def _beside(skin: Skin, group: Sequence[Sensor], material: Material) -> list[Sensor]:
    """The sensors of one piece, moved to where they fit beside all that are there."""
    piece = skin.piece(group[0].piece)
    space = Space(skin.object, piece, material, list(skin.sensors_on(piece.id)))
    for between_creases in (True, False) if len(space.creases) else (False,):
        found = _moved(space, group, between_creases) or (_turned(space, group[0], between_creases) if len(group) == 1 else None)
        if found:
            return found
    names = ", ".join(s.id for s in group)
    what = "a copy" if len(group) == 1 else "copies side by side"
    raise RefusedError(f"there is no room on {piece.id} for {what} of {names}; make it smaller first, or add a sensor to another piece")


def _moved(space: Space, group: Sequence[Sensor], between_creases: bool) -> list[Sensor] | None:
    """All moved by the same way, the shortest there is."""
    raster = space.facets if between_creases else space.raster
    middles = np.array([middle_of(s) for s in group])
    ways = _ways(raster, group[0], middles[0], need=need_of(group[0].pattern, space.material))
    doubtful: list[tuple[float, Array]] = []
    for start in range(0, len(ways), _AT_ONCE):
        near = ways[start : start + _AT_ONCE]
        slack = np.full(len(near), np.inf)
        for sensor, middle in zip(group, middles, strict=True):
            angles, need = np.full(len(near), sensor.angle), need_of(sensor.pattern, space.material)
            slack = np.minimum(slack, poses_around(raster, Footprint.of(sensor.pattern), middle + near, angles, need=need).slack)
        for way in near[slack >= 0]:
            if found := _fitting(space, group, way, between_creases=between_creases):
                return found
        doubtful += [(float(slack[k]), near[k]) for k in np.flatnonzero((slack < 0) & (slack > -raster.step))]
    for _, way in sorted(doubtful, key=lambda each: -each[0])[:_VERIFIED]:
        if found := _fitting(space, group, way, between_creases=between_creases):
            return found
    return None


def _ways(raster: Raster, first: Sensor, middle: Array, *, need: float) -> Array:
    """By how much the first sensor may be moved, (n, 2) mm: to where the raster has room for it, and in line with itself; nearest first."""
    roomy = raster.clearance >= Footprint.of(first.pattern).reach + need - raster.step
    every = int(np.ceil(np.sqrt(roomy.sum() / _PLACES))) or 1
    thinned = np.zeros_like(roomy)
    thinned[::every, ::every] = roomy[::every, ::every]
    anywhere = raster.centres(thinned) - middle
    farthest = float(np.hypot(*anywhere.T).max(initial=0.0))
    c, s = np.cos(first.angle), np.sin(first.angle)
    sides = np.array([[1, 0], [0, 1], [-1, 0], [0, -1], [c, s], [-s, c], [-c, -s], [s, -c]])
    line = np.arange(raster.step, farthest, raster.step)
    in_line = (line[:, None, None] * sides).reshape(-1, 2)
    ways = np.concatenate([in_line, anywhere])
    cost = np.concatenate([np.hypot(*in_line.T) / _IN_LINE, np.hypot(*anywhere.T)])
    order: Array = ways[np.argsort(np.round(cost, 6), kind="stable")]
    return order


def _fitting(space: Space, group: Sequence[Sensor], way: Array, *, between_creases: bool) -> list[Sensor] | None:
    """The sensors moved that way, where all of them fit."""
    moved = [dataclasses.replace(s, x=float(s.x + way[0]), y=float(s.y + way[1])) for s in group]
    return moved if all(space.fits(s, between_creases=between_creases) for s in moved) else None


def _turned(space: Space, sensor: Sensor, between_creases: bool) -> list[Sensor] | None:
    """One sensor as near as it fits, whatever way it lies."""
    raster, footprint, middle = (space.facets if between_creases else space.raster), Footprint.of(sensor.pattern), middle_of(sensor)
    angles = sensor.angle + _TURN * np.arange(1.0, round(2 * np.pi / _TURN), dtype=np.float64)
    poses = poses_in(raster, raster.free, footprint, angles, need=need_of(sensor.pattern, space.material), rng=np.random.default_rng(0))
    near = np.argsort(np.round(np.hypot(*(poses.places - middle).T)), kind="stable")
    sure = near[poses.slack[near] >= 0]
    roomiest = np.argsort(-poses.slack, kind="stable")
    for order in (sure, roomiest):
        if len(order) and (found := first_fit(space, sensor.pattern, footprint, poses, order, between_creases=between_creases)):
            return [found]
    return None
