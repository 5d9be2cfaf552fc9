"""Ink far thicker or thinner than the bead that was meant: an extrusion factor mistaken, or a file for another process."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from gcode.check_ink import Pieces
from gcode.moves import Finding, Trace
from gcode.printer import Printer
from skinfab.material import load_material

#: Cross-sections beyond a third or three times of what was meant are faults: an ink spreads by itself, but not so far.
TIMES = 3.0

#: Ink is looked at by so many mm, for a single short move bears what rounding left of its neighbours'.
_BY_MM = 1.0

_HEAD = re.compile(r"bead (\d[\d.e-]*) mm\^2 in cross-section$")


def meant_area(judged: Trace, material_area: float | None = None) -> float:
    """The bead's cross-section, mm^2: as the file's own head says, or else `material_area`, or the bundled material's."""
    for command in judged.commands:
        if command.code:
            break
        if (found := _HEAD.match(command.comment)) and 0 < (area := float(found[1])) < math.inf:
            return area
    return load_material().ink.bead_area_mm2 if material_area is None else material_area


def bead_findings(judged: Trace, pieces: Pieces, printer: Printer, area: float) -> Iterator[Finding]:
    """Ink whose cross-section is more than `TIMES` off `area` (mm^2), one finding for each of its moves.

    Examples
    --------
    >>> from gcode.check_ink import laid_pieces
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> judged, printer = trace("M83\\nM302 P1\\nG0 X0 Y0 Z1.6 F300\\nG1 X20 E0.66"), load_printer()
    >>> print(*bead_findings(judged, laid_pieces(judged, printer), printer, 0.484))
    line 4: its bead is 0.00399 mm^2 in cross-section over 20 mm, 0.0083 of the 0.484 meant; lay 4 mm of E per mm, or give the file's \
own printer
    """
    inked = np.flatnonzero(pieces.radius > 0)
    if not len(inked):
        return
    stroke, part = pieces.stroke[inked], np.floor(pieces.begin[inked] / _BY_MM)
    first = np.flatnonzero(np.concatenate([[True], (np.diff(stroke) != 0) | (np.diff(part) != 0)]))
    last = np.append(first[1:], len(inked))  # the one behind
    lengths = pieces.end[inked] - pieces.begin[inked]
    length = np.add.reduceat(lengths, first)
    ink = np.add.reduceat(lengths * math.pi * pieces.radius[inked] ** 2, first)
    areas = ink / length
    # A part cut short by the stroke's end is judged only if it is all there is of it.
    whole = (length >= _BY_MM / 10) | (np.bincount(stroke)[stroke[first]] == last - first)
    faulty = np.flatnonzero(whole & ((areas > TIMES * area) | (areas < area / TIMES)))
    # A part is told at whatever of it brings most ink too much or too little.
    excess = np.abs(math.pi * pieces.radius[inked] ** 2 - area) * lengths
    most = np.lexsort((excess, np.repeat(np.arange(len(first)), last - first)))[last - 1]
    moves = pieces.move[inked[most[faulty]]]
    _, once = np.unique(moves, return_index=True)
    per_mm = f"lay {area * printer.pump.e_per_mm3:.3g} mm of E per mm" if printer.spindle is None else "change S, or F against it"
    for k in once:
        move, found, over = judged.moves[moves[k]], areas[faulty[k]], length[faulty[k]]
        yield Finding(
            move.line,
            f"its bead is {found:.3g} mm^2 in cross-section over {over:.2g} mm, {found / area:.2g} of the {area:.3g} meant",
            f"{per_mm}, or give the file's own printer",
            move.pattern,
        )
