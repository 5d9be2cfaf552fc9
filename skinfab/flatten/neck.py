"""Necks of a flat piece: where it would tear when it is peeled from its mould.

Where a disc as wide as asked for can be pushed about within a piece, the piece is wide enough (mathematical morphology:
erosion by a disc). A neck parts the places where that disc fits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: What hangs on a neck counts where a disc so many times as wide fits: a strip that is just as wide as asked for, on a surface
#: made of triangles, is none of a hundred necks.
_HANGS = 1.2

#: Segments of a quarter of a circle: 0.2 % of the width.
_QUARTER = 8

#: A neck's width is told to this part of the width asked for.
_STEP = 0.02


@dataclass(frozen=True, eq=False)
class Neck:
    """A place that is too narrow.

    Parameters
    ----------
    width : float, mm
        Of the widest disc that passes, to 2 % of what was asked for.
    side : (m,) int64
        Per triangle: 1 on the smaller side of it, 2 on the other, 0 between.
    """

    width: float
    side: IntArray


def find_neck(F: IntArray, UV: FloatArray, width: float, *, topology: Topology | None = None) -> Neck | None:
    """Of the places narrower than `width` mm, the one with the least hanging on it; None where there is none.

    A piece that is narrow throughout has no neck, nor has a tip.

    Parameters
    ----------
    F : (m, 3) int64
        A disk, laid flat without overlap. Its border may touch itself, as the sides of a dart do.
    UV : (n, 2) float64, mm
    width : float, mm
    topology : Topology, optional
        Of `F`, where it is at hand.

    Examples
    --------
    >>> x, y = np.array([0, 0, 10, 10, 25, 25.0]), np.array([0, 10, 4, 6, 0, 10.0])
    >>> bow_tie = np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [4, 5, 3]])
    >>> neck = find_neck(bow_tie, np.c_[x, y], 4.0)
    >>> round(neck.width, 1), neck.side.tolist()
    (2.0, [1, 0, 0, 2])
    >>> find_neck(bow_tie, np.c_[x, y], 1.9) is None
    True
    """
    topology = topology or Topology(F)
    loops = topology.boundary_loops
    if not width > 0 or len(loops) != 1 or not np.isfinite(UV).all():
        return None
    ring = UV[loops[0]]
    border = shapely.LinearRing(ring)
    wide = _hanging(_room(border, ring, width), _room(border, ring, _HANGS * width))
    if len(wide) < 2:
        return None
    return Neck(_passes(border, ring, wide, width), _sides(UV[F], wide))


def _room(border: shapely.LinearRing, ring: FloatArray, width: float) -> list[shapely.Polygon]:
    """Where the centre of a disc can be within the border: what the widened line encloses, without what lies outside of the piece."""
    fat = shapely.buffer(border, width / 2, quad_segs=_QUARTER)
    holes = [shapely.Polygon(hole) for part in shapely.get_parts(fat) for hole in part.interiors]
    return [hole for hole in holes if _inside(ring, shapely.get_coordinates(shapely.point_on_surface(hole))[0])]


def _inside(ring: FloatArray, point: FloatArray) -> bool:
    """By the winding number, which sides of a dart that lie on each other do not disturb."""
    x, y = ring.T
    X, Y = np.roll(ring, -1, axis=0).T
    side = (X - x) * (point[1] - y) - (point[0] - x) * (Y - y)
    up, down = (y <= point[1]) & (Y > point[1]) & (side > 0), (Y <= point[1]) & (y > point[1]) & (side < 0)
    return int(up.sum()) != int(down.sum())


def _hanging(rooms: list[shapely.Polygon], larger: list[shapely.Polygon]) -> list[shapely.Polygon]:
    """Those of the rooms that a larger disc fits in."""
    return [room for room in rooms if any(shapely.intersects(room, other) for other in larger)]


def _passes(border: shapely.LinearRing, ring: FloatArray, wide: list[shapely.Polygon], width: float) -> float:
    """The width of disc for which the smallest of the rooms is joined to another."""
    smallest = min(wide, key=lambda room: room.area)
    low, high = 0.0, width
    while high - low > _STEP * width:
        middle = (low + high) / 2
        joined = [room for room in _room(border, ring, middle) if shapely.intersects(room, smallest)]
        passes = any(shapely.intersects(joined[0], room) for room in wide if room is not smallest) if joined else False
        low, high = (middle, high) if passes else (low, middle)
    return (low + high) / 2


def _sides(triangles: FloatArray, wide: list[shapely.Polygon]) -> IntArray:
    """Each triangle by the room it shares most area with: the smallest room's, another's, or none's."""
    smallest = min(wide, key=lambda room: room.area)
    shapes = np.asarray(shapely.polygons(triangles))
    tree = shapely.STRtree(shapes)
    shared = np.zeros((3, len(shapes)))
    for room in wide:
        touched = tree.query(room, predicate="intersects")
        which = 1 if room is smallest else 2
        shared[which, touched] += shapely.area(shapely.intersection(shapes[touched], room))
    shared[0] = np.finfo(float).tiny
    side: IntArray = np.argmax(shared, axis=0)
    return side
