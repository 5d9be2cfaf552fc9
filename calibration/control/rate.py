"""How often a board really sends, before a joint is driven by it."""

from __future__ import annotations

import contextlib
import math

from calibration.control.controller import HOLD_S
from calibration.control.loop import PATIENCE
from skinfab.errors import InputError, RefusedError
from skinfab.readout.frame import Frame
from skinfab.readout.source import HostClock, Source, StaleError

#: For so long frames are counted, s: where they come within 10 ms of when they should, the rate is then right to 1 %.
MEASURED_S = 1.0
#: A stream's own word is told where it is off by more than this part: more than the measuring can be, and of no weight for the loop.
RATE_PART = 0.05
#: With fewer frames, 1/s, the command is held for longer than is allowed before anybody notices that there is none.
LEAST_HZ = PATIENCE / HOLD_S


def measured_rate(source: Source, *, seconds: float = MEASURED_S) -> float:
    """Frames a second by the host's clock, for the device's is what might be wrong; lost frames count, for they will be missing.

    Parameters
    ----------
    source : Source
        Open; what comes meanwhile is used up.
    seconds : float
        Times two where frames come slowly.

    Raises
    ------
    InputError
        Hardly any frame comes.
    RefusedError
        So few come that a joint cannot be driven safely.

    Examples
    --------
    >>> from skinfab.readout.strain_simulator import simulated_strain
    >>> with simulated_strain(channels=2, rate_hz=50.0) as source:
    ...     45 < measured_rate(source, seconds=0.5) < 55
    True
    """
    clock = HostClock()
    with contextlib.suppress(StaleError):
        source.read_latest(math.inf)  # what waits here came in one go
    began = clock.now()
    first: Frame | None = None
    last: Frame | None = None
    count = 0
    while (now := clock.now()) < began + seconds or (count < 2 and now < began + 2 * seconds):
        frame = source.read(0.1)
        if frame is not None:
            first, last, count = first or frame, frame, count + 1
    if first is None or last is None or not last.host_time > first.host_time:
        raise InputError(f"in {2 * seconds:g} s hardly any frame came ({count}); look at the board, its supply and its cable")
    rate = (count - 1) / (last.host_time - first.host_time)
    if rate < LEAST_HZ * (1 - RATE_PART):
        raise RefusedError(
            f"the board sends {rate:.3g} frames a second, and a joint must be stopped {HOLD_S:g} s after the last good one: that takes "
            f"{LEAST_HZ:g} at least; let the board send more"
        )
    return rate
