"""Contacts in what a port sends, told as they come."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from calibration.contact.detector import Contact, ContactDetector, Detection
    from skinfab.cli.listening import Listening
    from skinfab.readout.frame import Frame, Recording
    from skinfab.wiring import Wire

#: Where the port does not say how many frames come a second, they are counted for so long, s, and so many of them.
_COUNTED_S, _COUNTED = 2.0, 10
#: Channels that are not watched yet are named this often, s of the stream.
_NAMED_S = 10.0


def watch_port(
    port: str,
    *,
    baud: int | None,
    seconds: float | None,
    false_alarms: float,
    channels: Sequence[str] | None,
    wires: Sequence[Wire] = (),
    until_written: ExitStack,
) -> tuple[Recording, Detection, list[str]]:
    """Watch a port until Ctrl-C, or for a while: its frames, the contacts in them, and what is to be said of it.

    Where what it sends does not say how many frames come a second, as plain lines do not, they are counted first.
    With `wires` its channels are called after their sensors, and what they read at rest is compared with what was predicted.
    Once the port is open Ctrl-C is held off in `until_written`, which the caller leaves when what came is written.

    Raises
    ------
    InputError
        It cannot be opened, sends nothing, too little to know its rate, has no such channel, or is not the skin of those wires.
    """
    from calibration.contact.detector import ContactDetector
    from skinfab.cli.ending import ended_by_signals
    from skinfab.cli.listening import Listening
    from skinfab.readout.frame import Recording
    from skinfab.readout.serial_port import BAUD, SerialPort
    from skinfab.wired import rests, unit_notes, wired

    frames: list[Frame] = []
    notes: list[str] = []
    with SerialPort(port, baud=baud or BAUD) as source:
        stop = until_written.enter_context(ended_by_signals())
        stream, listening = source.stream, Listening(source, stop, seconds=seconds)
        if wires:
            stream, told_of = wired(stream, wires)
            notes += told_of
        if not stream.rate_hz:
            stream = replace(stream, rate_hz=_counted(listening, frames))
            notes.append(f"{port} does not say how many frames come a second; {stream.rate_hz:.4g} were counted")
        watch = ContactDetector(stream, false_alarms=false_alarms, channels=channels)
        told = Told(watch)
        for frame in frames:
            told.step(frame)
        for frame in listening.frames():
            frames.append(frame)
            told.step(frame)
        counts = source.counts
        if not frames:
            raise listening.too_little("sent no frame", "is the device running?")
        notes += listening.notes
    notes += [
        f"{count} frames were {how}" for how, count in (("lost", counts.lost), ("damaged", counts.bad), ("late", counts.late)) if count
    ]
    recording = Recording.of_frames(stream, frames)
    if wires:
        notes += [*unit_notes(stream, wires), *(each.verdict for each in rests(recording, wires) if each.verdict)]
    return recording, watch.found(), notes


def _counted(listening: Listening, frames: list[Frame]) -> float:
    """How many frames come a second; those that were counted are put into `frames`.

    Over all of them: lines arrive in bunches, so their distances say little.
    """
    frames += listening.frames(for_s=_COUNTED_S)
    while len(frames) < _COUNTED and (frame := next(listening.frames(), None)) is not None:
        frames.append(frame)
    spans = frames[-1].device_time - frames[0].device_time if len(frames) >= _COUNTED else 0.0
    if not spans > 0:
        raise listening.too_little(f"sent {len(frames)} frames, too few to count how many come a second", "watch it for longer")
    return (len(frames) - 1) / spans


class Told:
    """Says what comes as it comes: contacts, channels that are watched, not yet or no more."""

    def __init__(self, watch: ContactDetector) -> None:
        self._watch, self._waiting, self._frozen = watch, watch.waiting, watch.frozen
        self._next = math.nan

    def step(self, frame: Frame) -> None:
        """Give the detector a frame, and say what it brought about."""
        watch = self._watch
        contacts, now = watch.step(frame), watch.now
        frozen = [name for name in watch.frozen if name not in self._frozen]
        steps.say([_told(each, now) for each in contacts], kind="contact")
        steps.say([f"{now:.2f} s, {name} froze; it is not watched, check its wires and its range" for name in frozen])
        steps.say([f"{now:.2f} s, {name} reads again" for name in self._frozen if name not in watch.frozen])
        if rested := [name for name in self._waiting if name not in watch.waiting]:
            steps.say([f"{now:.2f} s, {', '.join(rested)} at rest; watched from now on"])
        self._waiting, self._frozen = watch.waiting, watch.frozen
        if math.isnan(self._next):
            self._next = now + _NAMED_S
        if self._waiting and now >= self._next:
            from calibration.contact.rest import STILL_S

            self._next = now + _NAMED_S
            names = ", ".join(self._waiting)
            steps.say([f"{now:.2f} s, {names} not watched yet: never at rest for {STILL_S:g} s, or silent; leave the object alone"])


def _told(contact: Contact, now: float) -> str:
    """
    Examples
    --------
    >>> from calibration.contact.detector import Contact
    >>> _told(Contact("S1", 5.0, 7.0, -1, 0.159), 7.01)
    '7.01 s, S1 let go after 2.00 s, -15.9 %'
    """
    if contact.end == contact.start:
        return f"{now:.2f} s, {contact.channel} was not touched at {contact.start:.2f} s: it had frozen"
    what = "touched" if contact.lasting else f"let go after {contact.end - contact.start:.2f} s"
    return f"{now:.2f} s, {contact.channel} {what}, {100 * contact.sign * contact.strength:+.1f} %"
