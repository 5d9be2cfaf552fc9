"""A cup with water in it, after it was stirred: the water is a pendulum that hangs in the cup, as the paper models it.

The rod pulls at its pivot with the tension m (g cos a + l a'^2), a being the swing's angle, which dies away; the cup and
the part of the water that does not swing are rigid. Left out: waves of higher order, the stick, spilling, and the hand giving way.
"""

from __future__ import annotations

from collections.abc import Sequence

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
_CUP_KG, _CUP_MM, _PIVOT_MM = 0.15, (2.0, -1.0, 140.0), (2.0, -1.0, 165.0)
#: Water in a cup of radius r swings as a pendulum of length r / 1.84 (its first mode): 22 mm where it is 80 mm wide.
_ROD_MM, _DAMPING = 22.0, 0.02
WAYS = ("lateral", "circumferential")


def stir(
    *,
    water_kg: float,
    way: str = "lateral",
    angle_deg: float = 10.0,
    seconds: float = 6.0,
    drift_nmm_s: float = 0.0,
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
    drift_nmm_s : float
        Of the sensor, in each component of the moment.
    seed : int or sequence of int

    Raises
    ------
    InputError
        There is no such way to stir.
    """
    if way not in WAYS:
        raise InputError(f"a cup is not stirred {way!r}; there are {', '.join(WAYS)}")
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    rod = _ROD_MM / 1000
    omega = float(np.sqrt(GRAVITY / rod))
    fading = np.radians(angle_deg) * np.exp(-_DAMPING * omega * time)
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
    pull = water_kg * (GRAVITY * np.cos(angle) + rod * speed**2)[:, None] * rod_direction
    weight = np.array([0.0, 0.0, -_CUP_KG * GRAVITY])
    force = pull + weight
    moment = np.cross(np.array(_PIVOT_MM), pull) + np.cross(np.array(_CUP_MM), weight) + drift_nmm_s * time[:, None]
    force, moment = as_read(force, moment, rng, noise=HAND_NOISE, offset_n=0.1, offset_nmm=5.0)
    return WrenchLog(f"{way} {1000 * water_kg:g} g", time, force, moment, "liquid" if water_kg else "solid", simulated=True)
