"""Flat plates whose edges a fingertip feels: a rectangle, a hexagon, a disk, an edge without end.

Each tells how far points lie from its edge: negative on the plate, positive beside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]


class Plate(Protocol):
    """What a fingertip is pressed on."""

    def distance(self, X: FloatArray) -> FloatArray:
        """Signed distance of points (..., 2) from the edge, mm: negative on the plate."""
        ...


class Outline(Plate, Protocol):
    """A plate whose edge closes: it can be followed all round."""

    @property
    def area(self) -> float:
        """Of the plate, mm^2."""
        ...

    @property
    def length(self) -> float:
        """Of its edge, mm."""
        ...

    @property
    def start(self) -> FloatArray:
        """A point of its edge, (2,) mm."""
        ...

    def outline(self) -> FloatArray:
        """Points along the edge for drawing, (n, 2) mm, the first not repeated."""
        ...


@dataclass(frozen=True)
class HalfPlane:
    """A plate that ends at one straight edge.

    Parameters
    ----------
    offset_mm : float
        How far the origin lies off the plate; negative where it lies on it.
    angle_rad : float
        Direction in which one leaves the plate, from x towards y.

    Examples
    --------
    >>> HalfPlane(2.0, 0.0).distance(np.array([[0.0, 5.0], [-3.0, 0.0]])).tolist()
    [2.0, -1.0]
    """

    offset_mm: float
    angle_rad: float

    def distance(self, X: FloatArray) -> FloatArray:
        """Signed distance of points (..., 2) from the edge, mm."""
        return X[..., 0] * math.cos(self.angle_rad) + X[..., 1] * math.sin(self.angle_rad) + self.offset_mm


@dataclass(frozen=True)
class Disk:
    """A round plate about the origin.

    Parameters
    ----------
    radius_mm : float

    Raises
    ------
    InputError
        The radius is not a positive number.
    """

    radius_mm: float

    def __post_init__(self) -> None:
        if not 0 < self.radius_mm < math.inf:
            raise InputError(f"a disk of radius {self.radius_mm:g} mm; it must be positive")

    def distance(self, X: FloatArray) -> FloatArray:
        """Signed distance of points (..., 2) from the edge, mm."""
        out: FloatArray = np.hypot(X[..., 0], X[..., 1]) - self.radius_mm
        return out

    @property
    def area(self) -> float:
        """mm^2."""
        return math.pi * self.radius_mm**2

    @property
    def length(self) -> float:
        """Of the edge, mm."""
        return 2 * math.pi * self.radius_mm

    @property
    def start(self) -> FloatArray:
        """A point of the edge."""
        return np.array([self.radius_mm, 0.0])

    def outline(self) -> FloatArray:
        """A hundred and twenty points, (120, 2) mm."""
        turn = np.arange(120) * math.tau / 120
        return self.radius_mm * np.c_[np.cos(turn), np.sin(turn)]


@dataclass(frozen=True, eq=False)
class Polygon:
    """A convex plate with straight sides.

    Parameters
    ----------
    corners : (k, 2) float, mm
        Counter-clockwise.

    Raises
    ------
    InputError
        The corners are fewer than three, not numbers, or do not turn left throughout.

    Examples
    --------
    >>> square = Polygon(np.array([[0, 0], [10, 0], [10, 10], [0, 10]], dtype=float))
    >>> square.area, square.length, square.sides.tolist()
    (100.0, 40.0, [10.0, 10.0, 10.0, 10.0])
    >>> square.distance(np.array([[5.0, 5.0], [13.0, 14.0]])).tolist()
    [-5.0, 5.0]
    """

    corners: FloatArray

    def __post_init__(self) -> None:
        C = np.asarray(self.corners, dtype=float)
        object.__setattr__(self, "corners", C)
        if C.ndim != 2 or C.shape[0] < 3 or C.shape[1] != 2 or not np.isfinite(C).all():
            raise InputError(f"a plate's corners have shape {C.shape}; three or more points of two finite numbers are needed")
        along = np.roll(C, -1, axis=0) - C
        after = np.roll(along, -1, axis=0)
        turns = np.arctan2(along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0], (along * after).sum(axis=1))
        if not (turns > 0).all() or turns.sum() > 3 * math.pi:  # a star turns left throughout as well, but twice round
            raise InputError("a plate's corners do not turn left all the way round; give those of a convex plate, counter-clockwise")

    @cached_property
    def _along(self) -> tuple[FloatArray, FloatArray]:
        """Directions and lengths of the sides."""
        v = np.roll(self.corners, -1, axis=0) - self.corners
        size = np.linalg.norm(v, axis=1)
        return v / size[:, None], size

    def distance(self, X: FloatArray) -> FloatArray:
        """Signed distance of points (..., 2) from the edge, mm."""
        x, y = X[..., 0], X[..., 1]
        inside, beside = np.full(x.shape, -np.inf), np.full(x.shape, np.inf)
        for (cx, cy), (tx, ty), size in zip(self.corners.tolist(), self._along[0].tolist(), self.sides.tolist(), strict=True):
            dx, dy = x - cx, y - cy
            off, past = dx * ty - dy * tx, dx * tx + dy * ty
            aside = past - np.clip(past, 0, size)
            np.maximum(inside, off, out=inside)
            np.minimum(beside, off * off + aside * aside, out=beside)
        return np.where(inside <= 0, inside, np.sqrt(beside))

    @property
    def area(self) -> float:
        """mm^2."""
        x, y = self.corners.T
        return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2

    @property
    def sides(self) -> FloatArray:
        """Their lengths, (k,) mm."""
        return self._along[1]

    @property
    def length(self) -> float:
        """Of the edge, mm."""
        return float(self.sides.sum())

    @property
    def start(self) -> FloatArray:
        """The middle of the first side."""
        out: FloatArray = (self.corners[0] + self.corners[1]) / 2
        return out

    def outline(self) -> FloatArray:
        """The corners."""
        return self.corners


@dataclass(frozen=True, eq=False)
class Moved:
    """A plate as the fingertip has it before it: at its own centre, turned with it.

    Parameters
    ----------
    plate : Plate
    at : (2,) float, mm
        Where the fingertip's centre is.
    turn_rad : float
        How far the fingertip is turned about its axis.
    """

    plate: Plate
    at: FloatArray
    turn_rad: float = 0.0

    def distance(self, X: FloatArray) -> FloatArray:
        """Signed distance of points (..., 2) in the fingertip's frame, mm."""
        if not self.turn_rad:
            return self.plate.distance(X + np.asarray(self.at, dtype=float))
        c, s = math.cos(self.turn_rad), math.sin(self.turn_rad)
        return self.plate.distance(X @ np.array([[c, s], [-s, c]]) + np.asarray(self.at, dtype=float))
