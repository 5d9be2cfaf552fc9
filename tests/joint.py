"""A simulated joint under its controller, with faults of its wires or something in its way."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calibration.control.controller import Command, Input, JointController, Law
from calibration.finger.simulated import HUMAN, RATE_HZ, ROBOT, Finger, FingerSensor, Plant, Reader


def driven(
    inputs: tuple[Input, Input],
    fault: Callable[[float, float, float], tuple[float, float]],
    *,
    sensors: tuple[FingerSensor, ...],
    until: float = 8.0,
) -> tuple[np.ndarray, np.ndarray, list[Command]]:
    """The human's angles, the robot's and the commands of 8 s of 45 + 25 sin(t) degrees, still from `until` on; `fault` makes readings of
    time and readings."""
    controller, finger = JointController(*inputs, law="full", gain=3.99), Finger(Plant(sensor=sensors[1]), seed=0, angle=45.0)
    reader, speed, rows, commands = Reader(sensors[0], 0.05, np.random.default_rng(1)), 0.0, [], []
    for k in range(round(8 * RATE_HZ)):
        time = k / RATE_HZ
        angle = 45 + 25 * np.sin(min(time, until))
        frames = (reader.read(time, angle), finger.step(time, speed))
        values = fault(time, *(float(frame.values[0]) for frame in frames))
        human, robot = (replace(frame, values=np.array([value])) for frame, value in zip(frames, values, strict=True))
        commands.append(controller.step(time, human, robot))
        speed = commands[-1].speed
        rows.append((angle, finger.angle))
    angles, went = np.array(rows).T
    return angles, went, commands


def blocked(
    inputs: tuple[Input, Input],
    *,
    human: Callable[[float], float],
    wall: Callable[[float], float],
    seconds: float,
    sensors: tuple[FingerSensor, ...] = (HUMAN, ROBOT),
    law: Law = "full",
    drive: Callable[[float, float], float] = lambda time, command: command,
) -> tuple[np.ndarray, list[Command]]:
    """The robot's angle and the commands, where something stands in its way at an angle that is a function of time.

    `drive` is what becomes of a command.
    """
    controller, reader = JointController(*inputs, law=law, gain=3.99), Reader(sensors[0], 0.05, np.random.default_rng(1))
    finger, speed, went, commands = Finger(Plant(sensor=sensors[1]), seed=0, angle=min(45.0, wall(0.0))), 0.0, [], []
    for k in range(round(seconds * RATE_HZ)):
        time = k / RATE_HZ
        finger.plant = replace(finger.plant, high=wall(time))
        commands.append(controller.step(time, reader.read(time, human(time)), finger.step(time, drive(time, speed))))
        speed = commands[-1].speed
        went.append(finger.angle)
    return np.array(went), commands


def told_deg(commands: list[Command], since: int) -> float:
    """Between which the joint was told to be, from a frame on, deg."""
    return float(np.ptp(np.cumsum([command.speed for command in commands[since:]])) / RATE_HZ)
