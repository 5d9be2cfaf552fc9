"""Exact distances between paths of lines and arcs, and from a path to a piece's edges.

Arcs stay arcs: a distance is never taken from chords. All pairs of segments are bounded from below by
their boxes; only those that can hold the minimum are computed.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.paths import Arc, Line, Path, Segment

Array = NDArray[np.float64]

#: So many of the most promising pairs are computed first; they bound the minimum for all others.
_FIRST_PAIRS = 64


@dataclass(frozen=True, eq=False)
class Curves:
    """Many lines and arcs as arrays, ready for distance queries.

    Parameters
    ----------
    p0, p1 : (n, 2) float, mm
        Ends.
    centre : (n, 2) float, mm
    radius : (n,) float, mm
        0 for a line.
    start, sweep : (n,) float, rad
        As in `paths.Arc`.
    low, high : (n, 2) float, mm
        Boxes that hold the curves.
    """

    p0: Array
    p1: Array
    centre: Array
    radius: Array
    start: Array
    sweep: Array
    low: Array
    high: Array

    def __len__(self) -> int:
        return len(self.p0)

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        """Round all of them: left, low, right, high, mm."""
        return (*self.low.min(axis=0).tolist(), *self.high.max(axis=0).tolist())

    @staticmethod
    def of_segments(segments: Sequence[Segment]) -> Curves:
        """From lines and arcs, for instance ``path.segments``."""
        ends = np.array([(s.start, s.end) for s in segments]).reshape(-1, 2, 2)
        boxes = np.array([s.bbox for s in segments]).reshape(-1, 2, 2)
        arcs = np.array([(*s.centre, s.radius, s.start_angle, s.sweep) if isinstance(s, Arc) else (0.0,) * 5 for s in segments]).reshape(
            -1, 5
        )
        return Curves(ends[:, 0], ends[:, 1], arcs[:, :2], arcs[:, 2], arcs[:, 3], arcs[:, 4], boxes[:, 0], boxes[:, 1])

    @staticmethod
    def of_edges(ends: Array) -> Curves:
        """From straight edges, (n, 2, 2) mm."""
        none = np.zeros(len(ends))
        p0, p1 = ends[:, 0], ends[:, 1]
        return Curves(p0, p1, np.zeros((len(ends), 2)), none, none, none, np.minimum(p0, p1), np.maximum(p0, p1))

    def take(self, index: NDArray[np.int64]) -> Curves:
        """The curves of those indices, in that order."""
        return Curves(*(getattr(self, name)[index] for name in self.__dataclass_fields__))

    def within(self, low: Array, high: Array) -> Curves:
        """Those whose box meets the box from `low` to `high`, (2,) mm each."""
        return self.take(np.flatnonzero(((self.high >= low) & (self.low <= high)).all(axis=1)))

    def moved(self, *, angle: float, shift: ArrayLike) -> Curves:
        """Turned about the origin by `angle` rad, then moved by `shift` mm: as ``Path.transformed``, for many tries."""
        c, s = np.cos(angle), np.sin(angle)
        turn, to = np.array([[c, s], [-s, c]]), np.asarray(shift, dtype=float)
        p0, p1, centre = (p @ turn + to for p in (self.p0, self.p1, self.centre))
        arc = self.radius[:, None] > 0
        # Whole circles for arcs: wider than need be, which costs a little time and no exactness.
        low = np.where(arc, centre - self.radius[:, None], np.minimum(p0, p1))
        high = np.where(arc, centre + self.radius[:, None], np.maximum(p0, p1))
        return Curves(p0, p1, centre, self.radius, self.start + angle, self.sweep, low, high)


def distance(one: Curves, two: Curves) -> float:
    """Least distance between any of `one` and any of `two`, mm; infinite where one of them is empty.

    Examples
    --------
    >>> ring = Curves.of_segments([Arc((0, 0), 1.0, 0.0, 2 * np.pi)])
    >>> distance(ring, Curves.of_edges(np.array([[[3.0, -1.0], [3.0, 1.0]]])))
    2.0
    """
    if not len(one) or not len(two):
        return math.inf
    apart = np.maximum(two.low[None] - one.high[:, None], one.low[:, None] - two.high[None])
    bound = np.hypot(*np.moveaxis(np.maximum(apart, 0.0), 2, 0)).ravel()
    first = np.argpartition(bound, _FIRST_PAIRS - 1)[:_FIRST_PAIRS] if len(bound) > _FIRST_PAIRS else np.arange(len(bound))
    best = _pairs_distance(one, two, first)
    rest = np.flatnonzero(bound < best)
    return min(best, _pairs_distance(one, two, rest)) if len(rest) else best


def distance_within(one: Curves, two: Curves, reach: float) -> float:
    """As `distance` where that is less than `reach` mm, and infinite where it is not: for most pairs, two boxes tell.

    Examples
    --------
    >>> wall, other = (Curves.of_edges(np.array([[[x, 0.0], [x, 9.0]]])) for x in (0.0, 3.0))
    >>> distance_within(wall, other, 5.0), distance_within(wall, other, 2.0)
    (3.0, inf)
    """
    if not len(one) or not len(two):
        return math.inf
    (left, low, right, high), (two_left, two_low, two_right, two_high) = one.box, two.box
    if left > two_right + reach or right < two_left - reach or low > two_high + reach or high < two_low - reach:
        return math.inf
    one = one.within(np.array([two_left - reach, two_low - reach]), np.array([two_right + reach, two_high + reach]))
    if not len(one):
        return math.inf
    two = two.within(one.low.min(axis=0) - reach, one.high.max(axis=0) + reach)
    apart = distance(one, two)
    return apart if apart < reach else math.inf


def self_distance(path: Path, *, apart: float) -> float:
    """Closest approach of a path to itself between points at least `apart` mm from each other along it.

    Points nearer than that along the path are one another's neighbours and always close. With `apart` = pi/2
    times a required distance d, the half-circle of diameter d just passes: its ends are d from each other.

    Parameters
    ----------
    path : Path
    apart : float, mm, > 0

    Returns
    -------
    float
        mm; infinite where the path is shorter than `apart`. Every pair of points from 9/8 `apart` on is seen, none
        nearer than `apart`; of those in between, some are.

    Examples
    --------
    >>> turn = Path((Line((0, 0), (9, 0)), Arc((9, 1), 1.0, -np.pi / 2, np.pi), Line((9, 2), (0, 2))))
    >>> round(self_distance(turn, apart=np.pi), 6)
    2.0
    """
    ends = np.cumsum([0.0, *(s.length for s in path.segments)])
    curves = Curves.of_segments(path.segments)
    count = len(path.segments)
    i, j = np.triu_indices(count, 1)
    free = ends[j] - ends[i + 1] >= apart
    best = _bounded_pairs(curves, i[free], j[free])
    parts = [
        pair
        for a, b in zip(i[~free].tolist(), j[~free].tolist(), strict=True)
        for pair in _far_parts(path.segments[a], path.segments[b], gap=ends[b] - ends[a + 1], apart=apart)
    ]
    if parts:
        ones, twos = (Curves.of_segments(side) for side in zip(*parts, strict=True))
        best = min(best, float(_curve_distance(ones, twos).min()))
    for s in path.segments:
        if isinstance(s, Arc) and s.length > apart:
            # The chord grows up to half a turn and shrinks again: its least value is at one of the two ends.
            best = min(best, *(2 * s.radius * abs(math.sin(along / (2 * s.radius))) for along in (apart, s.length)))
        elif s.length > apart:
            best = min(best, apart)
    return best


def _far_parts(one: Segment, two: Segment, *, gap: float, apart: float) -> Iterator[tuple[Segment, Segment]]:
    """Parts of two segments `gap` mm from each other along a path, `gap` < `apart`, that are `apart` from each other."""
    # Up to here on `one`, all of `two` is far enough along.
    clear = max(one.length + gap - apart, 0.0)
    if clear > 0:
        yield _part(one, 0.0, clear), two
    for low, high in itertools.pairwise(np.linspace(clear, one.length, 9)):
        skip = apart - gap - (one.length - high)
        if skip < two.length and high > low:
            yield _part(one, low, high), _part(two, max(skip, 0.0), two.length)


def _part(segment: Segment, low: float, high: float) -> Segment:
    """From `low` to `high` mm along a segment."""
    if isinstance(segment, Line):
        start, end = segment.point_at([low / segment.length, high / segment.length])
        return Line(start, end)
    turn = segment.sweep / segment.length
    return Arc(segment.centre, segment.radius, segment.start_angle + turn * low, turn * (high - low))


def _bounded_pairs(curves: Curves, i: NDArray[np.int64], j: NDArray[np.int64]) -> float:
    """Least distance over given pairs of one set of curves."""
    if not len(i):
        return math.inf
    apart = np.maximum(curves.low[j] - curves.high[i], curves.low[i] - curves.high[j])
    bound = np.hypot(*np.maximum(apart, 0.0).T)
    order = np.argsort(bound, kind="stable")
    best = math.inf
    for k in range(0, len(order), _FIRST_PAIRS):
        some = order[k : k + _FIRST_PAIRS]
        if bound[some[0]] >= best:
            break
        best = min(best, float(_curve_distance(curves.take(i[some]), curves.take(j[some])).min()))
    return best


def _pairs_distance(one: Curves, two: Curves, flat: NDArray[np.int64]) -> float:
    i, j = np.divmod(flat, len(two))
    return float(_curve_distance(one.take(i), two.take(j)).min())


def _curve_distance(one: Curves, two: Curves) -> Array:
    """Distance of each curve of `one` from the curve of `two` in the same place, (n,) mm."""
    out = np.empty(len(one))
    round_one, round_two = one.radius > 0, two.radius > 0
    for mine, kernel, swap in (
        (~round_one & ~round_two, _line_line, False),
        (~round_one & round_two, _line_arc, False),
        (round_one & ~round_two, _line_arc, True),
        (round_one & round_two, _arc_arc, False),
    ):
        k = np.flatnonzero(mine)
        if len(k):
            a, b = one.take(k), two.take(k)
            out[k] = kernel(b, a) if swap else kernel(a, b)
    return out


def _line_line(a: Curves, b: Curves) -> Array:
    ends = [_point_line(a.p0, b), _point_line(a.p1, b), _point_line(b.p0, a), _point_line(b.p1, a)]
    nearest = np.minimum.reduce(ends)
    # They cross where each one's ends lie strictly on either side of the other; touching is an end at distance 0.
    da, db = a.p1 - a.p0, b.p1 - b.p0
    split_b = _cross(da, b.p0 - a.p0) * _cross(da, b.p1 - a.p0) < 0
    split_a = _cross(db, a.p0 - b.p0) * _cross(db, a.p1 - b.p0) < 0
    return np.where(split_a & split_b, 0.0, nearest)


def _line_arc(line: Curves, arc: Curves) -> Array:
    ends = [_point_arc(line.p0, arc), _point_arc(line.p1, arc), _point_line(arc.p0, line), _point_line(arc.p1, line)]
    nearest = np.minimum.reduce(ends)
    # Inside both, the distance is least where the line is nearest to the centre, or 0 where it crosses the circle.
    along = line.p1 - line.p0
    length = np.hypot(*along.T)
    unit = along / np.where(length > 0, length, 1.0)[:, None]
    foot = np.einsum("ij,ij->i", arc.centre - line.p0, unit)
    to_foot = line.p0 + foot[:, None] * unit - arc.centre
    height = np.hypot(*to_foot.T)
    outside = (foot >= 0) & (foot <= length) & (height >= arc.radius) & _in_sweep(to_foot, arc)
    nearest = np.where(outside, np.minimum(nearest, height - arc.radius), nearest)
    half = np.sqrt(np.maximum(arc.radius**2 - height**2, 0.0))
    for side in (-half, half):
        crosses = (height < arc.radius) & (foot + side >= 0) & (foot + side <= length)
        crosses &= _in_sweep(to_foot + side[:, None] * unit, arc)
        nearest = np.where(crosses, 0.0, nearest)
    return nearest


def _arc_arc(a: Curves, b: Curves) -> Array:
    ends = [_point_arc(a.p0, b), _point_arc(a.p1, b), _point_arc(b.p0, a), _point_arc(b.p1, a)]
    nearest = np.minimum.reduce(ends)
    between = b.centre - a.centre
    span = np.hypot(*between.T)
    # Concentric arcs are nearest at an end of one of them.
    unit = between / np.where(span > 0, span, 1.0)[:, None]
    for side_a in (1.0, -1.0):
        for side_b in (1.0, -1.0):
            both = (span > 0) & _in_sweep(side_a * unit, a) & _in_sweep(side_b * unit, b)
            away = np.abs(span + side_b * b.radius - side_a * a.radius)
            nearest = np.where(both, np.minimum(nearest, away), nearest)
    # Crossing circles: two points at (along, +-across) of the line of centres.
    meets = (span > np.abs(a.radius - b.radius)) & (span < a.radius + b.radius)
    safe = np.where(meets, span, 1.0)
    along = (safe + (a.radius - b.radius) * (a.radius + b.radius) / safe) / 2
    across = np.sqrt(np.maximum(a.radius**2 - along**2, 0.0))
    normal = np.column_stack([-unit[:, 1], unit[:, 0]])
    for side in (across, -across):
        spoke = along[:, None] * unit + side[:, None] * normal
        crosses = meets & _in_sweep(spoke, a) & _in_sweep(spoke - between, b)
        nearest = np.where(crosses, 0.0, nearest)
    return nearest


def _point_line(p: Array, line: Curves) -> Array:
    along = line.p1 - line.p0
    square = np.einsum("ij,ij->i", along, along)
    t = np.einsum("ij,ij->i", p - line.p0, along) / np.where(square > 0, square, 1.0)
    return np.hypot(*(p - line.p0 - np.clip(t, 0.0, 1.0)[:, None] * along).T)


def _point_arc(p: Array, arc: Curves) -> Array:
    spoke = p - arc.centre
    ends = np.minimum(np.hypot(*(p - arc.p0).T), np.hypot(*(p - arc.p1).T))
    return np.where(_in_sweep(spoke, arc), np.abs(np.hypot(*spoke.T) - arc.radius), ends)


def _in_sweep(spoke: Array, arc: Curves) -> NDArray[np.bool_]:
    """Whether a direction from the centre lies within the arc."""
    turned = np.sign(arc.sweep) * (np.arctan2(spoke[:, 1], spoke[:, 0]) - arc.start) % (2 * np.pi)
    return turned <= np.abs(arc.sweep)


def _cross(u: Array, v: Array) -> Array:
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
