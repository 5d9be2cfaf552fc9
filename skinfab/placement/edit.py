"""Changing the sensors of a skin one at a time: move, turn, resize, wire otherwise, remove.

Each function takes all sensors and gives them back with one changed; whether that one still fits is for
`check.validate` to say, once all changes are made: two sensors can swap places.
"""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from skinfab.errors import InputError
from skinfab.paths import Point
from skinfab.patterns.base import Pattern
from skinfab.patterns.registry import make_pattern, parameters
from skinfab.placement.sensor import Sensor

Sensors = tuple[Sensor, ...]


def find(sensors: Sequence[Sensor], id: str) -> Sensor:
    """The sensor of that id.

    Raises
    ------
    InputError
        There is none; names those that there are.
    """
    for sensor in sensors:
        if sensor.id == id:
            return sensor
    ids = [s.id for s in sensors]
    near = difflib.get_close_matches(id, ids, n=1, cutoff=0.5)
    hint = f" (did you mean {near[0]}?)" if near else ""
    raise InputError(f"there is no sensor {id}{hint}; there are {', '.join(ids)}" if ids else f"there is no sensor {id}, nor any other")


def move(sensors: Sequence[Sensor], id: str, *, x: float, y: float, piece: str | None = None) -> Sensors:
    """Put a sensor's origin, the end of its lower lead, at (x, y) mm of its piece or of another one.

    Examples
    --------
    >>> strain = make_pattern("strain-lines", {"l1": 53, "l2": 43, "b": 6})
    >>> (moved,) = move([Sensor("S1", "P1", strain, 5.0, 5.0, 0.0, 0)], "S1", x=20.0, y=9.0)
    >>> moved.x, moved.y, moved.angle
    (20.0, 9.0, 0.0)
    """
    sensor = find(sensors, id)
    return _with(sensors, dataclasses.replace(sensor, piece=sensor.piece if piece is None else piece, x=float(x), y=float(y)))


def shift(sensors: Sequence[Sensor], id: str, *, dx: float, dy: float) -> Sensors:
    """Move a sensor by (dx, dy) mm."""
    sensor = find(sensors, id)
    return move(sensors, id, x=sensor.x + dx, y=sensor.y + dy)


def rotate(sensors: Sequence[Sensor], id: str, *, angle: float) -> Sensors:
    """Turn a sensor by `angle` rad, from x towards y, about its middle: the spot it is for stays."""
    sensor = find(sensors, id)
    turned = (sensor.angle + angle) % (2 * np.pi)
    return _with(sensors, _about_its_middle(sensor, sensor.pattern, turned))


def resize(sensors: Sequence[Sensor], id: str, params: Mapping[str, Any]) -> Sensors:
    """Give a sensor's pattern other parameters; the others, and the place of its middle, stay.

    Raises
    ------
    InputError
        No such sensor, or no such parameter of its pattern.
    PatternError
        A parameter breaks a bound.
    """
    sensor = find(sensors, id)
    try:
        pattern = make_pattern(sensor.pattern.kind, {**parameters(sensor.pattern), **params})
    except InputError as fault:
        raise InputError(f"{id}: {fault}") from fault
    return _with(sensors, _about_its_middle(sensor, pattern, sensor.angle))


def rewire(sensors: Sequence[Sensor], id: str, *, channel: int) -> Sensors:
    """Read a sensor on another channel, counted from 0."""
    if channel < 0:
        raise InputError(f"{id}: channel is {channel}; channels count from 0")
    return _with(sensors, dataclasses.replace(find(sensors, id), channel=channel))


def remove(sensors: Sequence[Sensor], id: str) -> Sensors:
    """All but one; the others keep their ids and channels."""
    gone = find(sensors, id)
    return tuple(s for s in sensors if s is not gone)


def middle_of(sensor: Sensor) -> Point:
    """Where the pattern's middle lies in the piece frame, (2,) mm."""
    return np.array([sensor.x, sensor.y]) + _turned(sensor.pattern.middle, sensor.angle)


def _about_its_middle(sensor: Sensor, pattern: Pattern, angle: float) -> Sensor:
    x, y = middle_of(sensor) - _turned(pattern.middle, angle)
    return dataclasses.replace(sensor, pattern=pattern, x=float(x), y=float(y), angle=float(angle))


def _turned(point: Point, angle: float) -> Point:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def _with(sensors: Sequence[Sensor], changed: Sensor) -> Sensors:
    return tuple(changed if s.id == changed.id else s for s in sensors)
