"""What a file must have as a whole: a move, a homing before it, and an end that leaves the nozzle above the walls."""

from __future__ import annotations

from collections.abc import Iterator

from gcode.emit import END, TITLE
from gcode.moves import Finding, Trace
from gcode.printer import Printer
from gcode.program import XY_DECIMALS
from gcode.trace import homed_axes

#: Axes that each home policy leaves to the file.
HOMED = {"xyz": "XYZ", "xy": "XY", "none": ""}


def file_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """Findings about the file as a whole.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> print(*file_findings(trace("; nothing but words"), load_printer()))
    file: there is no move in it; give the G-code of a print
    """
    yield from _cut_off(judged)
    if not judged.moves:
        yield Finding(0, "there is no move in it", "give the G-code of a print")
        return
    yield from _not_homed(judged, printer)
    yield from _ends_low(judged, printer)


def _cut_off(judged: Trace) -> Iterator[Finding]:
    comments = [f"; {c.comment}" for c in judged.commands if not c.code]
    if comments[:1] == [TITLE] and END not in comments:
        yield Finding(0, f"it is skinfab's own but its last line {END!r} is missing: it is cut off", "write it anew")


def _not_homed(judged: Trace, printer: Printer) -> Iterator[Finding]:
    wanted = HOMED[printer.home]
    first = next((m.line for m in judged.moves if m.is_planar), judged.moves[0].line)
    homes = [c for c in judged.commands if c.code == "G28"]
    remedy = "put " + ("G28" if wanted == "XYZ" else f"G28 {' '.join(wanted)}") + " before the first move"
    never = [axis for axis in wanted if not any(axis in homed_axes(c) for c in homes)]
    late = [axis for axis in wanted if axis not in never and not any(axis in homed_axes(c) for c in homes if c.line < first)]
    if never:
        yield Finding(0, f"it never homes {' and '.join(never)}, so its places are anyone's guess", remedy)
    if late:
        yield Finding(first, f"it moves before {' and '.join(late)} are homed", remedy)


def _ends_low(judged: Trace, printer: Printer) -> Iterator[Finding]:
    last = judged.moves[-1]
    z, travel = last.end[2], printer.heights.travel
    remedy = f"lift to Z{travel:g} at the end; if the file was cut off, write it anew"
    if z is None:
        yield Finding(last.line, "it ends at an unknown height", remedy, last.pattern)
    elif z < travel - 10**-XY_DECIMALS:
        yield Finding(last.line, f"it ends with the nozzle at Z{z:.4f}, below the travel height", remedy, last.pattern)
