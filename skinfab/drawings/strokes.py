"""What the drawings share: a sensor's pads apart from its conductor, arcs short enough for a format."""

from __future__ import annotations

import math

import numpy as np

from skinfab.paths import Arc, Path, Point, Segment
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import JOIN_MM

#: Height of the drawings' letters and length of a seam's notch, mm.
TEXT_MM = 3.0
NOTCH_MM = 2.0


def pad_paths(sensor: Sensor) -> tuple[Path, ...]:
    """The strokes of the sensor's pads: what the printer draws before and after the conductor."""
    printed, conductor = sensor.printed_path.segments, sensor.path
    count = len(conductor.segments)
    for k in range(len(printed) - count + 1):
        if _near(printed[k].start, conductor.start) and _near(printed[k + count - 1].end, conductor.end):
            return tuple(Path(part) for part in (printed[:k], printed[k + count :]) if part)
    # A pattern that does not print its conductor as it is: show all that is printed, lose nothing.
    return (sensor.printed_path,)


def short_arcs(path: Path, *, longest: float) -> list[Segment]:
    """The path's segments, each arc of more than `longest` rad in equal parts."""
    out: list[Segment] = []
    for segment in path.segments:
        if isinstance(segment, Arc) and abs(segment.sweep) > longest:
            # A half-circle that rounding made a hair longer stays one arc.
            parts = math.ceil(abs(segment.sweep) / longest - 1e-9)
            sweep = segment.sweep / parts
            out += [Arc(segment.centre, segment.radius, segment.start_angle + k * sweep, sweep) for k in range(parts)]
        else:
            out.append(segment)
    return out


def _near(a: Point, b: Point) -> bool:
    return float(np.hypot(*(a - b))) <= JOIN_MM
