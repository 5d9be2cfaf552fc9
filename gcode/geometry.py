"""The two shapes a head moves along, as G-code states them: by end points, a centre and a direction.

Unlike `skinfab.paths` these are plain tuples, so that a program can be compared exactly (``==``)
and nothing is computed twice in two ways: an arc here is what the printer is told, no more.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from skinfab.paths import Arc, Line, Segment

Point: TypeAlias = tuple[float, float]  # mm
Box: TypeAlias = tuple[Point, Point]  # (low, high), mm


@dataclass(frozen=True)
class Straight:
    """A straight move, mm.

    Examples
    --------
    >>> Straight((0.0, 0.0), (3.0, 4.0)).length
    5.0
    """

    start: Point
    end: Point

    @property
    def length(self) -> float:
        """Length, mm."""
        return math.dist(self.start, self.end)

    @property
    def bbox(self) -> Box:
        """Bounding box, mm."""
        return (
            (min(self.start[0], self.end[0]), min(self.start[1], self.end[1])),
            (max(self.start[0], self.end[0]), max(self.start[1], self.end[1])),
        )

    @property
    def directions(self) -> tuple[Point, Point]:
        """Unit tangents at the start and at the end."""
        dx, dy = (self.end[0] - self.start[0]) / self.length, (self.end[1] - self.start[1]) / self.length
        return (dx, dy), (dx, dy)

    def point_at(self, fraction: float) -> Point:
        """The point at `fraction` of the way, mm."""
        (x0, y0), (x1, y1) = self.start, self.end
        return x0 + (x1 - x0) * fraction, y0 + (y1 - y0) * fraction

    def split(self, count: int) -> tuple[Straight, ...]:
        """`count` equal parts."""
        points = [self.start, *(self.point_at(k / count) for k in range(1, count)), self.end]
        return tuple(Straight(a, b) for a, b in itertools.pairwise(points))

    @property
    def segment(self) -> Line:
        """The same as a path segment, for previews."""
        return Line(np.array(self.start), np.array(self.end))


@dataclass(frozen=True)
class Curve:
    """A circular move from `start` to `end` about `centre`, mm; equal ends mean one full turn.

    Examples
    --------
    >>> half = Curve((1.0, 0.0), (-1.0, 0.0), (0.0, 0.0), clockwise=True)
    >>> round(half.length, 6), half.bbox
    (3.141593, ((-1.0, -1.0), (1.0, 0.0)))
    """

    start: Point
    end: Point
    centre: Point
    clockwise: bool

    @property
    def radius(self) -> float:
        """Distance of the start from the centre, mm: the radius the firmware draws."""
        return math.dist(self.start, self.centre)

    @property
    def radius_error(self) -> float:
        """How far the end lies off the circle through the start, mm."""
        return abs(math.dist(self.end, self.centre) - self.radius)

    @cached_property
    def sweep(self) -> float:
        """Angle turned through, rad, counter-clockwise positive, never 0."""
        turned = (self._angle(self.end) - self._angle(self.start)) * (-1 if self.clockwise else 1) % math.tau
        return (turned or math.tau) * (-1 if self.clockwise else 1)

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return self.radius * abs(self.sweep)

    @cached_property
    def bbox(self) -> Box:
        """Exact bounding box, mm."""
        xs, ys = [self.start[0], self.end[0]], [self.start[1], self.end[1]]
        sign = -1 if self.clockwise else 1
        for k, (ux, uy) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
            # The circle's four extremes count where the arc passes through them.
            if (k * math.pi / 2 - self._angle(self.start)) * sign % math.tau <= abs(self.sweep):
                xs.append(self.centre[0] + ux * self.radius)
                ys.append(self.centre[1] + uy * self.radius)
        return (min(xs), min(ys)), (max(xs), max(ys))

    @property
    def directions(self) -> tuple[Point, Point]:
        """Unit tangents at the start and at the end."""
        return self._tangent(self.start), self._tangent(self.end)

    def point_at(self, fraction: float) -> Point:
        """The point at `fraction` of the way, mm."""
        angle = self._angle(self.start) + self.sweep * fraction
        return self.centre[0] + self.radius * math.cos(angle), self.centre[1] + self.radius * math.sin(angle)

    def split(self, count: int) -> tuple[Curve, ...]:
        """`count` equal parts about the same centre."""
        points = [self.start, *(self.point_at(k / count) for k in range(1, count)), self.end]
        return tuple(Curve(a, b, self.centre, self.clockwise) for a, b in itertools.pairwise(points))

    def chords(self, tolerance: float) -> tuple[Straight, ...]:
        """Chords that leave the arc by at most `tolerance` mm."""
        return tuple(Straight(part.start, part.end) for part in self.split(self._chord_count(tolerance)))

    def chord_points(self, tolerance: float) -> NDArray[np.float64]:
        """The ends of `chords` in turn, (n, 2) mm, to compute with."""
        angle = self._angle(self.start) + self.sweep * np.linspace(0.0, 1.0, self._chord_count(tolerance) + 1)
        points = np.array(self.centre) + self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        points[0], points[-1] = self.start, self.end
        return points

    def _chord_count(self, tolerance: float) -> int:
        widest = 2 * math.acos(max(1 - tolerance / self.radius, -1.0))
        return max(math.ceil(abs(self.sweep) / widest), 1)

    @property
    def segment(self) -> Arc:
        """The same as a path segment, for previews."""
        return Arc(np.array(self.centre), self.radius, self._angle(self.start), self.sweep)

    def _angle(self, point: Point) -> float:
        return math.atan2(point[1] - self.centre[1], point[0] - self.centre[0])

    def _tangent(self, point: Point) -> Point:
        angle = self._angle(point) + (-1 if self.clockwise else 1) * math.pi / 2
        return math.cos(angle), math.sin(angle)


Shape: TypeAlias = Straight | Curve


def shape_of(segment: Segment) -> Shape:
    """A path segment by its end points, mm."""
    start, end = _pair(segment.start), _pair(segment.end)
    if isinstance(segment, Line):
        return Straight(start, end)
    return Curve(start, end, _pair(segment.centre), clockwise=segment.sweep < 0)


def joined_box(boxes: list[Box]) -> Box:
    """The box around all `boxes`."""
    return (
        (min(b[0][0] for b in boxes), min(b[0][1] for b in boxes)),
        (max(b[1][0] for b in boxes), max(b[1][1] for b in boxes)),
    )


def _pair(point: NDArray[np.float64]) -> Point:
    return float(point[0]), float(point[1])
