"""Judge a program or any G-code text against one printer, before ink is laid.

A file of this project and a foreign one stand under the same rules; a finding says where, what, and what to change.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from gcode.check_balance import balance_findings
from gcode.check_bead import bead_findings, meant_area
from gcode.check_blob import blob_findings
from gcode.check_commands import command_findings
from gcode.check_dialect import dialect_findings
from gcode.check_file import file_findings
from gcode.check_grbl import grbl_findings
from gcode.check_height import height_findings
from gcode.check_ink import ink_findings, laid_pieces
from gcode.check_lines import line_findings
from gcode.check_mould import Mould, mould_findings, piece_findings
from gcode.check_notes import notes
from gcode.check_settings import setting_findings
from gcode.check_waits import wait_findings
from gcode.check_wall import Wall, wall_findings
from gcode.emit import emit
from gcode.geometry import Curve, Straight
from gcode.moves import Finding, Move
from gcode.printer import Bed, Printer
from gcode.program import E_DECIMALS, F_DECIMALS, XY_DECIMALS, Program
from gcode.trace import trace_as_far
from skinfab.errors import InputError
from skinfab.tolerances import ARC_RADIUS_MM

Corner: TypeAlias = tuple[float | None, float | None]

#: Half a step of each emitted word: what rounding alone may add.
HALF_XY, HALF_E, HALF_F = 0.5 * 10**-XY_DECIMALS, 0.5 * 10**-E_DECIMALS, 0.5 * 10**-F_DECIMALS / 60


def check_program(program: Program, printer: Printer, *, wall: Wall | None = None) -> tuple[Finding, ...]:
    """Findings about a program, as the text it would become; line numbers are that text's."""
    return check_text(emit(program, printer), printer, wall=wall)


def check_text(text: str, printer: Printer, *, wall: Wall | None = None) -> tuple[Finding, ...]:
    """Findings about a G-code text, in the order of its lines; empty where these rules find no fault.

    Where the mould's `wall` is known, the nozzle must keep off it.

    Raises
    ------
    InputError
        A line that cannot be read or followed.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> text = "G28 X Y\\nM83\\nM302 P1\\nG0 Z10 F300\\nG0 X340 Y10 F600\\nG0 Z1.6 F300\\nG3 X340 Y30 I0 J10 E100 F200\\nG0 Z10 F300"
    >>> for finding in check_text(text, load_printer()):
    ...     print(finding)
    >>> for finding in check_text(text.replace("X340", "X345"), load_printer()):
    ...     print(finding)
    line 7: it reaches X355.0000, the bed ends at X350.0000; move the pattern inward or choose a larger printer
    """
    judgement = judge(text, printer, wall=wall)
    if judgement.broken_off:
        raise InputError(judgement.broken_off)
    return judgement.findings


@dataclass(frozen=True)
class Judgement:
    """All that can be said of a text.

    Parameters
    ----------
    findings : tuple of Finding
        Its faults, in the order of its lines.
    notes : tuple of str
        What is no fault but explains some.
    broken_off : str
        Where a line cannot be read or followed: which, and why. The findings are then of what comes before it, without
        those about the file as a whole.
    """

    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    broken_off: str = ""


def judge(
    text: str, printer: Printer, *, mould: Mould | None = None, wall: Wall | None = None, bead_area: float | None = None
) -> Judgement:
    """Everything about a G-code text.

    Parameters
    ----------
    text : str
    printer : Printer
    mould : Mould, optional
        What it is printed in: all ink must lie in it, and the nozzle keep off its wall.
    wall : Wall, optional
        The wall alone.
    bead_area : float, mm^2, optional
        Cross-section that the bead should have; the file's own head comes first, the bundled material last.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> judgement = judge("G28 X Y\\nG0 Z10 F300\\nG0 X400\\nG5 X1", load_printer())
    >>> [finding.what for finding in judgement.findings], judgement.broken_off
    (['it reaches X400.0000, the bed ends at X350.0000'], 'line 4: G5 is not supported; use lines and arcs in the XY plane')
    """
    judged, fault = trace_as_far(text, spindle=printer.spindle, motion=printer.motion)
    laid, area = laid_pieces(judged, printer), meant_area(judged, bead_area)
    wall = mould.wall if mould else wall
    mistaken = tuple(piece_findings(text, mould)) if mould else ()
    if mistaken:
        mould = wall = None  # what is told of another piece's mould would be wrong advice
    findings = [
        *(() if fault else file_findings(judged, printer)),
        *(() if printer.spindle else line_findings(text)),
        *dialect_findings(text, judged, spindle=printer.spindle is not None),
        *judged.faults,
        *(grbl_findings(judged) if printer.spindle else command_findings(judged, printer)),
        *(() if printer.spindle else setting_findings(judged, printer)),
        *wait_findings(judged, printer),
        *height_findings(judged, printer),
        *ink_findings(judged, laid),
        *bead_findings(judged, laid, printer, area),
        *(mould_findings(judged, laid, mould) if mould else ()),
        *mistaken,
        *(wall_findings(judged, wall, printer.nozzle) if wall else ()),
        *balance_findings(judged, printer),
        *blob_findings(judged, printer, area),
    ]
    for move in judged.moves:
        for what, remedy in _faults_of(move, printer):
            findings.append(Finding(move.line, what, remedy, move.pattern))
    return Judgement(tuple(sorted(findings, key=lambda f: f.line)), tuple(notes(judged, printer)), str(fault or ""))


