"""Exact planar paths made of straight lines and circular arcs.

A printed conductor is one continuous path. It stays exact (true arcs, never chords) from the
pattern that draws it to the G-code that prints it; only a preview asks for a polyline.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.tolerances import JOIN_MM

Point = NDArray[np.float64]  # (2,) mm

#: Where a circle reaches furthest, from its centre: along +x, +y, -x, -y.
_AXES = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


class PathError(InputError):
    """A path that cannot exist: its message says which piece, what it has and what it needs."""


@dataclass(frozen=True)
class Arc:
    """A circular arc from `start_angle` through `sweep`, counter-clockwise when `sweep` > 0.

    Parameters
    ----------
    centre : (2,) float, mm
    radius : float, mm, > 0
    start_angle : float, rad
    sweep : float, rad, 0 < |sweep| <= 2 pi

    Examples
    --------
    >>> quarter = Arc(centre=(0, 0), radius=2.0, start_angle=0.0, sweep=np.pi / 2)
    >>> round(quarter.length, 6), quarter.end.round(6).tolist()
    (3.141593, [0.0, 2.0])
    """

    centre: Point
    radius: float
    start_angle: float
    sweep: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", np.asarray(self.centre, dtype=float))
        if not self.radius > 0:
            raise PathError(f"arc radius is {self.radius:g} mm; it must be positive")
        if not 0 < abs(self.sweep) <= 2 * np.pi:
            raise PathError(f"arc sweep is {self.sweep:g} rad; it must be between 0 and one turn")

    @cached_property
    def start(self) -> Point:
        return self.point_at(0.0)

    @cached_property
    def end(self) -> Point:
        return self.point_at(1.0)

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return self.radius * abs(self.sweep)

    @cached_property
    def bbox(self) -> NDArray[np.float64]:
        """Exact bounding box as ((xmin, ymin), (xmax, ymax)), mm."""
        # Extremes lie at the two ends and wherever the arc crosses an axis direction. Few numbers: arrays would take longer.
        (x, y), sign = self.centre.tolist(), math.copysign(1.0, self.sweep)
        points = [self.start.tolist(), self.end.tolist()]
        for k, (ux, uy) in enumerate(_AXES):
            if sign * (k * np.pi / 2 - self.start_angle) % (2 * np.pi) <= abs(self.sweep):
                points.append([x + self.radius * ux, y + self.radius * uy])
        xs, ys = zip(*points, strict=True)
        return np.array([[min(xs), min(ys)], [max(xs), max(ys)]])

    def point_at(self, fraction: ArrayLike) -> Point:
        """Points at `fraction` of the way along, (..., 2) mm."""
        angle = self.start_angle + self.sweep * np.asarray(fraction, dtype=float)
        points = np.empty((*angle.shape, 2))
        points[..., 0], points[..., 1] = np.cos(angle), np.sin(angle)
        points *= self.radius
        points += self.centre
        return points

    def transformed(self, *, angle: float, shift: ArrayLike) -> Arc:
        """Turned about the origin by `angle` rad, then moved by `shift` mm."""
        return Arc(_moved(self.centre, angle, shift), self.radius, self.start_angle + angle, self.sweep)

    def reversed(self) -> Arc:
        return Arc(self.centre, self.radius, self.start_angle + self.sweep, -self.sweep)

    def to_polyline(self, *, tolerance: float) -> NDArray[np.float64]:
        """Chords that leave the arc by at most `tolerance` mm, (n, 2) mm, ends included."""
        # A chord over the angle a leaves the arc by r (1 - cos(a / 2)).
        widest = 2 * np.arccos(max(1 - tolerance / self.radius, -1.0))
        count = max(int(np.ceil(abs(self.sweep) / widest)), 1)
        return self.point_at(np.linspace(0.0, 1.0, count + 1))


@dataclass(frozen=True)
class Line:
    """A straight piece from `start` to `end`, (2,) mm each.

    Examples
    --------
    >>> Line((0, 0), (3, 4)).length
    5.0
    """

    start: Point
    end: Point

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", np.asarray(self.start, dtype=float))
        object.__setattr__(self, "end", np.asarray(self.end, dtype=float))
        if not all(map(math.isfinite, (*self.start, *self.end))):
            raise PathError(f"line from {self.start} to {self.end}: its ends must be finite")

    @property
    def length(self) -> float:
        """Length, mm."""
        return float(np.hypot(*(self.end - self.start)))

    @cached_property
    def bbox(self) -> NDArray[np.float64]:
        """Bounding box as ((xmin, ymin), (xmax, ymax)), mm."""
        return np.array([np.minimum(self.start, self.end), np.maximum(self.start, self.end)])

    def point_at(self, fraction: ArrayLike) -> Point:
        """Points at `fraction` of the way along, (..., 2) mm."""
        t = np.asarray(fraction, dtype=float)[..., None]
        return self.start * (1 - t) + self.end * t

    def transformed(self, *, angle: float, shift: ArrayLike) -> Line:
        """Turned about the origin by `angle` rad, then moved by `shift` mm."""
        return Line(_moved(self.start, angle, shift), _moved(self.end, angle, shift))

    def reversed(self) -> Line:
        return Line(self.end, self.start)

    def to_polyline(self, *, tolerance: float) -> NDArray[np.float64]:
        """Its two ends, (2, 2) mm: a line needs no tolerance."""
        return np.array([self.start, self.end])


Segment: TypeAlias = Line | Arc


@dataclass(frozen=True)
class Path:
    """Lines and arcs, each starting where the one before it ends.

    Parameters
    ----------
    segments : tuple of Line or Arc, at least one

    Raises
    ------
    PathError
        No segments, or a gap wider than ``tolerances.JOIN_MM`` between two of them.

    Examples
    --------
    >>> hook = Path((Line((0, 0), (2, 0)), Arc((2, 1), 1.0, -np.pi / 2, np.pi)))
    >>> round(hook.length, 6), hook.end.round(6).tolist()
    (5.141593, [2.0, 2.0])
    """

    segments: tuple[Segment, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "segments", tuple(self.segments))
        if not self.segments:
            raise PathError("a path needs at least one segment")
        for k, (one, two) in enumerate(itertools.pairwise(self.segments)):
            gap = math.dist(one.end, two.start)
            if gap > JOIN_MM:
                raise PathError(f"segment {k + 1} starts {gap:.3g} mm from the end of segment {k}; they must meet")

    @property
    def start(self) -> Point:
        return self.segments[0].start

    @property
    def end(self) -> Point:
        return self.segments[-1].end

    @cached_property
    def length(self) -> float:
        """Length, mm."""
        return sum(s.length for s in self.segments)

    @cached_property
    def bbox(self) -> NDArray[np.float64]:
        """Exact bounding box as ((xmin, ymin), (xmax, ymax)), mm."""
        boxes = np.array([s.bbox for s in self.segments])
        return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])

    def point_at(self, fraction: ArrayLike) -> Point:
        """Points at `fraction` of the length, (..., 2) mm."""
        ends = np.cumsum([0.0, *(s.length for s in self.segments)])
        at = np.clip(np.asarray(fraction, dtype=float), 0, 1) * ends[-1]
        which = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(self.segments) - 1)
        out = np.empty((*at.shape, 2))
        for k in np.unique(which):
            mine = which == k
            span = ends[k + 1] - ends[k]
            out[mine] = self.segments[k].point_at((at[mine] - ends[k]) / span if span > 0 else np.zeros(mine.sum()))
        return out

    def transformed(self, *, angle: float, shift: ArrayLike) -> Path:
        """Turned about the origin by `angle` rad, then moved by `shift` mm."""
        return Path(tuple(s.transformed(angle=angle, shift=shift) for s in self.segments))

    def reversed(self) -> Path:
        return Path(tuple(s.reversed() for s in reversed(self.segments)))

    def to_polyline(self, *, tolerance: float) -> NDArray[np.float64]:
        """Points that leave the path by at most `tolerance` mm, (n, 2) mm, corners kept."""
        parts = [s.to_polyline(tolerance=tolerance) for s in self.segments]
        return np.vstack([parts[0], *(p[1:] for p in parts[1:])])


def _moved(point: Point, angle: float, shift: ArrayLike) -> Point:
    c, s = np.cos(angle), np.sin(angle)
    x, y = point
    dx, dy = np.asarray(shift, dtype=float)
    return np.array([c * x - s * y + dx, s * x + c * y + dy])
