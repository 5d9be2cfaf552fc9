"""What each term of the simulated finger is for: the reported figures without it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibration.control.controller import Input, JointController
from calibration.control.protocols import PAPER_GAIN, SEEDS, Motion, follow, mean_error, random, uniform
from calibration.finger.logs import DEGREE, calibrated, prepared
from calibration.finger.simulated import HUMAN, ROBOT, FingerSensor, Plant
from calibration.strain.calibrate import calibrate
from calibration.strain.curve import Curve, bernstein
from skinfab.errors import InputError

#: What can be left out of the simulator, one at a time.
TERMS = ("nothing", "lag", "delay", "stops", "human's play", "robot's play", "noise", "range")
#: Of the improved controller, 1/s: what ``--gain auto`` gives.
FULL_GAIN = 3.99


@dataclass(frozen=True)
class Figures:
    """What is reported of the simulator.

    Parameters
    ----------
    human_sse, human_r2, robot_sse, robot_r2 : float
        Of the plain curves of the paper's degrees.
    uniform_deg, random_deg : float
        Mean error of the published controller.
    full_uniform_deg, full_random_deg : float
        Of the improved one, which is told lag and delay as they are.
    """

    human_sse: float
    human_r2: float
    robot_sse: float
    robot_r2: float
    uniform_deg: float
    random_deg: float
    full_uniform_deg: float
    full_random_deg: float


def figures_without(term: str, *, seeds: Sequence[int] = SEEDS) -> Figures:
    """The figures of a simulator without a term, calibrated anew and controlled with the same gains.

    Parameters
    ----------
    term : str
        One of `TERMS`.
    seeds : sequence of int
        Of the protocols; the logs are those of the scripts.

    Raises
    ------
    InputError
        There is no such term.
    """
    human, robot, plant = _without(term)
    logs = [prepared(sensor) for sensor in (human, robot)]
    fits = [calibrate(log, model="poly", degree=DEGREE[sensor.name]) for sensor, log in zip((human, robot), logs, strict=True)]
    errors = []
    for model in ("poly", "branches"):
        inputs = [Input(calibrated(sensor, model, log=log)) for sensor, log in zip((human, robot), logs, strict=True)]
        for name in ("uniform", "random"):
            runs = [follow(_motion(name, seed), _controller(inputs, plant), seed=seed, plant=plant, human=human) for seed in seeds]
            errors.append(mean_error(runs)[0])
    return Figures(fits[0].sse, fits[0].r2, fits[1].sse, fits[1].r2, *errors)


def _motion(name: str, seed: int) -> Motion:
    return uniform() if name == "uniform" else random(seed)


def _controller(inputs: Sequence[Input], plant: Plant) -> JointController:
    """The published controller for plain curves, the improved one for branches."""
    human, robot = inputs
    plain = robot.calibration.model.name == "poly"
    gain = PAPER_GAIN if plain else FULL_GAIN
    return JointController(human, robot, law="p" if plain else "full", gain=gain, lag_s=plant.lag_s, delay_s=plant.delay_s)


def _without(term: str) -> tuple[FingerSensor, FingerSensor, Plant]:
    human, robot, plant = HUMAN, ROBOT, Plant()
    if term == "lag":
        plant = replace(plant, lag_s=0.0)
    elif term == "delay":
        plant = replace(plant, delay_s=0.0)
    elif term == "stops":
        plant = replace(plant, low=-math.inf, high=math.inf)
    elif term == "human's play":
        human = replace(human, play_deg=0.0)
    elif term == "robot's play":
        robot = replace(robot, play_deg=0.0)
    elif term == "noise":
        human, robot = replace(human, noise=0.0), replace(robot, noise=0.0)
    elif term == "range":
        human, robot = _endless(human), _endless(robot)
    elif term != "nothing":
        raise InputError(f"the simulated finger has no term {term!r}; it has {', '.join(TERMS)}")
    return human, robot, replace(plant, sensor=robot)


def _endless(sensor: FingerSensor) -> FingerSensor:
    """The same polynomial over all angles of the joint."""
    low, high, degree = Plant().low, Plant().high, sensor.curve.degree
    at = np.linspace(low, high, degree + 1)
    ordinates = np.linalg.solve(bernstein((at - low) / (high - low), degree), sensor.curve.signal(at))
    return replace(sensor, curve=Curve(low, high, np.asarray(ordinates, dtype=np.float64)))
