"""The lines of sensors on the sheet, for drawing and for taking hold of them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from gui.view2d.sheet import Sheet
from skinfab.patterns.base import Pattern
from skinfab.placement.edit import middle_of
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import PREVIEW_CHORD_MM

Float = NDArray[np.float64]

#: Patterns whose lines are kept.
_KEPT = 256


class Lines:
    """Polylines of patterns, made once and laid wherever a sensor is."""

    def __init__(self) -> None:
        self._shapes: dict[Pattern, Float] = {}

    def of(self, sensor: Sensor, sheet: Sheet) -> Float:
        """(k, 2) mm of the sheet: pad, conductor, pad."""
        c, s = np.cos(sensor.angle), np.sin(sensor.angle)
        line: Float = self._shape(sensor.pattern) @ np.array([[c, s], [-s, c]]) + (sensor.x, sensor.y) + sheet.offset_of(sensor.piece)
        return line

    def middle(self, sensor: Sensor, sheet: Sheet) -> Float:
        """(2,) mm of the sheet: the spot it is for."""
        return middle_of(sensor) + sheet.offset_of(sensor.piece)

    def handle(self, sensor: Sensor, sheet: Sheet, *, beyond: float) -> Float:
        """(2,) mm of the sheet: where one takes hold to turn it, `beyond` mm from its far end."""
        far = float(np.max(self._shape(sensor.pattern)[:, 0] - sensor.pattern.middle[0])) + beyond
        return self.middle(sensor, sheet) + far * np.array([np.cos(sensor.angle), np.sin(sensor.angle)])

    def nearest(self, point: Float, sensors: Iterable[Sensor], sheet: Sheet, *, reach: float) -> str:
        """Id of the sensor whose line passes within `reach` mm beside its bead; the last drawn wins, "" where none does."""
        best, found = reach, ""
        for sensor in sensors:
            line = self.of(sensor, sheet)
            low, high = line.min(axis=0) - best, line.max(axis=0) + best
            if (point < low).any() or (point > high).any():
                continue
            along = np.diff(line, axis=0)
            square = np.einsum("ij,ij->i", along, along)
            t = np.clip(np.einsum("ij,ij->i", point - line[:-1], along) / np.where(square > 0, square, 1.0), 0.0, 1.0)
            apart = float(np.hypot(*(point - line[:-1] - t[:, None] * along).T).min()) - sensor.pattern.bead / 2
            if apart <= best:
                best, found = max(apart, 0.0), sensor.id
        return found

    def _shape(self, pattern: Pattern) -> Float:
        if pattern not in self._shapes:
            while len(self._shapes) >= _KEPT:
                del self._shapes[next(iter(self._shapes))]
            self._shapes[pattern] = pattern.printed_path().to_polyline(tolerance=PREVIEW_CHORD_MM)
        return self._shapes[pattern]
