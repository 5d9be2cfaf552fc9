"""Simulated participants who touch the paper's patterns, and what the six channels of the sensor on their nail read.

A participant is a `Finger` drawn about one set of means; a touch is a pattern with the scatter of a hand that aims at it. Readings are
the finger's answer to the motor, with gravity, noise, and the ends of the sensor's ranges.

What it leaves out: the pulp is a row of linear springs that does not slide, stick, creep or lift off; the finger is one rigid body, so
that the joint behind it only holds it; the motor turns evenly and does not feel the load; nothing changes while a touch lasts; and
means and scatter are assumed, chosen so that the accuracies of the published method come near the paper's. It is enough for what is
compared here, methods that read the same touches, and says nothing of how a real finger's accuracy comes about.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.finger import EDGE_POINTS, ComplexArray, Finger, contact_matrix, motor_force, respond
from skinfab.fingertip.nail.patterns import Pattern
from skinfab.fingertip.nail.units import CHANNELS
from skinfab.readout.frame import Channel, Frame, Recording, Stream

FloatArray = NDArray[np.float64]

#: The paper's: about 1.4 kHz, and 1024 readings an estimate.
RATE_HZ = 1400.0
WINDOW = 1024
#: The paper's 100 g.
FORCE_N = 0.98

#: The pad lies so far below the middle of the body.
_PAD_MM = -6.0
#: Pressure along what is touched falls off with the pad's curvature, across and along the finger: exp(-(x/a)^2 - (y/b)^2).
_PAD_HALF_MM = np.array([5.8, 15.0])
_EDGE_LENGTH_MM = 20.0

#: A contact's stiffness grows with this power of the force (Hertz).
_HERTZ = 1 / 3

#: Means of the participants. Held alone, the body would swing with these frequencies along and about x, y, z. About x, the axis on
#: which the joint bends, it takes the rest of the finger along; hence the larger inertia.
_MASS_KG = 6e-3
_INERTIA_KGM2 = np.array([5.9e-7, 0.75e-7, 1.5e-7])
_HELD_HZ = np.array([91.0, 44.0, 80.0, 60.0, 95.0, 178.0])
_DAMPING = 0.39
_CONTACT_N_PER_M = 3900.0
_MOTOR_MM = np.array([0.0, -6.0, 5.5])
_IMU_MM = np.array([0.0, 6.5, 5.2])
_IMBALANCE_KGM = 3.6e-8


@dataclass(frozen=True)
class Scene:
    """Means and scatter; standard deviations where not said otherwise.

    Parameters
    ----------
    drive_hz : float
        The motor's frequency.
    place_mm : float
        How far off the middle of the pattern the finger comes down, across and along.
    turn_rad : float
        How much it is turned.
    force_scatter : float
        As a part of the wanted force.
    force_n : (float, float) or None
        Forces are drawn log-uniform from the first to the second instead of scattering about the paper's.
    person_scatter : float
        Of mass, inertia and stiffnesses among participants, as a part (log-normal).
    contact_delay_s : float
        Damping over stiffness of what touches the pad.
    gravity_g : float
        Along z.
    noise_g, noise_dps : float
        Of each reading.
    range_g, range_dps : float
        The sensor reads from minus to plus this.
    """

    drive_hz: float = 169.0
    place_mm: float = 1.05
    turn_rad: float = math.radians(12.5)
    force_scatter: float = 0.10
    force_n: tuple[float, float] | None = None
    person_scatter: float = 0.16
    contact_delay_s: float = 2.5e-4
    gravity_g: float = 1.0
    noise_g: float = 0.04
    noise_dps: float = 4.0
    range_g: float = 4.0
    range_dps: float = 500.0


@dataclass(frozen=True)
class Touch:
    """A finger on a pattern, or held still in the air.

    Parameters
    ----------
    pattern : Pattern or None
        What is aimed at; None for nothing.
    x_mm, y_mm : float
        Where the pattern's middle lies on the pad.
    angle_rad : float
        Of an edge, as it lies on the pad; NaN otherwise.
    force_n : float
        0 in the air.
    drive_hz : float
        The motor's frequency meanwhile.
    """

    pattern: Pattern | None
    x_mm: float
    y_mm: float
    angle_rad: float
    force_n: float
    drive_hz: float


def participant(rng: np.random.Generator, scene: Scene | None = None) -> Finger:
    """A finger drawn about the means."""
    scene = scene or Scene()

    def drawn(mean: ArrayLike) -> FloatArray:
        means = np.asarray(mean, dtype=float)
        return np.asarray(means * np.exp(scene.person_scatter * rng.standard_normal(means.shape)))

    mass = float(drawn(_MASS_KG))
    inertia = drawn(_INERTIA_KGM2)
    return Finger(
        mass_kg=mass,
        inertia_kgm2=inertia,
        stiffness=np.append(np.full(3, mass), inertia) * (2 * math.pi * drawn(_HELD_HZ)) ** 2,
        damping_ratio=float(drawn(_DAMPING)),
        contact_n_per_m=float(drawn(_CONTACT_N_PER_M)),
        contact_delay_s=scene.contact_delay_s,
        motor_mm=_MOTOR_MM,
        imu_mm=_IMU_MM,
        imbalance_kgm=_IMBALANCE_KGM,
    )


def touch(pattern: Pattern | None, rng: np.random.Generator, scene: Scene | None = None) -> Touch:
    """Aim at a pattern once; with None, hold the finger in the air."""
    scene = scene or Scene()
    off = scene.place_mm * rng.standard_normal(2)
    turned = scene.turn_rad * float(rng.standard_normal())
    # Beyond these the paper's participants tried again.
    force = FORCE_N * float(np.clip(1 + scene.force_scatter * rng.standard_normal(), 0.8, 1.2))
    if scene.force_n is not None:
        force = scene.force_n[0] * (scene.force_n[1] / scene.force_n[0]) ** float(rng.uniform())
    if pattern is None:
        return Touch(None, math.nan, math.nan, math.nan, 0.0, scene.drive_hz)
    x, y = pattern.x_mm + float(off[0]), pattern.y_mm + float(off[1])
    return Touch(pattern, x, y, pattern.angle_rad + turned, force, scene.drive_hz)


def phasors(finger: Finger, touches: Sequence[Touch]) -> ComplexArray:
    """The finger's answers to its motor, (n, 6) in G and deg/s; see `respond`."""
    stiffened = np.array([(each.force_n / FORCE_N) ** _HERTZ for each in touches])
    omega = 2 * math.pi * np.array([each.drive_hz for each in touches])
    return respond(finger, contact_matrix(*_touched(touches)), stiffened, omega, motor_force(finger, omega))


