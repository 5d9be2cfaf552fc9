"""A six-axis sensor under a fingertip that slides over a material: the paper's set-up, as small as its tables allow.

The load presses along the normal, and the tangential force is load x friction, where friction varies with the place: a mean, a
corrugation (its pitch and the second harmonic), a roughness that fades within millimetres, and a ripple of the pull once a turn
of the spool. White noise and an offset on all six components. Left out: the finger's own vibration, stick-slip, wear, heat
and all that is faster than the readout's 200 Hz: the paper uses what is below 10 Hz and says nothing of the rest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise

FloatArray = NDArray[np.float64]


def as_read(
    force: FloatArray, moment: FloatArray, rng: np.random.Generator, *, noise: SensorNoise, offset_n: float = 0.0, offset_nmm: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Force (n, 3) and moment (n, 3) as a sensor reads them: white noise, and an offset of these standard deviations that stays."""
    f = force + offset_n * rng.standard_normal(3) + noise.force_n * rng.standard_normal(force.shape)
    m = moment + offset_nmm * rng.standard_normal(3) + noise.moment_nmm * rng.standard_normal(moment.shape)
    return f, m


@dataclass(frozen=True)
class Material:
    """What a material does to the friction.

    Parameters
    ----------
    friction : float
        Its mean: the tangent of the paper's average inclination (table 2).
    pitch_mm : float
        Of the corrugation; 0 where there is none.
    ripple, second : float
        Amplitude of the friction over a pitch, and of its second harmonic.
    roughness : float
        Standard deviation of what is irregular.
    """

    friction: float
    pitch_mm: float = 0.0
    ripple: float = 0.0
    second: float = 0.0
    roughness: float = 0.0


def _degrees(average: float) -> float:
    return math.tan(math.radians(average))


#: The paper's six (figure 5). Friction from the averages of table 2; ripples are twice the magnitudes of table 1, whose size beside
#: the extremes of table 2 says that they are |X| / N; roughness so that the extremes of table 2 come out.
MATERIALS: Mapping[str, Material] = {
    "cardboard 5 mm": Material(_degrees(8.88), 5.0, ripple=0.047, roughness=0.007),
    "cardboard 10 mm": Material(_degrees(17.20), 10.0, ripple=0.117, second=0.036, roughness=0.030),
    "towel": Material(_degrees(12.93), roughness=0.020),
    "paper towel": Material(_degrees(11.64), roughness=0.008),
    "painter's tape": Material(_degrees(8.79), roughness=0.008),
    "copy paper": Material(_degrees(6.86), roughness=0.003),
}


@dataclass(frozen=True)
class SlideScene:
    """How a material is pulled away under the fingertip.

    Parameters
    ----------
    load_n, speed_mm_s, rate_hz : float
        The paper's.
    rest_s, slide_s : float
        Time without load at the beginning, then of sliding; between them the finger rests on the material for 0.5 s.
    roughness_mm : float
        Over which the irregular part of the friction fades.
    spool_mm, spool_ripple : float
        Way a turn of the spool, and the ripple of the friction with it, as a part of its mean.
    speed_scatter : float
        Standard deviation of the speed from slide to slide, as a part.
    specimen_scatter : float
        Of friction, ripple and roughness from specimen to specimen of one material, as a part.
    noise : SensorNoise
    offset_n, offset_nmm : float
        Standard deviation of the sensor's offsets.
    """

    load_n: float = 1.0
    speed_mm_s: float = 35.0
    rate_hz: float = 200.0
    rest_s: float = 0.5
    slide_s: float = 6.0
    roughness_mm: float = 5.0
    spool_mm: float = 44.8
    spool_ripple: float = 0.04
    speed_scatter: float = 0.03
    specimen_scatter: float = 0.1
    noise: SensorNoise = field(default_factory=SensorNoise)
    offset_n: float = 0.05
    offset_nmm: float = 0.5


_PRESS_S = 0.5  # on the material before it is pulled


