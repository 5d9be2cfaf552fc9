"""What a port sends until Ctrl-C, or for a while, and what is said of a port from which nothing comes."""

from __future__ import annotations

import math
import threading
import time
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps
from skinfab.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from skinfab.readout.frame import Frame
    from skinfab.readout.paced import PacedFrames
    from skinfab.readout.serial_port import SerialPort

#: How long to wait for a frame before looking whether time is up, s.
_WAIT_S = 0.2
#: After so long without a frame it is said that nothing comes, s; of a slow stream after so many of its periods.
_SILENT_S, _SILENT_PERIODS = 2.0, 3
#: Sentences on a port that came and went.
_OUTAGES = 4


class Listening:
    """The frames of an open port; that none comes is said while it lasts, once each time, and that they come again.

    Parameters
    ----------
    source : SerialPort
    stop : threading.Event
        No frame is waited for once it is set.
    seconds : float, optional
        Nor after so long, from now on.
    quiet : bool
        Say nothing; `notes` still knows.
    """

    def __init__(self, source: SerialPort, stop: threading.Event, *, seconds: float | None = None, quiet: bool = False) -> None:
        self._source, self._stop, self._quiet = source, stop, quiet
        self._began_at, self._heard = time.time(), time.monotonic()
        self._end = self._heard + (seconds or math.inf)
        rate = source.stream.rate_hz
        self._silent_s = max(_SILENT_S, _SILENT_PERIODS / rate if rate else 0.0)
        self._silent = False

    def frames(self, *, for_s: float = math.inf) -> Iterator[Frame]:
        """Frames as they come, for `for_s` at the most; asked for again it goes on."""
        end = min(self._end, time.monotonic() + for_s)
        while not self._stop.is_set() and (left := end - time.monotonic()) > 0:
            frame = self._source.read(min(left, _WAIT_S))
            self._say(came=frame is not None)
            if frame is not None:
                yield frame
                self._heard = time.monotonic()  # what was done with it is no silence

    def _say(self, *, came: bool) -> None:
        now = time.monotonic()
        if came:
            self._heard = now
        silent = now - self._heard >= self._silent_s
        if silent != self._silent and not self._quiet:
            port = self._source.port
            steps.say([f"nothing comes from {port}; is it plugged in, and does it send?" if silent else f"{port} sends again"])
        self._silent = silent

    @property
    def outages(self) -> list[dict[str, Any]]:
        """When the port was gone meanwhile."""
        return outages(self._source, self._began_at, time.time())

    @property
    def notes(self) -> list[str]:
        """A sentence on each of them."""
        return outage_notes(self._source.port, self.outages)

    def too_little(self, what: str, advice: str) -> InputError:
        """The error for a port of which not enough came: `what` it did, and that it was gone, or else what to do."""
        return InputError("; ".join([f"{self._source.port} {what}", *(self.notes or [advice])]))


def outages(source: SerialPort | PacedFrames, began: float, ended: float) -> list[dict[str, Any]]:
    """When a port was gone between two moments (s since 1970), ready for JSON; a simulator never is."""
    from skinfab.readout.serial_port import SerialPort

    if not isinstance(source, SerialPort):
        return []
    return [
        {
            "after_s": round(max(each.began - began, 0.0), 3),
            "lasted_s": round(max((ended if each.ended is None else each.ended) - max(each.began, began), 0.0), 3),
            "back": each.ended is not None,
        }
        for each in source.outages
    ]


def outage_notes(port: str, gone: Sequence[dict[str, Any]]) -> list[str]:
    """A sentence on each time the port was gone, on the first few where there are many.

    Examples
    --------
    >>> outage_notes("/dev/ttyACM0", [{"after_s": 1.25, "lasted_s": 2.5, "back": False}])
    ['/dev/ttyACM0 was gone from 1.2 s on and did not come back: the last 2.5 s are missing; look at its cable']
    """
    notes = [
        f"{port} was gone from {each['after_s']:.1f} s on, for {each['lasted_s']:.1f} s; look at its cable"
        if each["back"]
        else f"{port} was gone from {each['after_s']:.1f} s on and did not come back: the last {each['lasted_s']:.1f} s are missing; "
        "look at its cable"
        for each in gone
    ]
    if len(notes) <= _OUTAGES:
        return notes
    rest = gone[_OUTAGES - 2 : -1]
    return [
        *notes[: _OUTAGES - 2],
        f"{port} was gone {len(rest)} more times, for {sum(each['lasted_s'] for each in rest):.1f} s",
        notes[-1],
    ]
