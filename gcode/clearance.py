"""Does a straight run of the nozzle keep away from what lies in its plane?"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gcode.geometry import Curve, Shape
from skinfab.tolerances import PREVIEW_CHORD_MM


def chords(shapes: Sequence[Shape], tolerance: float = PREVIEW_CHORD_MM) -> NDArray[np.float64]:
    """Shapes as straight pieces, (n, 2, 2) mm; arcs leave theirs by at most `tolerance` mm."""
    points = [s.chord_points(tolerance) if isinstance(s, Curve) else np.array((s.start, s.end)) for s in shapes]
    return np.concatenate([np.empty((0, 2, 2)), *(np.stack([p[:-1], p[1:]], axis=1) for p in points)])


class Laid:
    """Ink in the order it is laid; each shape is cut into chords once, however often a distance is asked for.

    Examples
    --------
    >>> from gcode.geometry import Straight
    >>> laid = Laid([Straight((0.0, 1.0), (5.0, 1.0))])
    >>> laid.add(Straight((0.0, 3.0), (5.0, 3.0)))
    >>> laid.distance([(1.0, 2.5), (2.0, 2.5)])
    0.5
    """

    def __init__(self, shapes: Sequence[Shape] = ()) -> None:
        self._waiting = list(shapes)
        self._pieces = np.empty((0, 2, 2))
        self._count = 0

    def add(self, shape: Shape) -> None:
        """One more."""
        self._waiting.append(shape)

    def distance(self, run: ArrayLike, *, within: float = np.inf) -> float:
        """Least distance of a straight run, (2, 2) mm, from all of it, as `distance`; ink further off than `within` may be passed over."""
        if self._waiting:
            new = chords(self._waiting)
            self._waiting = []
            count = self._count + len(new)
            if count > len(self._pieces):  # room for as many again, so that each piece is copied twice at most
                self._pieces = np.concatenate([self._pieces[: self._count], np.empty((2 * count - self._count, 2, 2))])
            self._pieces[self._count : count] = new
            self._count = count
        pieces, ends = self._pieces[: self._count], np.asarray(run, dtype=float)
        if math.isfinite(within):
            low, high = ends.min(axis=0) - within, ends.max(axis=0) + within
            for k in range(2):
                one, other = pieces[:, 0, k], pieces[:, 1, k]
                pieces = pieces[(np.minimum(one, other) <= high[k]) & (np.maximum(one, other) >= low[k])]
        return distance(ends, pieces)


def distance(run: ArrayLike, pieces: NDArray[np.float64]) -> float:
    """Least distance of one straight run, (2, 2) mm, from any of (n, 2, 2) mm; infinite where there is none.

    Examples
    --------
    >>> distance([(0, 0), (2, 0)], np.array([[(1, 1), (1, 3)], [(5, -1), (5, 1)]]))
    1.0
    """
    if not len(pieces):
        return np.inf
    a, b = np.asarray(run, dtype=float)
    p, q = pieces[:, 0], pieces[:, 1]
    if np.any(_cross(b - a, p - a) * _cross(b - a, q - a) < 0) and np.any(_crossing(a, b, p, q)):
        return 0.0
    # Two straight pieces that do not cross are closest at an end of one of them.
    ends = [_to_piece(a, p, q), _to_piece(b, p, q), _to_piece(p, a, b), _to_piece(q, a, b)]
    return float(np.min(ends))


def _cross(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _crossing(a: NDArray[np.float64], b: NDArray[np.float64], p: NDArray[np.float64], q: NDArray[np.float64]) -> NDArray[np.bool_]:
    return (_cross(b - a, p - a) * _cross(b - a, q - a) < 0) & (_cross(q - p, a - p) * _cross(q - p, b - p) < 0)


def _to_piece(point: NDArray[np.float64], p: NDArray[np.float64], q: NDArray[np.float64]) -> NDArray[np.float64]:
    along = q - p
    square = np.sum(along**2, axis=-1)
    t = np.clip(np.sum((point - p) * along, axis=-1) / np.where(square > 0, square, 1.0), 0, 1)
    return np.linalg.norm(point - p - t[..., None] * along, axis=-1)
