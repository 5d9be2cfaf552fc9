"""An edge as a fingertip feels it: how far off, which way, how deep, and how sure that is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Edge:
    """The edge of a plate in the fingertip's frame.

    Parameters
    ----------
    offset_mm : float
        How far the fingertip's centre lies off the plate; negative where it lies on it.
    angle_rad : float
        Direction in which one leaves the plate, across the edge, from x towards y.
    depth_mm : float
        How far the dome is pressed in; NaN where it is not told.
    confidence : float
        From 0 (nothing like what was learned) to 1.

    Examples
    --------
    >>> felt = Edge(offset_mm=1.0, angle_rad=0.0)
    >>> felt.outward.tolist(), felt.along.tolist(), felt.nearest.tolist()
    ([1.0, 0.0], [-0.0, 1.0], [-1.0, -0.0])
    """

    offset_mm: float
    angle_rad: float
    depth_mm: float = math.nan
    confidence: float = 1.0

    @property
    def outward(self) -> NDArray[np.float64]:
        """Unit vector off the plate."""
        return np.array([math.cos(self.angle_rad), math.sin(self.angle_rad)])

    @property
    def along(self) -> NDArray[np.float64]:
        """Unit vector along the edge, with the plate on the left hand: counter-clockwise round it."""
        x, y = self.outward
        return np.array([-y, x])

    @property
    def nearest(self) -> NDArray[np.float64]:
        """From the fingertip's centre to the nearest point of the edge, mm."""
        return -self.offset_mm * self.outward
