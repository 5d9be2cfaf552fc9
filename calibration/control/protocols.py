"""The paper's two experiments, on the simulated finger: uniform bending and stretching, and random motions, slow and fast.

The plant and its noise are the same for every controller. Two numbers of the experiments, which the paper does not give, were
tuned once so that the published controller errs by what the paper says: its gain, and how slow the slowest random motion is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.control.controller import Command, JointController
from calibration.finger.simulated import HUMAN, RATE_HZ, Finger, FingerSensor, Plant, Reader
from skinfab.readout.frame import Frame

FloatArray = NDArray[np.float64]

#: Mean errors of the paper's controller, deg.
PAPER_DEG = {"uniform": 6.61, "random": 18.77}
#: The published controller's gain, 1/s, tuned to the first of them.
PAPER_GAIN = 5.1
#: The slowest random cycle, s, tuned to the second; the fastest is the paper's.
SLOWEST_S, FASTEST_S = 2.35, 1.0
SEEDS = (0, 1, 2, 3, 4)

LENGTH_S = 24.0
#: The human goes beyond the 80 degrees up to which the robot is calibrated, as in the paper's fig. 5.
LOW_DEG, TOP_DEG = 10.0, 85.0
#: Random motions turn below the first and above the second.
TURNS_DEG = (35.0, 55.0)


@dataclass(frozen=True, eq=False)
class Motion:
    """What the human does.

    Parameters
    ----------
    name : str
    time : (n,) float, s
        A frame's period apart.
    angle : (n,) float, deg
    """

    name: str
    time: FloatArray
    angle: FloatArray


def uniform(*, period_s: float = 8.0, length_s: float = LENGTH_S) -> Motion:
    """Cycles of one length, as fig. 5A.

    Examples
    --------
    >>> motion = uniform()
    >>> len(motion.time), float(motion.angle[400])
    (2400, 85.0)
    """
    time = np.arange(round(length_s * RATE_HZ)) / RATE_HZ
    angle = LOW_DEG + (TOP_DEG - LOW_DEG) * (1 - np.cos(2 * np.pi * time / period_s)) / 2
    return Motion("uniform", time, angle)


def random(seed: int) -> Motion:
    """Half cycles of random length and reach, as fig. 5B."""
    rng = np.random.default_rng([seed, 2])
    time = np.arange(round(LENGTH_S * RATE_HZ)) / RATE_HZ
    angle = np.empty(len(time))
    began, now, up = 0.0, LOW_DEG, True
    while began < LENGTH_S:
        lasts = FASTEST_S * (SLOWEST_S / FASTEST_S) ** rng.random() / 2
        goal = rng.uniform(TURNS_DEG[1], TOP_DEG) if up else rng.uniform(LOW_DEG, TURNS_DEG[0])
        part = (time - began) / lasts
        during = (part >= 0) & (part < 1)
        angle[during] = now + (goal - now) * (1 - np.cos(np.pi * part[during])) / 2
        began, now, up = began + lasts, goal, not up
    return Motion("random", time, angle)


@dataclass(frozen=True, eq=False)
class Run:
    """A motion and how it was followed.

    Parameters
    ----------
    motion : Motion
    robot : (n,) float, deg
        The robot's true angle.
    commands : tuple of Command
    """

    motion: Motion
    robot: FloatArray
    commands: tuple[Command, ...]

    @property
    def error_deg(self) -> float:
        """Mean absolute difference of the two true angles: the paper's measure."""
        return float(np.mean(np.abs(self.robot - self.motion.angle)))


def follow(
    motion: Motion,
    controller: JointController,
    *,
    seed: int,
    plant: Plant | None = None,
    human: FingerSensor = HUMAN,
    readings: Sequence[Frame] | None = None,
) -> Run:
    """Let the simulated robot finger follow a motion.

    Parameters
    ----------
    motion : Motion
    controller : JointController
        A new one: it remembers.
    seed : int
        Of the noise of both sensors.
    plant : Plant, optional
        Without it the simulated robot finger as it is.
    human : FingerSensor
        Read by the same board as the robot's, hence with the same delay.
    readings : sequence of n Frame, optional
        Of a human's sensor, logged; instead of simulated ones.
    """
    plant = plant or Plant()
    finger = Finger(plant, seed=seed, angle=min(max(float(motion.angle[0]), plant.low), plant.high))
    reader = Reader(human, plant.delay_s, np.random.default_rng([seed, 3]))
    commands, robot, speed = [], np.empty(len(motion.time)), 0.0
    for k, (time, angle) in enumerate(zip(motion.time.tolist(), motion.angle.tolist(), strict=True)):
        shown = finger.step(time, speed)
        command = controller.step(time, reader.read(time, angle) if readings is None else readings[k], shown)
        speed, robot[k] = command.speed, finger.angle
        commands.append(command)
    return Run(motion, robot, tuple(commands))


def mean_error(runs: Sequence[Run]) -> tuple[float, float]:
    """Mean and standard deviation over runs of their errors, deg."""
    errors = np.array([run.error_deg for run in runs])
    return float(errors.mean()), float(errors.std(ddof=1)) if len(errors) > 1 else 0.0
