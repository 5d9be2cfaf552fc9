"""What a sensor reads while nothing touches it is its offset, and is taken off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.wrench import SensorNoise

#: Samples that an offset needs: it is then known to a third of the noise.
LEAST_SAMPLES = 10
#: The force is steady where its halves differ by less than so many standard deviations of their difference.
_STEADY_SD = 6.0


def tared(log: WrenchLog, *, seconds: float) -> WrenchLog:
    """The log less what it read in its first seconds, in which nothing may touch the finger.

    Raises
    ------
    InputError
        There are too few samples in that time, or the readings change within it: something touched.

    Examples
    --------
    >>> log = WrenchLog("a", np.arange(40) / 200, np.full((40, 3), 0.3), np.zeros((40, 3)))
    >>> float(np.abs(tared(log, seconds=0.1).force).max()) < 1e-12
    True
    """
    noise = SensorNoise()
    rest = log.time < log.time[0] + seconds
    count = int(rest.sum())
    if count < LEAST_SAMPLES:
        raise InputError(
            f"{log.name}: {count} sample{'s' * (count != 1)} in the first {seconds:g} s are too few for the sensor's offset; rest "
            "longer, or give --tare 0 where it is off already"
        )
    for name, readings, sd in (("force", log.force[rest], noise.force_n), ("moment", log.moment[rest], noise.moment_nmm)):
        half = count // 2
        step = np.abs(readings[:half].mean(axis=0) - readings[half:].mean(axis=0)).max()
        own = max(sd, float(np.median(np.abs(np.diff(readings, axis=0)))))
        if step > _STEADY_SD * own * np.sqrt(4 / count):
            raise InputError(
                f"{log.name}: the {name} changes by {step:.3g} within the first {seconds:g} s, so something touches the finger; "
                "let nothing touch it there, or take off less time"
            )
    return replace(log, force=log.force - log.force[rest].mean(axis=0), moment=log.moment - log.moment[rest].mean(axis=0))