def _touched(touches: Sequence[Touch]) -> tuple[FloatArray, FloatArray]:
    """Points of the pad that are touched, (n, k, 3) mm, and how much of the contact is at each, (n, k)."""
    middle = np.array([(0.0, 0.0) if each.pattern is None else (each.x_mm, each.y_mm) for each in touches])
    is_line = np.array([each.pattern is not None and not each.pattern.is_pin for each in touches])
    angle = np.where(is_line, [each.angle_rad for each in touches], 0.0)
    along = np.linspace(-0.5, 0.5, EDGE_POINTS) * _EDGE_LENGTH_MM * is_line[:, None]
    flat = middle[:, None] + along[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)[:, None]
    weights = np.exp(-((flat / _PAD_HALF_MM) ** 2).sum(axis=-1))
    weights /= weights.sum(axis=1, keepdims=True)
    weights[[each.pattern is None for each in touches]] = 0.0
    return np.concatenate([flat, np.full((*flat.shape[:2], 1), _PAD_MM)], axis=-1), weights


def nail_stream(scene: Scene | None = None) -> Stream:
    """What the simulator sends: six channels at 1.4 kHz.

    Examples
    --------
    >>> stream = nail_stream()
    >>> stream.names, stream.rate_hz, stream.simulated
    (('Ax', 'Ay', 'Az', 'Gx', 'Gy', 'Gz'), 1400.0, True)
    """
    scene = scene or Scene()
    units = (("G", "acceleration", scene.range_g),) * 3 + (("deg/s", "angular velocity", scene.range_dps),) * 3
    channels = (Channel(name, unit, kind, -end, end) for name, (unit, kind, end) in zip(CHANNELS, units, strict=True))
    return Stream("simulated nail", tuple(channels), RATE_HZ, simulated=True)


