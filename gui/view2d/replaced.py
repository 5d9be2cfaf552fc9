"""A document with some of its sensors changed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin


def with_sensors(skin: Skin, changed: Iterable[Sensor]) -> Skin | None:
    """The document with each changed sensor in the place of the one of its id; None where that changes nothing."""
    new = {sensor.id: sensor for sensor in changed}
    sensors = tuple(new.get(sensor.id, sensor) for sensor in skin.sensors)
    return None if sensors == skin.sensors else replace(skin, sensors=sensors)
