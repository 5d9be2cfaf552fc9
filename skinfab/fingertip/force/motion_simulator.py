"""A fingertip in a grasp that slides, lets go, rolls, and does what looks like it: labelled logs of its six-axis sensor.

The contact is a point on the dome, pushed with a normal force and, across it, a part of what friction bears; static friction
is more than kinetic. Left out: the object's mass and the hand's springs (loads are drawn, not solved for), a contact with
an area, tremor, and the ripple of slip: the last two were in and changed no figure. The detector uses force, angle and point
alone, and these are what is simulated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.motion import ROLLING, SEPARATION, SLIDING, Motion
from skinfab.fingertip.force.simulator import as_read
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise

FloatArray = NDArray[np.float64]

#: What happens in a log, and what only looks like it: a load that nears the friction's limit slowly, a tug, another grip.
EPISODES = (
    "slide at once",
    "slide slowly",
    "roll",
    "let go at once",
    "let go slowly",
    "nearly slide",
    "tug",
    "grip harder",
    "grip lighter",
)


@dataclass(frozen=True)
class GraspScene:
    """How objects are held and what befalls them; pairs are the ends of a uniform distribution.

    Parameters
    ----------
    rate_hz : float
    friction_deg : float, deg
        Friction angle that is told to the detector ...
    friction_spread : float
        ... and by how much, relatively, the log's own differs from it at most.
    kinetic : float
        Friction while sliding, as a part of static friction.
    force_n : pair, N
        Normal force held.
    load : pair
        Part of the friction that the load takes while held.
    hold_s, event_s : pair, s
        Between episodes, and how long one lasts.
    quick_s, slow_s : pair, s
        How long a sudden change takes, and a slow one.
    roll_mm_s : pair, mm/s
    noise : SensorNoise
    offset_n, offset_nmm : float, N and N mm
        Standard deviation of the sensor's offset, which stays for a log.
    """

    rate_hz: float = 200.0
    friction_deg: float = 31.0
    friction_spread: float = 0.1
    kinetic: float = 0.85
    force_n: tuple[float, float] = (0.7, 3.0)
    load: tuple[float, float] = (0.1, 0.4)
    hold_s: tuple[float, float] = (0.8, 1.6)
    event_s: tuple[float, float] = (0.4, 1.2)
    quick_s: tuple[float, float] = (0.02, 0.06)
    slow_s: tuple[float, float] = (0.6, 1.2)
    roll_mm_s: tuple[float, float] = (6.0, 30.0)
    noise: SensorNoise = field(default_factory=SensorNoise)
    offset_n: float = 0.05
    offset_nmm: float = 0.5


class _Track:
    """Corners of a signal over time."""

    def __init__(self, value: float) -> None:
        self.times, self.values = [0.0], [value]

    def to(self, time: float, value: float) -> None:
        self.times.append(time)
        self.values.append(value)

    def at(self, time: FloatArray) -> FloatArray:
        return np.interp(time, self.times, self.values)


def grasp_log(*, seed: int, scene: GraspScene | None = None, episodes: int = 12) -> tuple[WrenchLog, tuple[Motion, ...]]:
    """One grasp: it begins untouched for a second, and each of so many episodes is drawn from `EPISODES`.

    Examples
    --------
    >>> log, truth = grasp_log(seed=1)
    >>> log.simulated, log.force.shape[1], {each.kind for each in truth} <= {"sliding", "separation", "rolling"}
    (True, 3, True)
    """
    scene = scene or GraspScene()
    rng = np.random.default_rng(seed)
    drawn = [EPISODES[k % len(EPISODES)] for k in rng.permutation(max(episodes, len(EPISODES)))[:episodes]]
    friction = math.tan(math.radians(scene.friction_deg)) * (1 + scene.friction_spread * rng.uniform(-1, 1))
    held, load = rng.uniform(*scene.force_n), rng.uniform(*scene.load)
    normal, lean, polar = _Track(0.0), _Track(load), _Track(rng.uniform(-0.5, 0.5))
    truth: list[Motion] = []
    t = 1.0
    normal.to(t, 0.0)
    normal.to(t + 0.1, held)
    t += 0.1 + rng.uniform(*scene.hold_s)
    for episode in drawn:
        quick, slow, lasts = rng.uniform(*scene.quick_s), rng.uniform(*scene.slow_s), rng.uniform(*scene.event_s)
        if episode.startswith("slide"):
            onset = t + (quick if episode.endswith("once") else slow)
            lean.to(t, load)
            lean.to(onset, 1.0)
            lean.to(onset + quick, scene.kinetic)
            lean.to(onset + quick + lasts, scene.kinetic)
            t = onset + quick + lasts
            truth.append(Motion(SLIDING, onset, t, onset))
            lean.to(t + quick, load)
            t += quick
        elif episode == "roll":
            way = rng.uniform(*scene.roll_mm_s) / RADIUS_MM * lasts * (-1 if polar.values[-1] > 0 else 1)
            polar.to(t, polar.values[-1])
            polar.to(t + lasts, max(min(polar.values[-1] + way, 1.0), -1.0))
            truth.append(Motion(ROLLING, t, t + lasts, t))
            t += lasts
        elif episode.startswith("let"):
            takes = quick if episode.endswith("once") else slow
            normal.to(t, held)
            normal.to(t + takes, 0.0)
            normal.to(t + takes + lasts, 0.0)
            back = t + takes + lasts
            truth.append(Motion(SEPARATION, t + takes / 2, back + quick / 2, t + takes / 2))  # from where half of the force is gone
            normal.to(back + quick, held)
            t = back + quick
        elif episode in ("nearly slide", "tug"):
            takes, peak = (slow, 0.8) if episode.startswith("nearly") else (quick, 0.6)
            lean.to(t, load)
            lean.to(t + takes, peak)
            lean.to(t + takes + 0.3, peak)
            lean.to(t + 2 * takes + 0.3, load)
            t += 2 * takes + 0.3
        else:
            normal.to(t, held)
            held = min(max(held * (1.4 if episode.endswith("harder") else 0.7), scene.force_n[0]), scene.force_n[1])
            normal.to(t + slow, held)
            t += slow
        t += rng.uniform(*scene.hold_s)
    normal.to(t, held)
    time = np.arange(round(t * scene.rate_hz)) / scene.rate_hz
    force, moment = _wrench(time, normal, lean, polar, friction, rng, scene)
    return WrenchLog(f"grasp-{seed}", time, force, moment, "grasp", str(seed), simulated=True), tuple(truth)


def _wrench(
    time: FloatArray,
    normal: _Track,
    lean: _Track,
    polar: _Track,
    friction: float,
    rng: np.random.Generator,
    scene: GraspScene,
) -> tuple[FloatArray, FloatArray]:
    """Force and moment as they are read."""
    azimuth, across = rng.uniform(0, 2 * math.pi, 2)
    angle = polar.at(time)
    out = np.column_stack([np.sin(angle) * math.cos(azimuth), np.sin(angle) * math.sin(azimuth), np.cos(angle)])
    first = np.column_stack([np.cos(angle) * math.cos(azimuth), np.cos(angle) * math.sin(azimuth), -np.sin(angle)])
    second = np.cross(out, first)
    tangent = math.cos(across) * first + math.sin(across) * second
    force = normal.at(time)[:, None] * (-out + (friction * lean.at(time))[:, None] * tangent)
    return as_read(force, np.cross(RADIUS_MM * out, force), rng, noise=scene.noise, offset_n=scene.offset_n, offset_nmm=scene.offset_nmm)
