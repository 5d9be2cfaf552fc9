"""Commands that GRBL 1.1 does not know, or that undo what was set by hand before a print."""

from __future__ import annotations

from collections.abc import Iterator

from gcode.moves import Finding, Trace
from gcode.words import SETTING, Command

#: Words that GRBL takes on a three-axis machine; any other is an error, at which a sender stops.
WORDS = {"G0": "XYZFS", "G1": "XYZFS", "G2": "XYZFSIJKR", "G3": "XYZFSIJKR", "G4": "P", "M3": "S", "M4": "S", "M5": "S", SETTING: "FS"}

#: Commands it knows besides those: modes, offsets, stored places, probing, and the end (gnea/grbl, "Grbl v1.1 Commands").
KNOWN = frozenset(
    f"{letter}{number}"
    for letter, numbers in (
        ("G", "10 17 18 19 20 21 28 28.1 30 30.1 38.2 38.3 38.4 38.5 40 43.1 49 53 54 55 56 57 58 59 61 80 90 91 91.1 92 92.1 93 94"),
        ("M", "0 1 2 30 7 8 9"),
    )
    for number in numbers.split()
)

#: G54 is no fault: it is the origin that G10 L20 P1 sets, and the one after a reset. Nor is G49, which ends what only G43.1 begins.
PLACES = ("G28", "G30")
PROBES = ("G38.2", "G38.3", "G38.4", "G38.5")
OFFSETS = ("G10", "G28.1", "G30.1", "G43.1", "G55", "G56", "G57", "G58", "G59", "G92", "G92.1")


def grbl_findings(judged: Trace) -> Iterator[Finding]:
    """What is wrong with single commands, in the order of the lines.

    Examples
    --------
    >>> from gcode.trace import trace
    >>> print(*grbl_findings(trace("M83")))
    line 1: GRBL does not know M83 and halts there; take it out
    """
    for command in judged.commands:
        if command.code and (fault := _fault(command)):
            yield Finding(command.line, *fault)


def _dwell(command: Command) -> tuple[str, str] | None:
    seconds = command.words.get("P")
    if seconds is None:
        return "G4 has no P, and GRBL halts there", "give P, the seconds"
    return (f"G4 P{seconds:g} is negative, and GRBL halts there", "give P, the seconds, as zero or more") if seconds < 0 else None


def _fault(command: Command) -> tuple[str, str] | None:
    code = command.code
    if code in WORDS:
        unknown = "".join(letter for letter in command.words if letter not in WORDS[code])
        if code == "G4" and (fault := _dwell(command)):
            return fault
        if "E" in unknown:
            return f"GRBL has no E axis and halts at {code} E", "let M3 S run the pump, or choose a Marlin printer"
        return (f"GRBL does not know {unknown} on {code} and halts there", "take it out") if unknown else None
    if code[0] == "T":
        return None  # a tool's number is kept and nothing done; changing it, M6, is not known
    if strange := "".join(sorted(command.words.keys() - set("XYZIJKRPLFST"))):
        return f"GRBL does not know {strange} on {code} and halts there", "take it out"
    if code not in KNOWN:
        return f"GRBL does not know {code} and halts there", "take it out"
    if code in PROBES:
        return f"{code} probes: the probe dips into the wet mould", "take it out and set Z by hand"
    if code in PLACES:
        return f"{code} goes to a place stored in the machine, which no rule can judge", "write the place as G1 X Y Z"
    if code in OFFSETS:
        return f"{code} moves the origin that was set by hand", "send it before the start, not in the file"
    if code == "G53":
        return "G53 moves in the machine's own places, which no rule can judge", "write the place from the origin that was set"
    if code == "G93":
        return "G93 reads F as one over a time", "use G94 and F in mm/min"
    return None
