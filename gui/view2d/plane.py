"""Which part of the sheet a picture shows: millimetres to pixels and back."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]

#: From a bed in a thumbnail to a bead across the window.
LEAST_SCALE, MOST_SCALE = 0.05, 400.0


@dataclass(frozen=True)
class Plane:
    """Pixels count right and up from the picture's lower left corner.

    Parameters
    ----------
    scale : float
        Pixels per mm.
    x, y : float, pixels
        Where (0, 0) of the sheet lies.

    Examples
    --------
    >>> plane = Plane.fitted((0, 0), (100, 50), 240, 200, border=20)
    >>> plane.scale, plane.to_px([[0.0, 0.0], [100.0, 50.0]]).tolist()
    (2.0, [[20.0, 50.0], [220.0, 150.0]])
    >>> plane.zoomed(2, (20, 50)).to_mm([20, 50]).tolist()
    [0.0, 0.0]
    """

    scale: float = 1.0
    x: float = 0.0
    y: float = 0.0

    @staticmethod
    def fitted(low: ArrayLike, high: ArrayLike, width: float, height: float, *, border: float) -> Plane:
        """The box from `low` to `high`, mm, as large as it fits with so many pixels free on every side."""
        low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
        room = np.maximum([width - 2 * border, height - 2 * border], 1.0)
        scale = _bounded(float((room / np.maximum(high - low, 1e-6)).min()))
        x, y = np.array([width, height]) / 2 - scale * (low + high) / 2
        return Plane(scale, float(x), float(y))

    def to_px(self, points: ArrayLike) -> Float:
        """(..., 2) mm of the sheet in pixels."""
        return np.asarray(points, dtype=float) * self.scale + (self.x, self.y)

    def to_mm(self, points: ArrayLike) -> Float:
        """(..., 2) pixels in mm of the sheet."""
        return (np.asarray(points, dtype=float) - (self.x, self.y)) / self.scale

    def zoomed(self, factor: float, at: ArrayLike) -> Plane:
        """So many times as large; what is at the pixel `at` stays there."""
        scale = _bounded(self.scale * factor)
        x, y = np.asarray(at, dtype=float) - self.to_mm(at) * scale
        return Plane(scale, float(x), float(y))

    def moved(self, dx: float, dy: float) -> Plane:
        """Moved by so many pixels."""
        return replace(self, x=self.x + dx, y=self.y + dy)

    def step(self, least: float) -> float:
        """The round number of mm (1, 2 or 5 times a power of ten) that is at least so many pixels long."""
        need = least / self.scale
        power = 10.0 ** math.floor(math.log10(need))
        return next(k * power for k in (1, 2, 5, 10) if k * power >= need * (1 - 1e-9))


def _bounded(scale: float) -> float:
    return min(max(scale, LEAST_SCALE), MOST_SCALE)
