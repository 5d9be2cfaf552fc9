"""Waits in the midst of the ink: silicone sets while a person is waited for, and a bead swells where the head stands."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator

from gcode.moves import Finding, Trace
from gcode.printer import Printer
from gcode.words import Command
from skinfab.tolerances import WET_DWELL_S

#: Who or what is waited for, for any length of time (marlinfw.org, M0, M25 and M226; M601 is Prusa's); GRBL knows the first two.
STOPPED = {"M0": "a click", "M1": "a click", "M25": "someone to resume", "M226": "a pin", "M601": "someone to resume"}

#: They wait for a temperature: with S while it is lower, with R in any case, so with some sensors at S0 too.
TEMPERATURE = frozenset({"M109", "M116", "M190", "M191", "M192"})


def wait_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """Waits for somebody before the last ink, any wait between two moves of one stroke, and dwells the silicone does not stand.

    All dwells from one ink to the next are one wait: the bead laid before sets through all of them.

    A stroke ends where the nozzle lifts: a way at print height without ink does not end it. A dwell after a lift, after
    the last ink before one, or before the ink is none of these.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> text = "M83\\nM302 P1\\nG0 X0 Y0 Z1.6 F300\\nG4 P500\\nG1 X9 E36\\nG4 P500\\nG1 Y9 E36\\nG0 Z10\\nG4 P500"
    >>> print(*wait_findings(trace(text), load_printer()))
    line 6: G4 waits 0.5 s within a stroke, and ink gathers where the nozzle stands; put it behind the lift
    """
    inked = [m.line for m in judged.moves if m.e > 0 and m.is_planar]
    first, last = min(inked, default=math.inf), max(inked, default=-math.inf)
    ways = [m for m in judged.moves if m.is_planar or m.start[2] != m.end[2]]  # all but ink at standstill
    lines = [m.line for m in ways]
    lifts = [m.start[2] != m.end[2] and not _is_low(m.end[2], printer) for m in ways]
    lays = [m.e > 0 and m.is_planar for m in ways]
    after_ink = _held(lays, lifts)
    before_ink = _held(lays[::-1], lifts[::-1])[::-1]
    at_ink, waited, told = -1, 0.0, False  # the ink before this dwell, the dwells since, and whether they were told to be too long
    for command in judged.commands:
        code = command.code
        if code not in STOPPED and code not in TEMPERATURE and code != "G4":
            continue
        # On a line of several codes the head moves before M0 stops it.
        if not first <= command.line < last:
            continue
        if code in STOPPED:
            if printer.spindle is None or code in ("M0", "M1"):
                what = f"{code} waits for {STOPPED[code]} in the midst of the ink, and the silicone sets meanwhile"
                yield Finding(command.line, what, "take it out")
            continue
        after = bisect_left(lines, command.line)
        if code == "G4":
            if (ink := bisect_left(inked, command.line)) != at_ink:
                at_ink, waited, told = ink, 0.0, False
            seconds = _seconds(command, printer)
            waited += seconds
            if waited > (most := _longest(printer)) and not told:
                told = True
                waits = f"G4 waits {seconds:g} s" if seconds == waited else f"G4 waits {seconds:g} s more, {waited:g} s in all"
                what = f"{waits} in the midst of the ink, where {most:g} is the most, and the silicone sets meanwhile"
                remedy = "shorten it, or take it out; P is seconds" if printer.spindle else "shorten it, or take it out"
                yield Finding(command.line, what, remedy, ways[after].pattern)
                continue
        if not (after_ink[after - 1] and before_ink[after]):
            continue
        if code == "G4" and seconds > 0:
            what = f"G4 waits {seconds:g} s within a stroke, and ink gathers where the nozzle stands"
            yield Finding(command.line, what, "put it behind the lift", ways[after].pattern)
        elif code != "G4" and printer.spindle is None:
            what = f"{code} may wait for a temperature within a stroke, and ink gathers where the nozzle stands"
            yield Finding(command.line, what, "take it out; the print is cold throughout", ways[after].pattern)


def _is_low(z: float | None, printer: Printer) -> bool:
    return z is not None and z <= printer.heights.print_max


def _longest(printer: Printer) -> float:
    """The longest wait from ink to ink, s; what the profile itself asks for is meant."""
    return max(WET_DWELL_S, printer.process.pause + (printer.cleaning.seconds if printer.cleaning else 0.0))


def _held(lays: list[bool], lifts: list[bool]) -> list[bool]:
    """After each way: was ink laid, and the nozzle not lifted since?"""
    held, inked = [], False
    for lays_ink, lift in zip(lays, lifts, strict=True):
        inked = lays_ink or (inked and not lift)
        held.append(inked)
    return held


def _seconds(command: Command, printer: Printer) -> float:
    """P is ms for Marlin and s for GRBL; with both, Marlin takes S."""
    p, s = (command.words.get(letter) or 0.0 for letter in "PS")
    if printer.spindle:
        return p
    return s if "S" in command.words else p / 1000
