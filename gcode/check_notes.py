"""What is no fault but explains many: a file for another printer, or in another dialect; and where it waits."""

from __future__ import annotations

from collections.abc import Iterator

from gcode.check_waits import STOPPED
from gcode.emit import TITLE, emit_comment
from gcode.moves import Trace
from gcode.printer import Printer

#: Commands that GRBL halts at, though every file for Marlin has some of them.
MARLIN = frozenset({"M82", "M83", "M104", "M106", "M107", "M109", "M140", "M190", "M220", "M221", "M302", "M900"})
MOVES = ("G0", "G1", "G2", "G3")


def notes(judged: Trace, printer: Printer) -> Iterator[str]:
    """Notes, one sentence each.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> print(*notes(trace("M3 S200\\nG1 X10 F300\\nM5"), load_printer()))
    it looks like a file for GRBL (M3 turns a pump, and no move has E), but Creality Ender 5 Plus with ViscoTek vipro-HEAD 3 speaks \
Marlin: give --printer generic-grbl or your own profile with a [spindle]
    """
    yield from _other_printer(judged, printer)
    yield from _other_dialect(judged, printer)
    yield from _waits_before_ink(judged)


def _other_printer(judged: Trace, printer: Printer) -> Iterator[str]:
    head = [f"; {c.comment}" for c in judged.commands[:8] if not c.code]
    named = next((line for line in head if line.startswith("; printer ")), None)
    if head[:1] == [TITLE] and named and [named] != emit_comment(f"printer {printer.name}"):
        other = named.removeprefix("; printer ")
        yield f"its head says it is for {other}, it is judged for {printer.name}: give --printer where that is not meant"


def _other_dialect(judged: Trace, printer: Printer) -> Iterator[str]:
    with_e = next((c for c in judged.commands if c.code in MOVES and "E" in c.words), None)
    if printer.spindle:
        said = with_e or next((c for c in judged.commands if c.code in MARLIN), None)
        if said:
            what = f"{said.code} E" if said is with_e else said.code
            yield f"it looks like a file for Marlin ({what} in line {said.line}), but {printer.name} speaks GRBL: give --printer"
        return
    turned = next((c for c in judged.commands if c.code in ("M3", "M4") and "S" in c.words), None)
    if turned and not with_e:
        yield (
            f"it looks like a file for GRBL ({turned.code} turns a pump, and no move has E), but {printer.name} speaks Marlin: "
            "give --printer generic-grbl or your own profile with a [spindle]"
        )


def _waits_before_ink(judged: Trace) -> Iterator[str]:
    first = min((m.line for m in judged.moves if m.e > 0 and m.is_planar), default=0)
    for command in judged.commands:
        if command.code in STOPPED and command.line < first:
            yield f"line {command.line}: {command.code} waits for {STOPPED[command.code]} before the first ink; pour only after it"
