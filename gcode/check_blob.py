"""Ink that is pushed at standstill in one place: more than a bead bears is a blob, whatever is drawn back after it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcode.check_balance import Run, amount_of, is_at_cleaning_place, runs_of
from gcode.check_bead import TIMES
from gcode.moves import Finding, Trace
from gcode.printer import Printer

#: E of a file of anyone's is rounded, by far less than this share of what is judged here.
_ROUNDING = 1e-3


def blob_findings(judged: Trace, printer: Printer, area: float) -> Iterator[Finding]:
    """Standstills before a path, or at the cleaning place, that push too much; `area` (mm^2) is the cross-section of the bead meant.

    The most is `TIMES` what the profile primes, as a bead may be so many times too thick; where it primes less than a ball as
    wide as the bead, `TIMES` that ball, which is 1.44 times as wide as the bead. At the cleaning place it is also `TIMES`
    its ``initial_extrude``. What fills the nozzle elsewhere, away from the path and before the first ink, is not judged:
    how much a nozzle and its hose take no profile says.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> text = "M83\\nM302 P1\\nG0 X0 Y0 F600\\nG0 Z1.6\\nG1 E{0}\\nG1 X9 E36\\nG1 E-{0}"
    >>> print(*blob_findings(trace(text.format(1.65289)), load_printer(), 0.484))
    <BLANKLINE>
    >>> print(*blob_findings(trace(text.format(165)), load_printer(), 0.484))
    line 5: E165 is pushed out at standstill in one place, where E6.28012 is the most: it leaves a blob; prime E1.65289 as the \
printer profile does
    """
    ball = 4 / 3 * math.pi * (area / math.pi) ** 1.5
    usual, scale = printer.pump.prime, printer.pump.e_per_mm3
    for run in runs_of(judged.moves):
        most = TIMES * max(usual, ball)
        if any(m.e > 0 and is_at_cleaning_place(m, printer) for m in run.moves) and printer.cleaning:
            most, right = max(most, TIMES * printer.cleaning.initial_extrude), printer.cleaning.initial_extrude
        elif run.enters:
            right = usual
        else:
            continue
        if fault := _blob(run, most * scale, right * scale, printer):
            yield fault


def _blob(run: Run, most: float, right: float, printer: Printer) -> Finding | None:
    """Where what a standstill has pushed, less what it has drawn, is first more than `most` (E)."""
    pushed = 0.0
    greatest, last = 0.0, None
    for move in run.moves:
        pushed += move.e
        if pushed > max(greatest, most * (1 + _ROUNDING)):
            greatest, last = pushed, move
    if last is None:
        return None
    amount, limit = amount_of(greatest, printer), amount_of(most, printer)
    what = f"{amount} is pushed out at standstill in one place, where {limit} is the most: it leaves a blob"
    if printer.spindle:
        remedy = f"push {amount_of(right, printer)} as the printer profile does; P of G4 is seconds"
    else:
        remedy = f"prime {amount_of(right, printer)} as the printer profile does"
    return Finding(last.line, what, remedy, last.pattern)
