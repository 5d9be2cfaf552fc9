"""A pen that draws a path by going on from where it is: straight ahead, or round a bend."""

from __future__ import annotations

import math

import numpy as np

from skinfab.paths import Arc, Line, Path, Segment


class Pen:
    """Starts at (0, 0) and heads along +x; whatever it draws joins on without a corner, but for `turn`.

    Lengths are mm, angles rad, to the left positive.

    Examples
    --------
    >>> pen = Pen()
    >>> pen.forward(9.0)
    >>> pen.bend(1.0, math.pi)
    >>> pen.forward(9.0)
    >>> pen.path.end.round(9).tolist(), round(pen.path.length, 6)
    ([0.0, 2.0], 21.141593)
    """

    def __init__(self) -> None:
        self._at = np.zeros(2)
        self._heading = 0.0
        self._segments: list[Segment] = []

    @property
    def path(self) -> Path:
        """What has been drawn."""
        return Path(tuple(self._segments))

    def forward(self, length: float) -> None:
        """Straight ahead."""
        ahead = np.array([math.cos(self._heading), math.sin(self._heading)])
        self._segments.append(Line(self._at, self._at + length * ahead))
        self._at = self._segments[-1].end

    def bend(self, radius: float, angle: float) -> None:
        """Round an arc of that radius, through that angle."""
        side = math.copysign(math.pi / 2, angle)
        centre = self._at + radius * np.array([math.cos(self._heading + side), math.sin(self._heading + side)])
        self._segments.append(Arc(centre, radius, self._heading - side, angle))
        self._at = self._segments[-1].end
        self._heading += angle

    def turn(self, angle: float) -> None:
        """Head elsewhere, on the spot: a sharp corner."""
        self._heading += angle
