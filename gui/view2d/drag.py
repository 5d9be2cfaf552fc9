"""What a pointer does to sensors it has taken hold of: it moves them or turns one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.placement.edit import middle_of, rotate
from skinfab.placement.sensor import Sensor
from skinfab.placement.snap import Snapped, snap_angle, snap_point

Float = NDArray[np.float64]

#: Steps that a dragged middle and a dragged angle keep to.
GRID_MM = 1.0
ANGLE_STEP = np.radians(15.0)
#: Pixels from which another sensor's middle draws.
REACH_PX = 7.0


@dataclass(frozen=True, eq=False)
class Grabbed:
    """Sensors as they were when the pointer took hold.

    Parameters
    ----------
    sensors : tuple of Sensor
        The one under the pointer first.
    at : (2,) float, mm of the sheet
        Where the pointer was.
    turning : bool
        Whether it holds the handle that turns.
    offset : callable
        From the id of a piece to where its own (0, 0) lies, (2,) mm of the sheet.
    others : tuple of Sensor
        Those that stay.
    key : object
        Joins the steps of this one drag.
    """

    sensors: tuple[Sensor, ...]
    at: Float
    turning: bool
    offset: Callable[[str], Float]
    others: tuple[Sensor, ...]
    key: object = field(default_factory=object)

    def moved(self, to: Float, *, piece: str, snap: bool, reach: float) -> tuple[tuple[Sensor, ...], Float]:
        """The sensors when the pointer is at `to`, mm of the sheet.

        Parameters
        ----------
        to : (2,) float, mm of the sheet
        piece : str
            Under the pointer; "" where there is none, and sensors stay on theirs.
        snap : bool
        reach : float, mm
            From how far other middles draw.

        Returns
        -------
        sensors : tuple of Sensor
        guides : (k, 2, 2) float, mm of the sheet
            To the others they are in line with.
        """
        first = self.sensors[0]
        if self.turning:
            return (self._turned(first, to, snap),), np.zeros((0, 2, 2))
        goal = piece or first.piece
        shift = to - self.at
        here = self.offset(goal)
        middle = middle_of(first) + self.offset(first.piece) + shift - here
        guides = np.zeros((0, 2, 2))
        if snap:
            drawn = self._drawn(middle, goal, reach)
            shift, guides = shift + drawn.point - middle, drawn.lines + here
        result = []
        for sensor in self.sensors:
            target = goal if sensor.piece == first.piece else sensor.piece
            x, y = np.array([sensor.x, sensor.y]) + self.offset(sensor.piece) + shift - self.offset(target)
            result.append(replace(sensor, piece=target, x=round(float(x), 6), y=round(float(y), 6)))
        return tuple(result), guides

    def _drawn(self, middle: Float, piece: str, reach: float) -> Snapped:
        others = [middle_of(o) for o in self.others if o.piece == piece]
        return snap_point(middle, grid=GRID_MM, others=others, reach=reach)

    def _turned(self, sensor: Sensor, to: Float, snap: bool) -> Sensor:
        middle = middle_of(sensor) + self.offset(sensor.piece)
        before, after = self.at - middle, to - middle
        angle = sensor.angle + float(np.arctan2(after[1], after[0]) - np.arctan2(before[1], before[0]))
        if snap:
            angle = snap_angle(angle, step=ANGLE_STEP)
        return rotate((sensor,), sensor.id, angle=angle - sensor.angle)[0]
