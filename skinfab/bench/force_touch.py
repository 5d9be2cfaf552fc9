"""How many touches at known places it takes to straighten a sensor, and which of its defects they take out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from skinfab.fingertip.force.contact import Hemisphere
from skinfab.fingertip.force.touch_model import learn_touches
from skinfab.fingertip.force.touch_simulator import TouchScene, simulate_touches
from skinfab.progress import Progress, silent

#: Sensors: with all defects, with one alone, and with none.
DEFECTS = {
    "all defects": TouchScene(),
    "origin off alone": TouchScene(turn_deg=0.0, crosstalk=0.0),
    "turned alone": TouchScene(mount_mm=0.0, crosstalk=0.0),
    "cross-talk alone": TouchScene(mount_mm=0.0, turn_deg=0.0),
    "straight": TouchScene(mount_mm=0.0, turn_deg=0.0, crosstalk=0.0),
}
TOUCHES, SENSORS = (6, 8, 12), 15


@dataclass(frozen=True)
class TouchRow:
    """Sensors of one kind, each learned from so many touches.

    Parameters
    ----------
    sensor : str
    touches : int
    as_read_mm, learned_mm : float, mm
        Median over sensors of the error at places that were held out.
    worst_learned_mm : float, mm
        Of the sensors' errors the largest.
    helped : float
        Part of the sensors whose readings a matrix is taken for.
    """

    sensor: str
    touches: int
    as_read_mm: float
    learned_mm: float
    worst_learned_mm: float
    helped: float


def measure(
    *,
    defects: Mapping[str, TouchScene] = DEFECTS,
    touches: Sequence[int] = TOUCHES,
    sensors: int = SENSORS,
    progress: Progress = silent,
) -> list[TouchRow]:
    """A row for every kind of sensor and number of touches."""
    rows = []
    for k, (name, scene) in enumerate(defects.items()):
        for j, count in enumerate(touches):
            progress((k + j / len(touches)) / len(defects), f"touches, {name}, {count} of each sensor")
            made = [learn_touches(*simulate_touches(count, seed=seed, scene=scene), Hemisphere()) for seed in range(sensors)]
            read, learned = (np.array([getattr(each, of) for each in made]) for of in ("before_mm", "after_mm"))
            helped = float(np.mean([each.helps for each in made]))
            rows.append(TouchRow(name, count, float(np.median(read)), float(np.median(learned)), float(learned.max()), helped))
    return rows
