"""What a device's own count tells of its frames: which are missing, which come late or twice, and when it started anew."""

from __future__ import annotations

from skinfab.readout.packets import SEQUENCE_BITS
from skinfab.readout.source import Unwrapped

#: A frame that is further back than this is not late: the device has begun to count from zero again.
LATE_FRAMES = 64


class InOrder:
    """Puts each frame in its place.

    Examples
    --------
    >>> order = InOrder()
    >>> [order.place(counter) for counter in (7, 8, 8, 10, 9, 11)], order.lost, order.late
    ([7, 8, None, 10, None, 11], 1, 2)
    """

    def __init__(self) -> None:
        self._count = Unwrapped(bits=SEQUENCE_BITS)
        self._shift = 0
        self._last: int | None = None
        self._anew = False
        #: Frames missing so far, frames dropped because they came late or a second time, and how often the count began anew.
        self.lost = self.late = self.restarts = 0

    def reopened(self) -> None:
        """The port was gone: a count that goes on tells what was missed meanwhile, one that goes back has begun anew."""
        self._anew = True

    def place(self, counter: int) -> int | None:
        """The frame's number, which only grows; None for a frame to be dropped."""
        whole = self._count.of(counter) + self._shift
        if self._last is not None:
            step = whole - self._last
            if step <= 0 and not self._anew and step > -LATE_FRAMES:
                self.late += 1
                return None
            if step <= 0:
                # How many were missed nobody knows: the count goes on as if none were.
                self._shift += 1 - step
                whole, step = self._last + 1, 1
                self.restarts += 1
            self.lost += step - 1
        self._last, self._anew = whole, False
        return whole
