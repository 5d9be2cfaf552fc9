"""Limits of the firmware that a file changes away from what the printer profile says."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gcode.moves import Finding, Trace
from gcode.printer import Printer
from gcode.trace import MM_PER_INCH
from skinfab.tolerances import SETTING_FRACTION


@dataclass(frozen=True)
class Limit:
    """One word of a command: `name` for people, `table` and `field` of the profile.

    Where the field is `at_most` the limit, not the limit itself, only less than it is a fault.
    """

    name: str
    table: str
    field: str
    at_most: bool = False


_ACCELERATION = Limit("acceleration", "motion", "acceleration")
_SPEED = Limit("greatest speed", "motion", "max_speed")

LIMITS = {
    "M201": {"X": _ACCELERATION, "Y": _ACCELERATION},
    "M203": {
        "X": _SPEED,
        "Y": _SPEED,
        "Z": Limit("greatest speed", "motion", "z_speed", at_most=True),
        "E": Limit("greatest speed", "pump", "max_e_speed"),
    },
    "M204": {"P": _ACCELERATION, "S": _ACCELERATION, "T": _ACCELERATION},
    "M205": {"J": Limit("junction deviation", "motion", "junction_deviation")},
}


def setting_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """Commands that lower or raise a limit, in the order of the lines; those that say what the profile says are fine.

    A lower limit slows the head in silence, at the same flow where a pump is a spindle; a higher one
    makes the speeds on arcs, the time and the corners other than judged.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> print(*setting_findings(trace("M203 X300 Y300 E5"), load_printer()))
    line 1: M203 E5 lowers the greatest speed to 5, the profile says 25; take it out, or measure with it and put max_e_speed = 5 \
under [pump] in the printer profile
    """
    scale = 1.0
    for command in judged.commands:
        if command.code in ("G20", "G21"):
            scale = MM_PER_INCH if command.code == "G20" else 1.0
        for letter, limit in LIMITS.get(command.code, {}).items():
            value = command.words.get(letter)
            said = float(getattr(getattr(printer, limit.table), limit.field))
            if value is None or math.isclose(value * scale, said, rel_tol=SETTING_FRACTION) or (limit.at_most and value * scale > said):
                continue
            change = "raises" if value * scale > said else "lowers"
            yield Finding(
                command.line,
                f"{command.code} {letter}{value:g} {change} the {limit.name} to {value * scale:g}, the profile says {said:g}",
                f"take it out, or measure with it and put {limit.field} = {value * scale:g} under [{limit.table}] in the printer profile",
            )
