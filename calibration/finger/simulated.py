"""A simulated finger: a joint that follows commanded speeds, and strain sensors with slack, read late and with noise.

As small as the figures of "Soft Sensing Skins for Arbitrary Objects" (section III) allow: docs/control.md has a table with
what becomes of them without each term. Left out is what no published figure speaks of: friction and elasticity of the
tendons, the other joints, contact, drift and creep of the silicone, crosstalk of the multiplexers, the jitter of a real
board. A controller that does well here has passed a first test, no more. All that it makes is marked as simulated.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.strain.curve import Curve
from calibration.strain.play import Play
from skinfab.readout.frame import Channel, Frame, Stream

FloatArray = NDArray[np.float64]

#: Frames a second, as the paper's board sends them.
RATE_HZ = 100.0
#: The board reads from 0 V to this.
RAIL_V = 3.3


@dataclass(frozen=True, eq=False)
class FingerSensor:
    """A strain sensor over a joint.

    Parameters
    ----------
    name : str
        Of its channel.
    curve : Curve
        dU/U0 over what of the angle reaches the conductor; beyond its range the reading stays where it is.
    play_deg : float
        Half-width of the slack between joint and conductor: the hysteresis.
    noise : float
        Standard deviation of a reading, dU/U0.
    u0 : float, V
        The reading where the curve is 0.
    """

    name: str
    curve: Curve
    play_deg: float
    noise: float
    u0: float

    @property
    def stream(self) -> Stream:
        """Its frames: one channel of volts."""
        return Stream(self.name, (Channel(self.name, "V", "strain", low=0.0, high=RAIL_V),), RATE_HZ, simulated=True)


#: The paper's human finger: over its slack a cubic fits with R2 0.94 and 1.6e-4 / 5.3e-4 / 1.6e-3 per degree.
HUMAN = FingerSensor("human", Curve(10.0, 80.0, np.array([0.0, 0.01262, -0.00234, 0.04034])), play_deg=4.0, noise=3e-4, u0=1.5)
#: Its robot finger: over its slack a quartic fits with R2 0.86 and 8.5e-5 / 4.7e-3 / 7.7e-3 per degree.
ROBOT = FingerSensor("robot", Curve(10.0, 80.0, np.array([0.0, 0.165, 0.4409, 0.375, 0.4209])), play_deg=9.0, noise=3e-3, u0=1.5)


@dataclass(frozen=True)
class Plant:
    """All of the simulated robot finger but the joint's state.

    Parameters
    ----------
    sensor : FingerSensor
    lag_s : float
        Time constant with which the joint's speed follows the command; 0: at once.
    delay_s : float
        From motion to the frame that shows it, whole periods of `RATE_HZ`.
    low, high : float, deg
        Where the joint stops.
    """

    sensor: FingerSensor = ROBOT
    lag_s: float = 0.1
    delay_s: float = 0.05
    low: float = 0.0
    high: float = 95.0


class Reader:
    """A sensor and the board that reads it: it is told angles as they come and gives frames of what was `delay_s` ago.

    Parameters
    ----------
    sensor : FingerSensor
    delay_s : float
        Rounded to whole periods of `RATE_HZ`.
    rng : numpy Generator
        Of the noise.

    Examples
    --------
    >>> reader = Reader(HUMAN, 0.0, np.random.default_rng(0))
    >>> frame = reader.read(0.0, 10.0)
    >>> round(float(frame.values[0]), 2), bool(frame.valid[0]), frame.sequence
    (1.5, True, 0)
    """

    def __init__(self, sensor: FingerSensor, delay_s: float, rng: np.random.Generator) -> None:
        self.sensor, self.stream = sensor, sensor.stream
        self._play = Play(sensor.play_deg)
        self._powers = sensor.curve.coefficients[::-1].tolist()  # a polynomial of floats: a numpy call would take as long as the rest
        self._late: deque[tuple[float, float]] = deque(maxlen=round(delay_s * RATE_HZ) + 1)
        self._rng = rng
        self._count = 0

    def read(self, time: float, angle: float) -> Frame:
        """The frame that arrives now; at the start the first angle counts as having been there all along."""
        measured, volts = self.arrives(time, angle)
        frame = Frame(measured, time, self._count, np.array([volts]), np.array([True]), np.array([not 0.0 < volts < RAIL_V]))
        self._count += 1
        return frame

    def arrives(self, time: float, angle: float) -> tuple[float, float]:
        """The same without a frame about it: when it was measured, s, and the reading, V."""
        stretch = min(max(self._play.step(angle), self.sensor.curve.low), self.sensor.curve.high)
        change = 0.0
        for power in self._powers:
            change = change * stretch + power
        change += self.sensor.noise * self._rng.standard_normal()
        self._late.append((time, min(max(self.sensor.u0 * (1 + change), 0.0), RAIL_V)))
        return self._late[0]


class Finger:
    """The robot finger at work.

    Parameters
    ----------
    plant : Plant
    seed : int
        Of its noise.
    angle : float, deg
        Where it rests at first.

    Examples
    --------
    >>> finger = Finger(Plant(), seed=0)
    >>> for k in range(100):
    ...     frame = finger.step(k / RATE_HZ, 20.0)
    >>> round(finger.angle, 1)  # a second of 20 deg/s, and 0.1 s to get going
    28.0
    """

    def __init__(self, plant: Plant, *, seed: int, angle: float = 10.0) -> None:
        self.plant, self.angle, self.speed = plant, angle, 0.0
        self.reader = Reader(plant.sensor, plant.delay_s, np.random.default_rng([seed, 1]))

    def step(self, time: float, command: float) -> Frame:
        """Move for one period at a commanded speed (deg/s); the frame that arrives at its end, at `time` (s)."""
        period, lag = 1 / RATE_HZ, self.plant.lag_s
        kept = math.exp(-period / lag) if lag > 0 else 0.0
        # The exact solution for a command that stays the same throughout the period.
        self.angle += command * period + (self.speed - command) * lag * (1 - kept)
        self.speed = command + (self.speed - command) * kept
        stopped = min(max(self.angle, self.plant.low), self.plant.high)
        if stopped != self.angle:
            self.angle, self.speed = stopped, 0.0
        return self.reader.read(time, self.angle)
