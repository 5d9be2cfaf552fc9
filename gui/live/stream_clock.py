"""One time for the plots, which only grows: the device's own, moved where the device began anew or stood still."""

from __future__ import annotations

import math

#: The device's clock may be off the computer's by this much, s, before it is taken to have begun anew or to have stood still.
APART_S = 0.5
#: Between two frames at least, s: times that stand still would lie on one another.
_LEAST_S = 1e-6


class StreamClock:
    """Seconds since the first frame.

    Parameters
    ----------
    live : bool
        Frames come as they are measured, so that the computer's clock says how long the stream was silent. False for a log, whose
        own times are all there is.

    Examples
    --------
    >>> clock = StreamClock(live=True)
    >>> clock.at(100.0, 5.0), clock.at(100.5, 5.51)
    (0.0, 0.5)
    >>> clock.at(0.0, 9.0)  # unplugged meanwhile: the board counts from zero again
    4.0
    """

    def __init__(self, *, live: bool) -> None:
        self._live = live
        self._shift = self._host_zero = math.nan
        self._last = -math.inf

    def at(self, device: float, host: float) -> float:
        """When a frame was, by its own two times, s."""
        if math.isnan(self._shift):
            if math.isfinite(device):
                self._shift, self._host_zero = -device, host
                self._last = 0.0
                return 0.0
            return 0.0
        now = device + self._shift
        if self._live and math.isfinite(host) and not abs(now - (host - self._host_zero)) <= APART_S:
            now = host - self._host_zero
        if not now > self._last:
            now = self._last + _LEAST_S
        if math.isfinite(device):
            self._shift = now - device
        self._last = now
        return now
