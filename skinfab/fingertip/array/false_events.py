"""What is told of a finger that does not move, by force and rate: presses held still, and presses that come and go.

Beside them those that do slip or roll, so that silence is not all there is. Gains are not learned.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.analyser import Analyser
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.simulator import Device

FloatArray = NDArray[np.float64]

#: Held so hard (N), read so often a second, and so many frames long; those that come and go take so long each way, and stay, s.
FORCES, RATES, FRAMES = (0.12, 0.2, 0.3, 0.5, 1.0, 3.0), (15.0, 50.0, 100.0, 200.0), 100
RAMP_S, STAY_S = 0.4, 0.2
HOW = ("still", "ramped", "slipped", "rolled")
#: What slips goes so far at once, what rolls so far at so many mm/s, both around the finger and after so long, s; then they stay.
SLIPPED_MM, ROLLED_MM, ROLLED_MM_S, BEFORE_S = 4.0, 6.0, 8.0, 1.0


@dataclass(frozen=True)
class Stood:
    """Touches, and what was told of them: as many touches and lifts, and a slip or roll each where they did (`HOW`), would be right."""

    how: str
    force_n: float
    rate_hz: float
    presses: int
    touch: int
    lift: int
    slip: int
    roll: int
    simulated: bool = True


def false_events(
    presses: int, *, forces: Sequence[float] = FORCES, rates: Sequence[float] = RATES, frames: int = FRAMES, how: Sequence[str] = HOW
) -> list[Stood]:
    """A row for each force, rate and way, of presses anywhere but at the ends.

    Examples
    --------
    >>> (one,) = false_events(2, forces=(1.0,), rates=(15.0,), frames=10, how=("still",))
    >>> one.touch, one.slip, one.roll
    (2, 0, 0)
    """
    return [_stood(way, force, rate, presses, frames) for way in how for force in forces for rate in rates]


def _stood(how: str, force: float, rate: float, presses: int, frames: int) -> Stood:
    geometry = Geometry()
    device, rng = Device(geometry, seed=1), np.random.default_rng((17, round(100 * force), round(rate)))
    model, counts = ArrayModel.nominal(geometry), Counter[str]()
    for _ in range(presses):
        axial, angle = rng.uniform(4, 22), rng.uniform(-math.pi, math.pi)
        read = Analyser(model, noise=device.errors.noise)
        at, Z = math.nan, np.zeros(geometry.shape)
        for k, (part, around) in enumerate(_path(how, rate, frames).tolist()):
            if around != at:
                Z, at = device.skin.pressed(force, axial_mm=axial, angle_rad=angle + around / geometry.finger_radius), around
            counts.update(event.kind for event in read.frame(k / rate, device.noisy(part * Z, rng)).events)
        counts.update(event.kind for event in read.finish())
    return Stood(how, force, rate, presses, counts["touch"], counts["lift"], counts["slip"], counts["roll"])


def _path(how: str, rate: float, frames: int) -> FloatArray:
    """How much of its force each frame has, and how far around it is, mm: (n, 2)."""
    if how == "ramped":
        t = np.arange(0.0, 2 * RAMP_S + STAY_S + 3 / rate, 1 / rate)
        part = np.clip(np.minimum(t / RAMP_S, (2 * RAMP_S + STAY_S - t) / RAMP_S), 0.0, 1.0)
        return np.column_stack([part, np.zeros(len(t))])
    t = np.arange(frames if how == "still" else round((2 * BEFORE_S + ROLLED_MM / ROLLED_MM_S) * rate)) / rate
    around = {
        "still": np.zeros(len(t)),
        "slipped": SLIPPED_MM * (t > BEFORE_S),
        "rolled": np.clip((t - BEFORE_S) * ROLLED_MM_S, 0.0, ROLLED_MM),
    }[how]
    return np.vstack([np.column_stack([np.ones(len(t)), around]), np.zeros((3, 2))])
