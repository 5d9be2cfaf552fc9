"""A hand of four fingertips that holds an object in several poses: what its sensors read, as the paper's accuracy test was made.

Contacts carry the object's weight, with the least forces that do; each sensor adds white noise and an offset of its force that
stays; the hand knows where its fingertips are but for an error that stays. Left out: the squeeze and the moments' offsets, which
change no figure (both stay while the hand is turned, as the force's offset does, and are smaller); fingers that give way when the hand is
turned, contacts that creep, and people who turn the hand while it reads. Gravity on the fingertips themselves, which turns with
the hand unlike an offset, and offsets that drift are there for who weighs the empty hand first; both are 0 unless asked for. So
the published errors of 3 to 5 mm are reproduced by the offsets that the sensors are said to have, which is one way in which they
may come about.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.gravity import GRAVITY
from skinfab.fingertip.force.hand import Finger, hand_wrench
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import as_read
from skinfab.fingertip.force.wrench import SensorNoise

FloatArray = NDArray[np.float64]

#: Table 3 of the paper, mm: where a billiard ball's centre was, and where it was estimated.
PAPER_TRUTH = ((-2.1, -1.4, 176.0), (42.1, 0.4, 136.0), (-0.7, 41.0, 136.0), (-38.2, 0.7, 136.0), (-0.7, -39.6, 141.0))
PAPER_ESTIMATE = ((-4.4, -3.6, 175.0), (40.6, -2.7, 136.0), (-5.4, 42.0, 134.0), (-37.6, -1.6, 138.0), (-0.8, -42.4, 143.0))
PAPER_PLACES = ("mid", "bottom right", "top right", "top left", "bottom left")


@dataclass(frozen=True)
class HandScene:
    """How an object is held.

    Parameters
    ----------
    mass_kg, radius_mm : float
        Of the billiard ball; its contacts lie on a ball of that radius.
    poses : int
        The paper's ten.
    span_deg : float
        The hand is turned by up to this, about an axis that differs from pose to pose.
    samples : int
        A pose.
    rate_hz : float
    kinematics_mm : float
        Standard deviation of where the hand believes a fingertip to be, an axis.
    noise : SensorNoise
        Of each finger's sensor.
    offset_n : float
        Standard deviation of its force's offset.
    drift_n : float
        By how much that is another one each time, from log to log.
    tip_kg : float
        Of each fingertip beyond its sensor, in the dome's centre.
    """

    mass_kg: float = 0.170
    radius_mm: float = 28.5
    poses: int = 10
    span_deg: float = 45.0
    samples: int = 100
    rate_hz: float = 200.0
    kinematics_mm: float = 0.5
    noise: SensorNoise = field(default_factory=SensorNoise)
    offset_n: float = 0.05
    drift_n: float = 0.0
    tip_kg: float = 0.0


@dataclass(frozen=True, eq=False)
class Held:
    """A simulated log, and what is true of it.

    Parameters
    ----------
    log : WrenchLog
        Force and moment of the hand, in its frame; the column ``pose`` counts from 0.
    centre : (3,) float, mm
    mass_kg : float
    """

    log: WrenchLog
    centre: FloatArray
    mass_kg: float


def directions(poses: int, span_deg: float, rng: np.random.Generator) -> FloatArray:
    """Gravity in the hand's frame in each pose, (n, 3): the hand turned by up to the span about any axis; the first is upright."""
    from scipy.spatial.transform import Rotation

    axis = rng.standard_normal((poses, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.radians(span_deg) * rng.uniform(-1, 1, (poses, 1))
    angle[0] = 0
    out: FloatArray = Rotation.from_rotvec(axis * angle).apply([0.0, 0.0, -1.0])
    return out


def hold(
    centre: FloatArray | tuple[float, float, float] = PAPER_TRUTH[0],
    *,
    seed: int | Sequence[int] = 0,
    scene: HandScene | None = None,
    name: str = "held",
    weighing: int | None = None,
) -> Held:
    """Hold a ball with its centre of gravity at `centre` (mm, hand's frame).

    Parameters
    ----------
    centre : (3,) float, mm
    seed : int or sequence of int
        Of the hand and of all that it reads; the same hand holds and is weighed.
    scene : HandScene, optional
    name : str
        Of the log.
    weighing : int, optional
        The so manieth time that the same hand, its fingers where they are, is weighed with nothing in it.

    Examples
    --------
    >>> held = hold(seed=1)
    >>> len(held.log), held.log.simulated, round(float(-held.log.force[:100, 2].mean()), 0)
    (1000, True, 2.0)
    """
    scene, t = scene or HandScene(), np.array(centre, dtype=float)
    of_hand, of_log = np.random.SeedSequence(seed).spawn(2)
    rng = np.random.default_rng(of_hand)
    fingers, points = _grasp(t, scene, rng)
    offsets = scene.offset_n * rng.standard_normal((len(fingers), 3))
    believed = [Finger(f.rotation, f.position + scene.kinematics_mm * rng.standard_normal(3)) for f in fingers]
    rng = np.random.default_rng(of_log if weighing is None else of_log.spawn(weighing + 1)[weighing])
    offsets = offsets + scene.drift_n * rng.standard_normal(offsets.shape)
    gravity = directions(scene.poses, scene.span_deg, rng)
    pose = np.repeat(np.arange(scene.poses), scene.samples)
    mass = scene.mass_kg if weighing is None else 0.0
    weight = mass * GRAVITY * gravity
    # Least contact forces that carry the weight at t: what the object does to the fingers is what they read.
    grasp = np.block([[np.eye(3) for _ in points], [np.cross(p, np.eye(3), axisb=0, axisc=0) for p in points]])
    carried = (np.linalg.pinv(grasp) @ np.concatenate([weight, np.cross(t, weight)], axis=1).T).T.reshape(scene.poses, len(points), 3)
    wrenches = []
    for k, (finger, point) in enumerate(zip(fingers, points, strict=True)):
        own = carried[pose, k] @ finger.rotation
        arm = (point - finger.position) @ finger.rotation
        force = own + scene.tip_kg * GRAVITY * gravity[pose] @ finger.rotation + offsets[k]
        wrenches.append(np.concatenate(as_read(force, np.cross(arm, own), rng, noise=scene.noise), axis=1))
    total = hand_wrench(believed, np.stack(wrenches))
    time = np.arange(len(pose)) / scene.rate_hz
    log = WrenchLog(name, time, total[:, :3], total[:, 3:], name, others={"pose": pose.astype(float)}, simulated=True)
    return Held(log, t, mass)


def _grasp(centre: FloatArray, scene: HandScene, rng: np.random.Generator) -> tuple[list[Finger], list[FloatArray]]:
    """Four fingertips about the ball, two pairs that face one another a little above and below its middle, and their contacts."""
    from scipy.spatial.transform import Rotation

    fingers, points = [], []
    turn = rng.uniform(0, 2 * np.pi)
    for k in range(4):
        angle, height = turn + k * np.pi / 2, 0.2 * (-1) ** k
        outward = np.array([np.cos(angle) * np.sqrt(1 - height**2), np.sin(angle) * np.sqrt(1 - height**2), height])
        points.append(centre + scene.radius_mm * outward)
        # The fingertip's dome (20 mm) stands on the contact, its axes turned as they happen to be.
        fingers.append(Finger(Rotation.random(random_state=rng).as_matrix(), centre + (scene.radius_mm + 20.0) * outward))
    return fingers, points