def _faults_of(move: Move, printer: Printer) -> Iterator[tuple[str, str]]:
    yield from _bounds(move, printer)
    if isinstance(move.shape, Curve):
        yield from _arc(move.shape, printer)
    yield from _ink(move, printer)
    yield from _speed(move, printer)


def _bounds(move: Move, printer: Printer) -> Iterator[tuple[str, str]]:
    shape = move.shape
    # A straight move that returns from outside is no second fault.
    low, high = shape.bbox if isinstance(shape, Curve) else (move.end[:2], move.end[:2])
    bed = printer.bed
    if _lies_within(low, high, move.end[2], bed):
        return
    for k, axis in enumerate("XYZ"):
        start, end = (bed.origin[k], bed.origin[k] + bed.size[k]) if k < 2 else (0.0, bed.height)
        least, most = (low[k], high[k]) if k < 2 else (move.end[2], move.end[2])
        remedy = "move the pattern inward or choose a larger printer" if k < 2 else "change the heights in the printer profile"
        name = "bed" if k < 2 else "machine"
        if most is not None and most > end + HALF_XY:
            yield f"it reaches {axis}{most:.4f}, the {name} ends at {axis}{end:.4f}", remedy
        if least is not None and least < start - HALF_XY:
            yield f"it reaches {axis}{least:.4f}, the {name} begins at {axis}{start:.4f}", remedy


def _lies_within(low: Corner, high: Corner, z: float | None, bed: Bed) -> bool:
    """As nearly every move does."""
    if low[0] is None or low[1] is None or high[0] is None or high[1] is None or z is None or not 0 <= z <= bed.height:
        return False
    (x, y), (width, depth) = bed.origin, bed.size
    return x <= low[0] and high[0] <= x + width and y <= low[1] and high[1] <= y + depth


def _arc(shape: Curve, printer: Printer) -> Iterator[tuple[str, str]]:
    if not printer.arcs:
        yield "this printer draws no arcs", "emit with --arcs lines"
    if shape.radius_error > ARC_RADIUS_MM:
        r = shape.radius
        yield (
            f"its end lies {shape.radius_error:.4f} mm off the circle of radius {r:.4f} it starts on, the head would jump there",
            f"move the end or the centre until both radii agree within {ARC_RADIUS_MM} mm",
        )
    if shape.start == shape.end:
        yield "a full circle in one command", "split it into two half circles"


def _ink(move: Move, printer: Printer) -> Iterator[tuple[str, str]]:
    if abs(move.e) > printer.pump.max_e + HALF_E:
        yield (
            f"E{move.e:.5f} is beyond the firmware's {printer.pump.max_e:g} mm a command, the ink is dropped in silence",
            "split the move, or raise max_e and EXTRUDE_MAXLENGTH alike",
        )
    if move.e < 0 and move.is_planar and printer.spindle:
        yield "the pump runs backwards while the head moves, for M4 turns it", "turn it forwards by M3, or stop it by M5 before the move"
    elif move.e < 0 and move.is_planar:
        yield (
            f"E{move.e:.5f} is negative while the head moves: the pump runs backwards",
            "make E positive; reverse the motor in the firmware",
        )
    if move.e > 0 and move.is_planar and move.shape is None:
        yield "it extrudes from an unknown place", "move to the start of the ink with G0 X Y first"


def _speed(move: Move, printer: Printer) -> Iterator[tuple[str, str]]:
    if move.rapid:
        return  # the machine's own speed, and ink on it is a fault already
    if move.speed is None:
        yield "no speed F was given yet", "give F, in mm/min, on the first move"
        return
    motion, pump, shape = printer.motion, printer.pump, move.shape
    if move.is_planar and move.speed > motion.max_speed + HALF_F:
        yield _too_fast(move.speed, motion.max_speed, "the printer in X and Y")
    if not move.is_planar and move.e and abs(move.speed) > pump.max_e_speed + HALF_F:
        yield _too_fast(move.speed, pump.max_e_speed, "the E axis")
    if isinstance(shape, Curve) and move.speed > (limit := math.sqrt(motion.acceleration * shape.radius)) + HALF_F:
        yield _too_fast(move.speed, limit, f"v^2 <= a R at R = {shape.radius:.3f} mm")
    if shape is None or move.e <= 0:
        return
    # E is rounded to its own grid; over a short move that alone changes the flow a little.
    most, least = move.e + 2 * HALF_E, move.e - 2 * HALF_E
    per_second = move.speed / shape.length
    if (rate := least * per_second) > pump.max_e_speed * (1 + HALF_F):
        yield _too_fast(move.speed, move.speed * pump.max_e_speed / rate, "the E axis")
    flow = move.e / pump.e_per_mm3 * per_second
    if least / pump.e_per_mm3 * per_second > pump.flow_max * (1 + HALF_F):
        yield _too_fast(move.speed, move.speed * pump.flow_max / flow, f"a flow of {pump.flow_max:g} mm^3/s (it is {flow:.3f})")
    # A speed is rounded down to its grid, so the least flow has one step of F to spare.
    if most / pump.e_per_mm3 * (move.speed + 2 * HALF_F) / shape.length < pump.flow_min:
        yield (
            f"its flow is {flow:.3f} mm^3/s, the pump is steady from {pump.flow_min:g}",
            f"raise F to {60 * move.speed * pump.flow_min / flow:.0f}" if isinstance(shape, Straight) else "raise F or the arc's radius",
        )


def _too_fast(speed: float, limit: float, why: str) -> tuple[str, str]:
    return f"F{speed * 60:.1f} is above F{limit * 60:.1f}, the limit of {why}", f"lower F to {math.floor(limit * 600) / 10:.1f}"
