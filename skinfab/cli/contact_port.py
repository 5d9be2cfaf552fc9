"""Contacts in what a port sends, told as they come."""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from calibration.contact.detector import Contact, ContactDetector, Detection
    from skinfab.readout.frame import Frame, Recording
    from skinfab.readout.serial_port import SerialPort

#: How long to wait for a frame before looking whether time is up, s.
_WAIT_S = 0.2


def watch_port(
    port: str, *, baud: int | None, seconds: float | None, false_alarms: float, channels: Sequence[str] | None
) -> tuple[Recording, Detection, list[str]]:
    """Watch a port until Ctrl-C, or for a while: its frames, the contacts in them, and what is to be said of it.

    Raises
    ------
    InputError
        It cannot be opened, sends nothing, or has no such channel.
    """
    from calibration.contact.detector import ContactDetector
    from skinfab.errors import InputError
    from skinfab.readout.frame import Recording
    from skinfab.readout.serial_port import BAUD, SerialPort

    frames: list[Frame] = []
    with SerialPort(port, baud=baud or BAUD) as source:
        watch = ContactDetector(source.stream, false_alarms=false_alarms, channels=channels)
        try:
            _watch(source, watch, frames, time.monotonic() + (seconds or math.inf))
        except KeyboardInterrupt:
            signal.setitimer(signal.ITIMER_REAL, 0)  # the way to end it: it has got through, and is not to come a second time
        counts = source.counts
    if not frames:
        raise InputError(f"{port} sent no frame; is the device running?")
    notes = [
        f"{count} frames were {how}" for how, count in (("lost", counts.lost), ("damaged", counts.bad), ("late", counts.late)) if count
    ]
    return Recording.of_frames(source.stream, frames), watch.found(), notes


def _watch(source: SerialPort, watch: ContactDetector, frames: list[Frame], end: float) -> None:
    while (left := end - time.monotonic()) > 0:
        if (frame := source.read(min(left, _WAIT_S))) is not None:
            frames.append(frame)
            steps.say([_told(each, frame.device_time) for each in watch.step(frame)], kind="contact")


def _told(contact: Contact, now: float) -> str:
    """
    Examples
    --------
    >>> from calibration.contact.detector import Contact
    >>> _told(Contact("S1", 5.0, 7.0, -1, 0.159), 7.01)
    '7.01 s, S1 let go after 2.00 s, -15.9 %'
    """
    what = "touched" if contact.lasting else f"let go after {contact.end - contact.start:.2f} s"
    return f"{now:.2f} s, {contact.channel} {what}, {100 * contact.sign * contact.strength:+.1f} %"