def readings(
    finger: Finger,
    touches: Sequence[Touch],
    rng: np.random.Generator,
    *,
    samples: int = WINDOW,
    scene: Scene | None = None,
    drift_hz_per_s: float = 0.0,
    begun: FloatArray | None = None,
) -> FloatArray:
    """What the sensor reads of each touch, (n, samples, 6) in G and deg/s.

    Parameters
    ----------
    drift_hz_per_s : float
        How fast the motor changes its speed; the finger's answer is taken at the speed it began with.
    begun : (n,) float, optional
        The motor's phase at each first sample, turns (see `running`); any where it is left out.
    """
    scene = scene or Scene()
    if samples < 1:
        raise InputError(f"{samples} readings of a touch are none; ask for one or more")
    z = phasors(finger, touches)
    time = np.arange(samples) / RATE_HZ
    drive = np.array([each.drive_hz for each in touches])[:, None]
    first = rng.uniform(size=len(touches)) if begun is None else begun
    cycles = first[:, None] + drive * time + drift_hz_per_s * time**2 / 2
    turn = np.exp(2j * math.pi * cycles)[..., None]
    out = (z[:, None] * turn).real
    out[..., 2] += scene.gravity_g
    out += np.repeat([scene.noise_g, scene.noise_dps], 3) * rng.standard_normal(out.shape)
    ends = np.repeat([scene.range_g, scene.range_dps], 3)
    clipped: FloatArray = np.clip(out, -ends, ends)
    return clipped


def running(drive_hz: float, samples: int, count: int, *, begun: float = 0.0) -> FloatArray:
    """The phase at the first sample of touches in a row, while the motor runs on; turns, (count,).

    Examples
    --------
    >>> running(175.0, 12, 3).tolist()  # eight samples a turn
    [0.0, 0.5, 0.0]
    """
    return np.asarray((begun + np.arange(count) * samples * drive_hz / RATE_HZ) % 1.0, dtype=float)


def record(
    finger: Finger, touches: Sequence[Touch], rng: np.random.Generator, *, samples: int = WINDOW, scene: Scene | None = None
) -> list[Recording]:
    """As `readings`, a recording each.

    Examples
    --------
    >>> from skinfab.fingertip.nail.patterns import EDGES4
    >>> rng = np.random.default_rng(0)
    >>> finger = participant(rng)
    >>> made = record(finger, [touch(EDGES4[0], rng), touch(None, rng)], rng)
    >>> len(made), made[0].values.shape
    (2, (1024, 6))
    """
    stream = nail_stream(scene)
    time = np.arange(samples) / RATE_HZ
    values = readings(finger, touches, rng, samples=samples, scene=scene)
    return [Recording.of_values(stream, each, device_time=time) for each in values]


def nail_frames(
    finger: Finger, patterns: Sequence[Pattern | None], *, hold_s: float = 2.0, seed: int = 0, scene: Scene | None = None
) -> Iterator[Frame]:
    """Frames without end: the patterns one after the other, each held for `hold_s`, and again from the first on; the motor runs on."""
    rng = np.random.default_rng(seed)
    stream, samples = nail_stream(scene), round(hold_s * RATE_HZ)
    k, begun = 0, np.zeros(1)
    for pattern in itertools.cycle(patterns):
        held = touch(pattern, rng, scene)
        values_of = readings(finger, [held], rng, samples=samples, scene=scene, begun=begun)[0]
        begun = running(held.drive_hz, samples, 2, begun=begun[0])[1:]
        for values in values_of:
            time = k / RATE_HZ
            yield Frame(time, time, k, values, np.ones(len(values), dtype=bool), stream.saturated(values))
            k += 1
