"""A cup with water in it, after it was stirred: the water is a pendulum that hangs in the cup, as the paper models it.

The rod pulls at its pivot with the tension m (g cos a + l a'^2), a being the swing's angle, which dies away; the cup and
the part of the water that does not swing are rigid. Left out: waves of higher order, the stick, spilling, and the hand giving way.
A hand that trembles shakes the cup along one direction, in a band about 4 Hz: where water swings too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.gravity import GRAVITY
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import as_read
from skinfab.fingertip.force.wrench import SensorNoise

FloatArray = NDArray[np.float64]

RATE_HZ = 200.0
#: Of the whole hand: four sensors, of which each reads 0.02 N and 0.2 N mm, 40 mm from the cup's middle.
HAND_NOISE = SensorNoise(0.04, 1.7)
#: Where a hand trembles, Hz, and how wide that is beside it.
_TREMBLE_HZ, _TREMBLE_WIDTH = 4.0, 0.2
_CUP_KG, _CUP_MM, _PIVOT_MM = 0.15, (2.0, -1.0, 140.0), (2.0, -1.0, 165.0)
#: Water in a cup of radius r swings as a pendulum of length r / 1.84 (its first mode): 22 mm where it is 80 mm wide.
_ROD_MM = 22.0
WAYS = ("lateral", "circumferential")


@dataclass(frozen=True)
class CupScene:
    """How a cup is held, and what reads it.

    Parameters
    ----------
    damping : float
        Of the swing, as a part of the critical one.
    fling : float
        Part of the pull that comes of the swing's own speed: 1; 0 leaves the tension of a rod that leans.
    noise : SensorNoise
        Of the whole hand.
    offset_n, offset_nmm : float
        Standard deviation of the offsets.
    drift_nmm_s : float
        Of the sensor, in each component of the moment.
    tremble_mm_s2 : float
        Root mean square of the hand's acceleration; 0 where it keeps still.
    """

    damping: float = 0.02
    fling: float = 1.0
    noise: SensorNoise = HAND_NOISE
    offset_n: float = 0.1
    offset_nmm: float = 5.0
    drift_nmm_s: float = 0.0
    tremble_mm_s2: float = 0.0


def stir(
    *,
    water_kg: float,
    way: str = "lateral",
    angle_deg: float = 10.0,
    seconds: float = 6.0,
    scene: CupScene | None = None,
    seed: int | Sequence[int] = 0,
) -> WrenchLog:
    """What the hand reads after the stick was taken out, in its own frame, upright.

    Parameters
    ----------
    water_kg : float
        That swings; 0: an empty cup.
    way : str
        ``lateral`` or ``circumferential``.
    angle_deg : float
        Of the swing at the beginning.
    seconds : float
    scene : CupScene, optional
    seed : int or sequence of int

    Raises
    ------
    InputError
        There is no such way to stir.
    """
    if way not in WAYS:
        raise InputError(f"a cup is not stirred {way!r}; there are {', '.join(WAYS)}")
    scene, rng = scene or CupScene(), np.random.default_rng(seed)
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    rod = _ROD_MM / 1000
    omega = float(np.sqrt(GRAVITY / rod))
    fading = np.radians(angle_deg) * np.exp(-scene.damping * omega * time)
    phase = omega * time + rng.uniform(0, 2 * np.pi)
    if way == "lateral":
        swing = np.column_stack([fading * np.cos(phase), np.zeros(len(time))])
        speed = fading * omega * np.sin(phase)
    else:
        swing = np.column_stack([fading * np.cos(phase), fading * np.sin(phase)])
        speed = fading * omega
    turn = rng.uniform(0, 2 * np.pi)
    swing = swing @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    angle = np.linalg.norm(swing, axis=1)
    rod_direction = np.column_stack([np.sinc(angle / np.pi)[:, None] * swing, -np.cos(angle)])
    pull = water_kg * (GRAVITY * np.cos(angle) + scene.fling * rod * speed**2)[:, None] * rod_direction
    weight = np.array([0.0, 0.0, -_CUP_KG * GRAVITY])
    force = pull + weight
    moment = np.cross(np.array(_PIVOT_MM), pull) + np.cross(np.array(_CUP_MM), weight) + scene.drift_nmm_s * time[:, None]
    if scene.tremble_mm_s2:
        shaken = -(_CUP_KG + water_kg) * scene.tremble_mm_s2 / 1000 * _trembling(len(time), rng)
        force, moment = force + shaken, moment + np.cross(np.array(_CUP_MM), shaken)
    force, moment = as_read(force, moment, rng, noise=scene.noise, offset_n=scene.offset_n, offset_nmm=scene.offset_nmm)
    return WrenchLog(f"{way} {1000 * water_kg:g} g", time, force, moment, "liquid" if water_kg else "solid", simulated=True)


def _trembling(count: int, rng: np.random.Generator) -> FloatArray:
    """(n, 3) of unit root mean square: one direction, noise in a band about where a hand trembles."""
    frequency = np.fft.rfftfreq(count, 1 / RATE_HZ)
    band = np.exp(-0.5 * ((frequency - _TREMBLE_HZ) / (_TREMBLE_WIDTH * _TREMBLE_HZ)) ** 2)
    shape = np.fft.irfft(band * np.fft.rfft(rng.standard_normal(count)), count)
    way = rng.standard_normal(3)
    return np.outer(shape / shape.std(), way / np.linalg.norm(way))
