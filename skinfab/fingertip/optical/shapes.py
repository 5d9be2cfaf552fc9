"""The plates that the seed followed, and what a trace tells of them: hull, sides, area, distance from the true edge.

The seed's table 2 gives the rectangle a larger area than its table 1's sides could enclose, by the fingertip and in truth; so each
shape is judged against the true plate, and table 1 stands beside it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.optical.follower import Trace
from skinfab.fingertip.optical.plates import Disk, Outline, Polygon

FloatArray = NDArray[np.float64]

#: A trace holds the shape when its hull has the plate's area within this part: a follower may also close round nothing.
AREA_WITHIN = 0.25
#: Parts of a side, from each corner, that a line through it leaves out: corners are felt rounded.
_CORNER = 0.15


@dataclass(frozen=True, eq=False)
class Shape:
    """A plate of the seed.

    Parameters
    ----------
    name : str
    plate : Outline
    sides_mm : tuple of float
        True ones, or the diameter of a disk.
    published_mm : tuple of float
        What the seed's fingertip found (table 1).
    area_mm2, humans_mm2 : float
        What the seed's fingertip and people went round (table 2).
    """

    name: str
    plate: Outline
    sides_mm: tuple[float, ...]
    published_mm: tuple[float, ...]
    area_mm2: float
    humans_mm2: float


def shapes() -> tuple[Shape, ...]:
    """Rectangle, hexagon and circle of tables 1 and 2, about the origin.

    Examples
    --------
    >>> [(each.name, round(each.plate.area / 100, 1)) for each in shapes()]
    [('rectangle', 77.9), ('hexagon', 73.9), ('circle', 28.3)]
    """
    four, six = (108.0, 75.0, 107.0, 70.0), (54.0, 53.0, 53.0, 54.0, 53.0, 53.0)
    return (
        Shape("rectangle", _four_sided(four), four, (104.0, 70.0, 104.0, 66.0), 8357.0, 9454.0),
        Shape("hexagon", _even_angles(six), six, (48.0, 50.0, 49.0, 51.0, 48.0, 46.0), 7133.3, 8047.3),
        Shape("circle", Disk(30.0), (60.0,), (61.0,), 2700.0, 2925.0),
    )


def _four_sided(sides: tuple[float, float, float, float]) -> Polygon:
    """With these sides, the first two at a right angle."""
    a, b, c, d = sides
    diagonal = math.hypot(a, b)
    # Seen from the third corner: the angle between the diagonal and the third side, by the law of cosines.
    turn = math.acos((diagonal**2 + c**2 - d**2) / (2 * diagonal * c))
    way = math.atan2(-b, -a) - turn
    C = np.array([[0, 0], [a, 0], [a, b], [a + c * math.cos(way), b + c * math.sin(way)]])
    return Polygon(C - C.mean(axis=0))


def _even_angles(sides: Sequence[float]) -> Polygon:
    """With these sides and even angles, where they close."""
    turn = np.arange(len(sides)) * math.tau / len(sides)
    C = np.cumsum(np.array(sides)[:, None] * np.c_[np.cos(turn), np.sin(turn)], axis=0)
    return Polygon(np.roll(C, 1, axis=0) - C.mean(axis=0))


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """A shape as a trace tells it.

    Parameters
    ----------
    hull : (m, 2) float, mm
        Convex hull of the trace, counter-clockwise.
    corners : (k, 2) float, mm
        Of the polygon that was made of it; empty for a disk.
    sides_mm : (k,) float
        Its sides from the true first one on, or the diameter.
    area_mm2 : float
        Of the hull.
    off_mm : float
        Mean distance of the trace from the true edge.
    right : bool
        Whether the contour closed, round the plate's area.
    """

    hull: FloatArray
    corners: FloatArray
    sides_mm: FloatArray
    area_mm2: float
    off_mm: float
    right: bool


def reconstruct(trace: Trace, shape: Shape, *, lines: bool) -> Reconstruction:
    """Hull, sides and errors of a trace.

    Parameters
    ----------
    trace : Trace
    shape : Shape
    lines : bool
        Whether sides are those of lines through the points between the corners, or, as the seed's, of the hull itself.

    Raises
    ------
    InputError
        The trace has fewer points than the shape has corners.
    """
    P = trace.edge
    count = 3 if len(shape.sides_mm) == 1 else len(shape.sides_mm)
    if len(P) < count:
        raise InputError(f"a trace of {len(P)} points; a {shape.name} takes {count} or more: the edge was lost at once")
    hull = cv2.convexHull(P.astype(np.float32))[:, 0].astype(float)
    hull = hull if _area(hull) > 0 else hull[::-1]
    area = _area(hull)
    off = float(np.abs(shape.plate.distance(P)).mean())
    right = trace.closed and abs(area / shape.plate.area - 1) <= AREA_WITHIN
    if len(shape.sides_mm) == 1:
        return Reconstruction(hull, np.empty((0, 2)), np.array([2 * math.sqrt(area / math.pi)]), area, off, right)
    corners = _reduced(hull, count)
    if lines and len(corners) == count:
        corners = _through(P, corners)
    first = int(np.linalg.norm(corners - shape.plate.outline()[0], axis=1).argmin())
    corners = np.roll(corners, -first, axis=0)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    return Reconstruction(hull, corners, sides, area, off, right)


def _area(P: FloatArray) -> float:
    x, y = P.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _reduced(hull: FloatArray, count: int) -> FloatArray:
    """So many corners: the one whose triangle with its neighbours is least is left out, again and again (Visvalingam and Whyatt 1993)."""
    P = hull
    while len(P) > count:
        a, b = np.roll(P, 1, axis=0) - P, np.roll(P, -1, axis=0) - P
        P = np.delete(P, int(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).argmin()), axis=0)
    return P


def _through(P: FloatArray, corners: FloatArray) -> FloatArray:
    """Corners between lines through the points that lie along each side."""
    ends = np.roll(corners, -1, axis=0)
    v = ends - corners
    part = np.einsum("nkj,kj->nk", P[:, None] - corners, v) / (v * v).sum(axis=1)
    foot = corners + np.clip(part, 0, 1)[..., None] * v
    nearest = np.linalg.norm(P[:, None] - foot, axis=2).argmin(axis=1)
    lines = []
    for k in range(len(corners)):
        on = P[(nearest == k) & (part[:, k] > _CORNER) & (part[:, k] < 1 - _CORNER)]
        if len(on) < 2:
            return corners
        middle = on.mean(axis=0)
        lines.append((middle, np.linalg.svd(on - middle)[2][0]))
    made = []
    for (p, t), (q, u) in zip(np.roll(np.array(lines), 1, axis=0), np.array(lines), strict=True):
        made.append(p + t * np.linalg.solve(np.c_[t, -u], q - p)[0])
    return np.array(made)
