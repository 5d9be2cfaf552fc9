"""What can be connected to, and how each is opened: a port, a log, a simulator."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from skinfab.errors import InputError
from skinfab.readout.serial_port import BAUD
from skinfab.readout.source import Source

STRAIN, FINGER = "strain channels", "robot finger"
#: A simulated hand on one of the paper's objects; the names are those of `calibration.contact.objects.OBJECTS`.
HANDS = {f"hand on a {name}": name for name in ("cube", "cylinder", "dodecahedron", "grip", "cup")}
SIMULATORS = (*HANDS, STRAIN, FINGER)


@dataclass(frozen=True)
class PortChoice:
    """A serial port; packets and lines of numbers are told apart by themselves."""

    port: str
    baud: int = BAUD

    @property
    def name(self) -> str:
        """For sentences."""
        return self.port


@dataclass(frozen=True)
class LogChoice:
    """A recorded log of any kind that `skinfab replay` reads."""

    path: Path
    speed: float = 1.0

    @property
    def name(self) -> str:
        """For sentences."""
        return self.path.name


@dataclass(frozen=True)
class SimulatorChoice:
    """One of `SIMULATORS`."""

    kind: str

    @property
    def name(self) -> str:
        """For sentences."""
        return f"simulated {self.kind}"


Choice = PortChoice | LogChoice | SimulatorChoice


def source_of(choice: Choice) -> tuple[Source, tuple[str, ...]]:
    """The source, not open yet, and what is to be said of it. Reading a log takes its time.

    Raises
    ------
    InputError
        The log cannot be read or played, or there is no such simulator.

    Examples
    --------
    >>> source, notes = source_of(SimulatorChoice("hand on a cube"))
    >>> source.stream.simulated, len(source.stream.channels), notes
    (True, 6, ())
    """
    if isinstance(choice, PortChoice):
        from skinfab.readout.serial_port import SerialPort

        return SerialPort(choice.port, baud=choice.baud), ()
    if isinstance(choice, LogChoice):
        from gui.live.player import Player
        from skinfab.readout.checks import check
        from skinfab.readout.logs.log import read_log

        log = read_log(choice.path)
        return Player(log.recording, speed=choice.speed), (*log.notes, *check(log.recording))
    return _simulator(choice.kind), ()


def ports() -> tuple[str, ...]:
    """The serial ports that there are, first those whose names stay the same when they are plugged in again."""
    from serial.tools import list_ports

    lasting = sorted(str(path) for path in Path("/dev/serial/by-id").glob("*"))
    return (*lasting, *sorted(each.device for each in list_ports.comports()))


def _simulator(kind: str) -> Source:
    if kind == STRAIN:
        from skinfab.readout.strain_simulator import simulated_strain

        return simulated_strain()
    from skinfab.readout.endless import endless

    if kind == FINGER:
        from skinfab.readout.frame import Recording

        def fingers() -> Iterator[Recording]:
            from calibration.finger.logs import ROBOT, SEED, finger_log
            from skinfab.readout.frame import Channel, Stream

            channels = (Channel("PIP_deg", "deg", "angle"), Channel("robot_V", "V", "strain", low=0.0, high=3.3))
            stream = Stream("robot finger", channels, 100.0, simulated=True)
            for seed in itertools.count(SEED):
                time, angle, volts = finger_log(ROBOT, seed=seed)
                import numpy as np

                yield Recording.of_values(stream, np.column_stack([angle, volts]), device_time=time)

        return endless(next(fingers()).stream, fingers)
    if kind not in HANDS:
        raise InputError(f"there is no simulator {kind!r}; there are {', '.join(SIMULATORS)}")
    from calibration.contact.simulator import simulate

    name = HANDS[kind]
    stream = replace(simulate(name).recording.stream, name=f"simulated {kind}")
    return endless(stream, lambda: (simulate(name, seed=seed).recording for seed in itertools.count()))
