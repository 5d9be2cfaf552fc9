"""Sensors follow their spot on the object when its pieces are cut anew."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.mapping import FlatMap
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.check import Checker
from skinfab.placement.edit import middle_of
from skinfab.placement.lifted import Lifted, in_line
from skinfab.placement.sensor import Sensor

FloatArray = NDArray[np.float64]

#: What has come to lie too close by no more than this is moved on so far: pieces that are flattened anew differ by some 0.02 mm where
#: nothing was changed, and no printer hits a spot better.
_SETTLED_MM = 0.1
#: Ways in which it is moved on.
_WAYS = 16

#: Points along a pattern by which its new direction is found: a spiral of six turns gets ten on each.
_SAMPLES = 64


@dataclass(frozen=True)
class Carried:
    """What became of the sensors.

    Parameters
    ----------
    sensors : tuple of Sensor
        Those that still have a spot, in their old order; those on pieces that stayed are the same objects.
    lost : tuple of Sensor
        Those whose spot is on no flat piece any more, as they were.
    remarks : tuple of str
        One sentence for each that is lost or, where a material says what fits, no longer fits.
    """

    sensors: tuple[Sensor, ...]
    lost: tuple[Sensor, ...]
    remarks: tuple[str, ...]


@dataclass(frozen=True)
class PutBack:
    """What became of lifted sensors.

    Parameters
    ----------
    sensors : tuple of Sensor
        Those that lay there and those that came back, in the order of the list.
    back : tuple of Sensor
        Those that came back.
    still : tuple of Lifted
        Those that did not.
    """

    sensors: tuple[Sensor, ...]
    back: tuple[Sensor, ...]
    still: tuple[Lifted, ...]


def put_back(
    mesh: Mesh, lifted: Sequence[Lifted], sensors: Sequence[Sensor], after: Sequence[Piece], *, material: Material | None = None
) -> PutBack:
    """Put lifted sensors back on their spots, where these lie flat, they fit, and their names and channels are still free.

    Parameters
    ----------
    mesh : Mesh
        The surface that is flattened.
    lifted : sequence of Lifted
        The first in the list is the first to be put back, should two be in each other's way.
    sensors : sequence of Sensor
        Those that lie on the pieces.
    after : sequence of Piece
    material : Material, optional
        Says what fits; without it that is not asked.
    """
    moves, check = _Moves(mesh, after), None if material is None else Checker(material)
    pieces = {piece.id: piece for piece in after}
    line = in_line(sensors, lifted)
    there, still = list(sensors), list[Lifted]()
    back: dict[int, Sensor] = {}
    for each in [one for one in line if isinstance(one, Lifted)]:
        new = moves.of(each.sensor, each.piece)
        if new is None:
            still.append(dataclasses.replace(each, why=""))
            continue
        if check is not None:
            new = _settled(check, pieces[new.piece], new, there)
        why = _taken(new, there)
        if not why and check is not None:
            why = "; ".join(f.brief or f.text for f in check.faults(pieces[new.piece], new, there))
        if why:
            still.append(dataclasses.replace(each, why=why))
        else:
            there.append(new)
            back[id(each)] = new
    listed = [back.get(id(one)) if isinstance(one, Lifted) else one for one in line]
    return PutBack(tuple(one for one in listed if one is not None), tuple(back.values()), tuple(still))


def _taken(sensor: Sensor, there: Sequence[Sensor]) -> str:
    """Who has its name or its channel by now."""
    for other in there:
        if other.id.lower() == sensor.id.lower():
            return f"another sensor is named {sensor.id}"
        if other.channel == sensor.channel:
            return f"{other.id} has its channel {sensor.channel}"
    return ""


def carry(
    mesh: Mesh, sensors: Sequence[Sensor], before: Sequence[Piece], after: Sequence[Piece], *, material: Material | None = None
) -> Carried:
    """Put sensors on new pieces of the same surface where their spot on the object has come to lie.

    A sensor's middle stays on its spot of the object; its direction is the one in which the new piece turns the pattern's
    points on the whole.

    Parameters
    ----------
    mesh : Mesh
        The surface that is flattened.
    sensors : sequence of Sensor
    before, after : sequence of Piece
        The flat pieces that the sensors lie on, and those that they are to lie on.
    material : Material, optional
        Says how near to edges and to each other they may lie; without it nothing is said of that.
    """
    kept = {id(piece) for piece in after}
    old = {piece.id: piece for piece in before}
    new_pieces = {piece.id: piece for piece in after}
    moves, check = _Moves(mesh, after), None if material is None else Checker(material)
    carried: list[Sensor] = []
    lost: list[Sensor] = []
    moved: list[Sensor] = []
    for sensor in sensors:
        piece = old.get(sensor.piece)
        if piece is not None and id(piece) in kept:
            carried.append(sensor)
            continue
        new = moves.of(sensor, piece) if piece is not None else None
        if new is None:
            lost.append(sensor)
        else:
            if check is not None:
                # Sensors that were not moved lie on other pieces.
                new = _settled(check, new_pieces[new.piece], new, moved)
            carried.append(new)
            moved.append(new)
    remarks = [
        f"{s.id} was taken off: its spot on the object is on no flat piece any more; cut so that it is, or place it anew" for s in lost
    ]
    if check is not None:
        for k, sensor in enumerate(moved):
            # Each pair once.
            wrong = [fault.text for fault in check.faults(new_pieces[sensor.piece], sensor, moved[:k])]
            if wrong:
                remarks.append(f"{'; '.join(wrong)}, since the object was cut anew; move, turn or shrink it")
    return Carried(tuple(carried), tuple(lost), tuple(remarks))


def _settled(check: Checker, piece: Piece, sensor: Sensor, others: Sequence[Sensor]) -> Sensor:
    """The sensor; where it is too close by a hair's breadth, moved on by the least that makes it fit, if anything so little does."""
    lack = max((fault.amount for fault in check.faults(piece, sensor, others)), default=0.0)
    if not 0 < lack <= _SETTLED_MM:
        return sensor
    turns = 2 * np.pi * np.arange(_WAYS) / _WAYS
    for far in (1.1 * lack, 2 * lack, 2 * _SETTLED_MM):
        for dx, dy in far * np.stack([np.cos(turns), np.sin(turns)], axis=1):
            moved = dataclasses.replace(sensor, x=sensor.x + float(dx), y=sensor.y + float(dy))
            if not check.faults(piece, moved, others):
                return moved
    return sensor