def specimen(material: Material, rng: np.random.Generator, scene: SlideScene) -> Material:
    """A piece of the material: alike, not the same."""
    friction, ripple, roughness = 1 + scene.specimen_scatter * rng.standard_normal(3)
    return replace(
        material,
        friction=material.friction * friction,
        ripple=material.ripple * ripple,
        second=material.second * ripple,
        roughness=material.roughness * abs(roughness),
    )


def slide(material: Material, *, seed: int | np.random.Generator = 0, scene: SlideScene | None = None, label: str = "") -> WrenchLog:
    """The log of one slide: no load, pressed, pulled along x. The contact is at the tip's pole, (0, 0, 20) mm.

    Parameters
    ----------
    material : Material
    seed : int or Generator
    scene : SlideScene, optional
    label : str

    Returns
    -------
    WrenchLog
        Marked as simulated.

    Examples
    --------
    >>> log = slide(MATERIALS["towel"], seed=1)
    >>> len(log), log.simulated, round(float(-log.force[200:, 2].mean()), 1) > 0.5
    (1400, True, True)
    """
    scene = scene or SlideScene()
    rng = np.random.default_rng(seed)
    speed = scene.speed_mm_s * (1 + scene.speed_scatter * rng.standard_normal())
    n = round((scene.rest_s + _PRESS_S + scene.slide_s) * scene.rate_hz)
    time = np.arange(n) / scene.rate_hz
    sliding = time >= scene.rest_s + _PRESS_S
    way = np.where(sliding, time - scene.rest_s - _PRESS_S, 0.0) * speed
    friction = np.where(sliding, _friction(material, way, rng, scene), 0.0)
    normal = np.where(time >= scene.rest_s, scene.load_n, 0.0)
    force = np.column_stack([normal * friction, np.zeros(n), -normal])
    moment = np.cross(np.array([0.0, 0.0, RADIUS_MM]), force)
    force, moment = as_read(force, moment, rng, noise=scene.noise, offset_n=scene.offset_n, offset_nmm=scene.offset_nmm)
    return WrenchLog(label or "slide", time, force, moment, label, simulated=True)


def _friction(material: Material, way: FloatArray, rng: np.random.Generator, scene: SlideScene) -> FloatArray:
    """Friction at each place of the way, mm."""
    start, turn = rng.uniform(0, 2 * math.pi, 2)
    out = material.friction * (1 + scene.spool_ripple * np.sin(2 * math.pi * way / scene.spool_mm + turn))
    if material.pitch_mm:
        phase = 2 * math.pi * way / material.pitch_mm + start
        out += material.ripple * np.sin(phase) + material.second * np.sin(2 * phase)
    return out + material.roughness * _fading(np.diff(way, prepend=way[0]) / scene.roughness_mm, rng)


def _fading(steps: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Gaussian values of unit variance whose correlation falls by e where the steps add up to 1."""
    keep = np.exp(-steps)
    fresh = np.sqrt(1 - keep**2) * rng.standard_normal(len(steps))
    out = np.empty(len(steps))
    last = rng.standard_normal()
    for k, (kept, new) in enumerate(zip(keep.tolist(), fresh.tolist(), strict=True)):
        last = kept * last + new
        out[k] = last
    return out


def texture_logs(
    *, specimens: int = 6, slides: int = 6, seed: int = 0, scene: SlideScene | None = None, materials: Mapping[str, Material] = MATERIALS
) -> list[WrenchLog]:
    """Slides over specimens of all materials; a log's group is its specimen.

    Examples
    --------
    >>> logs = texture_logs(specimens=1, slides=2)
    >>> len(logs), logs[3].label, logs[3].group
    (12, 'cardboard 10 mm', 'cardboard 10 mm 1')
    """
    scene = scene or SlideScene()
    rng = np.random.default_rng(seed)
    logs = []
    for name, material in materials.items():
        for k in range(specimens):
            piece = specimen(material, rng, scene)
            group = f"{name} {k + 1}"
            logs += [
                replace(slide(piece, seed=rng, scene=scene, label=name), name=f"{group} slide {j + 1}", group=group) for j in range(slides)
            ]
    return logs
