"""Touches at marked places of a dome, read by a sensor that is mounted a little off. Simulated.

A stylus rests beside the dome, then pushes at a mark with a force that grows and leans to all sides. The sensor's origin lies off the
dome's centre, it is turned, its axes read one another; the mark is not exactly where it is drawn. Left out: a contact's area, a
stylus that slides, hysteresis. Which of these defects does what to the error: docs/force.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from skinfab.fingertip.force.gravity import cross_matrices
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import as_read
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise

FloatArray = NDArray[np.float64]

#: A mark is at least so high above the rim, as the cosine of its angle to the pole: a stylus must get there.
_LOWEST = 0.35


@dataclass(frozen=True)
class TouchScene:
    """How far a sensor is off, and how it is touched; scatters are standard deviations.

    Parameters
    ----------
    mount_mm : float, mm
        Of its origin, along each axis.
    turn_deg : float, deg
        About each axis.
    crosstalk : float
        Of each axis onto each, and of its gain, as a part; a moment counts as a force at the dome's radius.
    place_mm : float, mm
        Of a mark along each axis.
    force_n : float, N
        The strongest push.
    lean_deg : float, deg
        From the normal.
    rest_s, push_s, rate_hz : float
    noise : SensorNoise
    offset_n, offset_nmm : float
    """

    mount_mm: float = 1.0
    turn_deg: float = 2.0
    crosstalk: float = 0.02
    place_mm: float = 0.3
    force_n: float = 3.0
    lean_deg: float = 25.0
    rest_s: float = 0.6
    push_s: float = 3.0
    rate_hz: float = 200.0
    noise: SensorNoise = field(default_factory=SensorNoise)
    offset_n: float = 0.05
    offset_nmm: float = 0.5


def defects(scene: TouchScene, rng: np.random.Generator) -> FloatArray:
    """What a sensor makes of force and moment, (6, 6)."""
    turn = Rotation.from_rotvec(np.radians(scene.turn_deg) * rng.standard_normal(3)).as_matrix()
    out = np.zeros((6, 6))
    out[:3, :3] = out[3:, 3:] = turn
    out[3:, :3] = -turn @ cross_matrices(scene.mount_mm * rng.standard_normal((1, 3)))[0]
    scale = np.array([1.0] * 3 + [RADIUS_MM] * 3)
    mixed: FloatArray = np.eye(6) + scene.crosstalk * rng.standard_normal((6, 6)) * np.outer(scale, 1 / scale)
    return mixed @ out


def read_crooked(log: WrenchLog, *, seed: int | Sequence[int] = 0, scene: TouchScene | None = None) -> WrenchLog:
    """What a straight sensor reads, as the sensor of `simulate_touches` of this seed would; the noise is turned and mixed with the rest.

    Examples
    --------
    >>> straight = WrenchLog("a", np.arange(2.0), np.ones((2, 3)), np.zeros((2, 3)), simulated=True)
    >>> bool(np.abs(read_crooked(straight, seed=1).moment).max() > 0.5)
    True
    """
    wrench = np.hstack([log.force, log.moment]) @ defects(scene or TouchScene(), np.random.default_rng(seed)).T
    return replace(log, force=np.ascontiguousarray(wrench[:, :3]), moment=np.ascontiguousarray(wrench[:, 3:]))


def simulate_touches(
    count: int = 12, *, seed: int | Sequence[int] = 0, scene: TouchScene | None = None
) -> tuple[list[WrenchLog], dict[str, FloatArray]]:
    """So many touches all over the dome by one sensor, and where they are said to be.

    Examples
    --------
    >>> logs, places = simulate_touches(3, seed=1)
    >>> [log.name for log in logs], round(float(np.linalg.norm(places["touch-1.csv"])), 6), logs[0].simulated
    (['touch-1.csv', 'touch-2.csv', 'touch-3.csv'], 20.0, True)
    """
    scene, rng = scene or TouchScene(), np.random.default_rng(seed)
    reads = defects(scene, rng)
    offset_n, offset_nmm = scene.offset_n * rng.standard_normal(3), scene.offset_nmm * rng.standard_normal(3)
    logs, places = [], {}
    for k in range(count):
        # Evenly over the dome: the golden angle round, equal steps up.
        height, angle = 1 - (1 - _LOWEST) * (k + 0.5) / count, k * np.pi * (3 - np.sqrt(5))
        out = np.array([np.sqrt(1 - height**2) * np.cos(angle), np.sqrt(1 - height**2) * np.sin(angle), height])
        name = f"touch-{k + 1}.csv"
        places[name] = RADIUS_MM * out
        there = out + scene.place_mm / RADIUS_MM * rng.standard_normal(3)
        time, force = _push(there / np.linalg.norm(there), scene, rng)
        point = RADIUS_MM * there / np.linalg.norm(there)
        wrench = np.hstack([force, np.cross(point, force)]) @ reads.T
        read = as_read(wrench[:, :3] + offset_n, wrench[:, 3:] + offset_nmm, rng, noise=scene.noise)
        logs.append(WrenchLog(name, time, *read, name, name, simulated=True))
    return logs, places


def _push(out: FloatArray, scene: TouchScene, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Time and force (n, 3): nothing, then a push that grows, circling about the normal."""
    time = np.arange(round((scene.rest_s + scene.push_s) * scene.rate_hz)) / scene.rate_hz
    part = np.clip((time - scene.rest_s) / scene.push_s, 0.0, 1.0)
    side = np.cross(out, rng.standard_normal(3))
    side /= np.linalg.norm(side)
    turn = 4 * np.pi * part + rng.uniform(0, 2 * np.pi)
    lean = np.radians(scene.lean_deg) * np.sqrt(part)
    around = np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * np.cross(out, side)
    way = np.sin(lean)[:, None] * around - np.cos(lean)[:, None] * out
    return time, scene.force_n * part[:, None] * way