class _Moves:
    """Maps of the pieces concerned, each made once."""

    def __init__(self, mesh: Mesh, after: Sequence[Piece]) -> None:
        self._mesh, self._after = mesh, after
        self._owner = np.full(len(mesh.F), -1)
        for k, piece in enumerate(after):
            self._owner[piece.faces] = k
        self._maps: dict[int, FlatMap] = {}

    def of(self, sensor: Sensor, piece: Piece) -> Sensor | None:
        """The sensor where its spot now lies; None where the spot is gone."""
        path = sensor.printed_path
        old = np.vstack([middle_of(sensor), path.point_at(np.linspace(0, 1, _SAMPLES + 1))])
        spots = self._map(piece).to_object(old)
        there = np.where(spots.face >= 0, self._owner[spots.face], -1)
        # A middle beside the piece (a pattern over a hole or an edge) has no spot: the nearest part of the pattern has.
        usable = np.flatnonzero(there >= 0)
        if (spots.face[0] >= 0 and there[0] < 0) or not len(usable):
            return None
        anchor = int(usable[np.argmin(np.linalg.norm(old[usable] - old[0], axis=1))])
        target = self._after[there[anchor]]
        shared = there == there[anchor]
        new = self._map(target).to_flat(spots.face[shared], spots.barycentric[shared])
        middle = new[int(np.count_nonzero(shared[:anchor]))]
        turn = _turn(old[shared] - old[anchor], new - middle)
        c, s = np.cos(turn), np.sin(turn)
        dx, dy = np.array([sensor.x, sensor.y]) - old[anchor]
        return dataclasses.replace(
            sensor,
            piece=target.id,
            x=float(middle[0] + c * dx - s * dy),
            y=float(middle[1] + s * dx + c * dy),
            angle=float((sensor.angle + turn) % (2 * np.pi)),
        )

    def _map(self, piece: Piece) -> FlatMap:
        if id(piece) not in self._maps:
            self._maps[id(piece)] = FlatMap(self._mesh, piece)
        return self._maps[id(piece)]


def _turn(old: FloatArray, new: FloatArray) -> float:
    """Angle, rad, that turns vectors (n, 2) into others best, by least squares."""
    return float(np.arctan2((old[:, 0] * new[:, 1] - old[:, 1] * new[:, 0]).sum(), (old * new).sum()))
