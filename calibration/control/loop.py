"""The controller in real time: a command for every frame that comes, a stop where none comes, and how long each one took."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.control.controller import MAX_AGE_S, Command, JointController
from calibration.control.protocols import Motion
from calibration.finger.simulated import HUMAN, RATE_HZ, Finger, Plant, Reader
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.source import HostClock, Source, StaleError

FloatArray = NDArray[np.float64]

#: So many periods without a frame, and the controller is told that there is none.
PATIENCE = 2.0


@dataclass(frozen=True, eq=False)
class Loop:
    """What a loop did.

    Parameters
    ----------
    time : (n,) float, s
        Of each command, since the loop began.
    sent_at : (n,) float, s
        The same by `time.monotonic`.
    sequence : (n,) int
        Of the frame that it answers; -1 where there was none.
    latency_s : (n,) float
        From the frame's arrival to the command, NaN where there was none.
    passed_over : int
        Frames that were not answered as a newer one was there already.
    commands : tuple of Command
    fault : str
        Why commands could not be sent any more, which ended the loop; else empty.
    """

    time: FloatArray
    sent_at: FloatArray
    sequence: NDArray[np.int64]
    latency_s: FloatArray
    passed_over: int
    commands: tuple[Command, ...]
    fault: str

    @property
    def jitter_s(self) -> FloatArray:
        """By how much the time between two commands to frames differs from the median, s."""
        between = np.diff(self.sent_at[self.sequence >= 0])
        out: FloatArray = between - np.median(between) if len(between) else between
        return out


def run_loop(source: Source, controller: JointController, send: Callable[[float], None], *, seconds: float) -> Loop:
    """Answer every frame of a source with a command, for a time.

    Parameters
    ----------
    source : Source
        Open. Its frames hold both sensors.
    controller : JointController
    send : callable
        Takes a speed, deg/s. At the end, whatever the reason, it is sent 0. Where it raises `InputError`, the loop ends.
    seconds : float

    Raises
    ------
    InputError
        As the source.
    """
    clock = HostClock()
    rows: list[tuple[float, int, float]] = []
    commands: list[Command] = []
    passed, last, fault = 0, -1, ""
    # All that there is by now stays: the collector need not walk it in the midst of the loop, which takes it 50 ms.
    gc.collect()
    gc.freeze()
    time.sleep(controller.period_s)  # whoever reads the source in a thread of its own stood still meanwhile, and catches up
    began = time.monotonic()
    controller.begin()
    try:
        while time.monotonic() < began + seconds:
            frame = _newest(source, PATIENCE * controller.period_s)
            now = clock.now()
            command = controller.step(now, frame, frame)
            try:
                send(command.speed)
            except InputError as error:
                fault = str(error)
                break
            if frame is not None:
                passed += max(frame.sequence - last - 1, 0) if last >= 0 else 0
                last = frame.sequence
            late = clock.now() - frame.host_time if frame is not None else np.nan
            rows.append((time.monotonic(), -1 if frame is None else frame.sequence, late))
            commands.append(command)
    finally:
        gc.unfreeze()
        unstopped = _stop(send)
    sent = np.array([row[0] for row in rows])
    return Loop(
        sent - began,
        sent,
        np.array([row[1] for row in rows], dtype=np.int64),
        np.array([row[2] for row in rows]),
        passed,
        tuple(commands),
        fault or unstopped,
    )


def _stop(send: Callable[[float], None]) -> str:
    """Tell the joint to stop; why that could not be sent, else empty."""
    try:
        send(0.0)
    except InputError as error:
        return str(error)
    return ""


def _newest(source: Source, timeout: float) -> Frame | None:
    """The next frame, or where several wait the newest of them: an old one is no help to a joint that moves."""
    frame = source.read(timeout)
    if frame is None:
        return None
    try:
        return source.read_latest(MAX_AGE_S)
    except StaleError:
        return frame


class FingerBoard:
    """The simulated finger as a board would show it, both sensors in a frame: give it to a `PtyServer`, and it to commands.

    Parameters
    ----------
    motion : Motion
        Of the human.
    seed : int
    plant : Plant, optional

    Attributes
    ----------
    made : list of float
        When each frame was made, by `time.monotonic`.
    robot : list of float
        The joint's true angle at each frame, deg.
    """

    stream = Stream(
        "finger board",
        (Channel("human_V", "V", "strain", low=0.0, high=3.3), Channel("robot_V", "V", "strain", low=0.0, high=3.3)),
        RATE_HZ,
        simulated=True,
    )

    def __init__(self, motion: Motion, *, seed: int, plant: Plant | None = None) -> None:
        plant = plant or Plant()
        self._motion, self._speed = motion, 0.0
        self._finger = Finger(plant, seed=seed, angle=float(motion.angle[0]))
        self._reader = Reader(HUMAN, plant.delay_s, np.random.default_rng([seed, 3]))
        self.made: list[float] = []
        self.robot: list[float] = []

    def command(self, speed: float) -> None:
        """From the next frame on the joint is driven at this speed, deg/s."""
        self._speed = speed

    def __iter__(self) -> Iterator[Frame]:
        for k, (t, angle) in enumerate(zip(self._motion.time.tolist(), self._motion.angle.tolist(), strict=True)):
            human, robot = self._reader.read(t, angle), self._finger.step(t, self._speed)
            self.made.append(time.monotonic())
            self.robot.append(self._finger.angle)
            values, valid, saturated = (
                np.concatenate([getattr(each, name) for each in (human, robot)]) for name in ("values", "valid", "saturated")
            )
            yield Frame(t, t, k, values, valid, saturated)
