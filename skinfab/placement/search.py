"""Looking for a place for a pattern: on the raster first, then verified exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.patterns.base import Pattern
from skinfab.placement.distance import distance
from skinfab.placement.raster import Raster
from skinfab.placement.sensor import Sensor
from skinfab.placement.space import Footprint, Space

Array = NDArray[np.float64]

#: Places tried on the raster at each angle, and of these the best that are verified exactly.
_PLACES = 2400
_VERIFIED = 12
#: A pose that lacks more than so many steps of the raster is not nudged: small moves will not free it.
_HOPELESS = 4.0
#: Moves of a pose that is nudged.
_NUDGES = 15


@dataclass(frozen=True, eq=False)
class Poses:
    """Where a pattern could lie: the anchor's place (n, 2) mm, the angle (n,) rad, room to spare (n,) mm."""

    places: Array
    angles: Array
    slack: Array

    def take(self, index: NDArray[np.int64]) -> Poses:
        return Poses(self.places[index], self.angles[index], self.slack[index])


def poses_around(raster: Raster, footprint: Footprint, places: Array, angles: Array, *, need: float) -> Poses:
    """Every place (n, 2) with the angle of its own (n,): how much room each pose leaves, less `need`."""
    turned = footprint.rim - footprint.anchor
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x = places[:, :1] + c * turned[:, 0] - s * turned[:, 1]
    y = places[:, 1:] + s * turned[:, 0] + c * turned[:, 1]
    slack = raster.clearance_at(np.stack([x, y], axis=2)).min(axis=1) - need
    return Poses(places, angles, slack)


def poses_in(
    raster: Raster, cells: NDArray[np.bool_], footprint: Footprint, angles: Array, *, need: float, rng: np.random.Generator
) -> Poses:
    """Poses with the anchor on a free cell of `cells` that the raster does not rule out, in no order."""
    row, column = np.nonzero(cells & (raster.clearance >= footprint.reach + need - raster.step))
    if len(row) > _PLACES:
        # One half where there is most room, for what only just fits; the other anywhere, for packing.
        by_room = np.argsort(-np.round(raster.clearance[row, column], 6), kind="stable")
        anywhere = rng.choice(by_room[_PLACES // 2 :], _PLACES // 2, replace=False)
        some = np.sort(np.concatenate([by_room[: _PLACES // 2], anywhere]))
        row, column = row[some], column[some]
    c, s = np.cos(angles), np.sin(angles)
    # (angles, 2, 2): the transpose of each turn, for points as rows.
    turns = np.stack([np.stack([c, s], axis=1), np.stack([-s, c], axis=1)], axis=1)
    slack = raster.clearance_round((row, column), (footprint.rim - footprint.anchor) @ turns, least=need - raster.step) - need
    which, where = np.nonzero(slack > -raster.step)
    return Poses(raster.centres_of((row, column))[where], np.asarray(angles)[which], slack[which, where])


def first_fit(
    space: Space, pattern: Pattern, footprint: Footprint, poses: Poses, order: Sequence[int] | NDArray[np.int64], *, between_creases: bool
) -> Sensor | None:
    """The first of the poses, taken in `order`, at which the pattern fits exactly; its id and channel are still open."""
    for k in order[:_VERIFIED]:
        sensor = sensor_at(space, pattern, footprint, poses.places[k], float(poses.angles[k]))
        if space.fits(sensor, between_creases=between_creases):
            return sensor
    return None


def nudged_fit(space: Space, pattern: Pattern, footprint: Footprint, poses: Poses, start: int, *, between_creases: bool) -> Sensor | None:
    """A fit near one pose that the raster is too coarse to find: small moves and turns, each to where there is more room."""
    place, angle, step = poses.places[start], float(poses.angles[start]), space.raster.step
    neighbours = [
        (there, space.material.gap + (pattern.bead + o.pattern.bead) / 2) for o, there in zip(space.sensors, space.taken, strict=True)
    ]
    obstacles = [(space.edges, pattern.bead / 2 + space.material.margin), *neighbours]
    if between_creases:
        obstacles.append((space.creases, pattern.bead / 2))
    # What it cannot come near by all its moves together says nothing.
    reach = footprint.radius + max(need for _, need in obstacles) + _NUDGES * step
    obstacles = [(there.within(place - reach, place + reach), need) for there, need in obstacles]

    def room(place: Array, angle: float) -> float:
        here = footprint.curves.moved(angle=angle, shift=_origin(footprint, place, angle))
        return min(distance(here, obstacle) - need for obstacle, need in obstacles)

    best = room(place, angle)
    if best < -_HOPELESS * step:
        return None
    for _ in range(_NUDGES):
        if best >= 0:
            break
        turn = step / footprint.radius
        moves = [(place + step * np.array([np.cos(a), np.sin(a)]), angle) for a in np.arange(8) * np.pi / 4]
        moves += [(place, angle + turn), (place, angle - turn)]
        rooms = [room(*move) for move in moves]
        k = int(np.argmax(rooms))
        if rooms[k] > best:
            best, (place, angle) = rooms[k], moves[k]
        else:
            step /= 2
    sensor = sensor_at(space, pattern, footprint, place, angle)
    return sensor if best >= 0 and space.fits(sensor, between_creases=between_creases) else None


def sensor_at(space: Space, pattern: Pattern, footprint: Footprint, place: Array, angle: float) -> Sensor:
    """The pattern with its anchor at `place` (2,) mm, not checked; its id and channel are still open."""
    x, y = _origin(footprint, place, angle)
    return Sensor("new", space.piece.id, pattern, float(x), float(y), angle, -1)


def _origin(footprint: Footprint, place: Array, angle: float) -> Array:
    """Where the pattern's origin lies when its anchor is at `place`, (2,) mm."""
    c, s = np.cos(angle), np.sin(angle)
    origin: Array = place - np.array([[c, -s], [s, c]]) @ footprint.anchor
    return origin
