"""What a six-axis fingertip sensor reads: a force and a moment in its own frame, and how noisy they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Stream

#: Channels of a six-axis sensor, in this order everywhere: force in N, moment about the frame's origin in N mm.
WRENCH = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")

#: Of the seed's fingertip: half a table tennis ball.
RADIUS_MM = 20.0


@dataclass(frozen=True)
class SensorNoise:
    """Standard deviation of each axis of a sensor, sample by sample.

    Parameters
    ----------
    force_n : float, N
    moment_nmm : float, N mm

    Raises
    ------
    InputError
        One of them is negative or no number.
    """

    force_n: float = 0.02
    moment_nmm: float = 0.2

    def __post_init__(self) -> None:
        for name, value in (("force_n", self.force_n), ("moment_nmm", self.moment_nmm)):
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"a sensor noise {name} of {value:g} is none; give its standard deviation, 0 or more")

    def averaged(self, samples: int) -> SensorNoise:
        """Of a mean over so many samples.

        Examples
        --------
        >>> SensorNoise().averaged(4)
        SensorNoise(force_n=0.01, moment_nmm=0.1)
        """
        return SensorNoise(self.force_n / math.sqrt(samples), self.moment_nmm / math.sqrt(samples))


def force_stream(name: str, rate_hz: float, *, simulated: bool = False) -> Stream:
    """The stream of one six-axis sensor.

    Examples
    --------
    >>> force_stream("fingertip", 200.0).names
    ('Fx', 'Fy', 'Fz', 'Mx', 'My', 'Mz')
    """
    channels = tuple(Channel(each, "N" if each[0] == "F" else "N mm", "force" if each[0] == "F" else "moment") for each in WRENCH)
    return Stream(name, channels, rate_hz, simulated)
