"""Ink that is pushed or drawn at standstill: a pattern is primed, retracted by as much, and nothing else is pushed out.

Each stroke must begin with the nozzle as full as the first one found it. Where a file has ``pattern NAME`` comments, each
pattern must besides end as full as it began, and between its strokes too. What is pushed out before the first ink, away
from it, fills the nozzle and is no prime; a file with patterns may do that at the cleaning place alone.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gcode.moves import Finding, Move, Trace
from gcode.printer import Printer
from gcode.program import E_DECIMALS, XY_DECIMALS

#: Half a step of E, twice: that of a prime and that of its retract.
_ROUNDING = 10**-E_DECIMALS

#: The same for a file of anyone's: absolute E with three decimals is usual.
_FOREIGN_ROUNDING = 10**-3


@dataclass(frozen=True)
class Run:
    """Moves without a way in X and Y, from one move in the plane to the next: is that one ink, and the one before them?"""

    moves: tuple[Move, ...]
    leaves: bool
    enters: bool
    is_first: bool  # no ink was laid before

    @property
    def pushed(self) -> float:
        """E in all."""
        return math.fsum(m.e for m in self.moves)


def balance_findings(judged: Trace, printer: Printer) -> Iterator[Finding]:
    """What is wrong with prime and retract.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> from gcode.trace import trace
    >>> start = "M83\\nM302 P1\\nG0 X0 Y0 F600\\nG0 Z1.6\\n"
    >>> print(*balance_findings(trace(start + "G1 E4\\nG1 X9 E36\\nG1 E-4"), load_printer()))
    <BLANKLINE>
    >>> print(*balance_findings(trace(start + "G1 E4\\nG1 X9 E36\\nG1 E4"), load_printer()))
    line 7: E4 is pushed out at standstill where no path follows: it leaves a blob; turn its sign to retract, or take it out
    """
    named = any(m.pattern for m in judged.moves)
    inked = [m for m in judged.moves if m.e > 0 and m.is_planar]
    first, last = {m.pattern: m for m in reversed(inked)}, {m.pattern: m.line for m in inked}
    faulty: set[str] = set()
    standing: dict[str, list[Move]] = {}
    filling = 0  # the line of the last
    for run in runs_of(judged.moves):
        first_filling = run.is_first and not run.enters and run.pushed > 0
        for move in (m for m in run.moves if m.e):
            if found := _misplaced(move, run, last.get(move.pattern, 0), printer):
                faulty.add(move.pattern)
                yield Finding(move.line, *found, move.pattern)
            if first_filling and (not named or is_at_cleaning_place(move, printer)):
                filling = move.line
            else:
                standing.setdefault(move.pattern, []).append(move)
    # One fault at a time: a wrong sign unbalances its pattern, too.
    if named:
        for pattern in dict.fromkeys([*first, *standing]):
            if pattern not in faulty:
                for fault in _of_a_pattern(judged.moves, standing.get(pattern, []), first.get(pattern), printer):
                    faulty.add(pattern)
                    yield fault
    if not faulty:
        # A line drawn before the first pattern to fill the nozzle is no measure for the patterns' strokes.
        moves = [m for m in judged.moves if m.pattern or not named]
        yield from _as_a_whole(moves, [m for m in itertools.chain(*standing.values()) if m.pattern or not named], printer, filling)


def runs_of(moves: Sequence[Move]) -> Iterator[Run]:
    """All standstills of a file, in order."""
    held: list[Move] = []
    before: Move | None = None
    inked = False
    for move in moves:
        if not move.is_planar:
            held.append(move)
            continue
        yield Run(tuple(held), before is not None and before.e > 0, move.e > 0, not inked)
        held, before, inked = [], move, inked or move.e > 0
    yield Run(tuple(held), before is not None and before.e > 0, False, not inked)


def _misplaced(move: Move, run: Run, last_ink: int, printer: Printer) -> tuple[str, str] | None:
    """Ink on a lift, a prime that draws, or ink that is left as a blob; `last_ink` is the line of the pattern's."""
    amount = amount_of(move.e, printer)
    if move.start[2] != move.end[2]:
        where = "the ink is drawn out to a thread" if move.e > 0 else "part of the ink is drawn back only while the nozzle is away from it"
        return f"{amount} on a move in Z: {where}", "push or draw ink at standstill, on a line of its own"
    if move.e < 0 and run.enters and not run.leaves and run.pushed < 0:
        return f"{amount} draws ink back right before the path, where a prime pushes it", "turn its sign, or take it out"
    fills = run.is_first and not move.pattern and move.line <= last_ink
    if move.e > 0 and not run.enters and not fills and not is_at_cleaning_place(move, printer):
        return f"{amount} is pushed out at standstill where no path follows: it leaves a blob", "turn its sign to retract, or take it out"
    return None


def is_at_cleaning_place(move: Move, printer: Printer) -> bool:
    """Does it end where the profile cleans the nozzle?"""
    place, (x, y) = printer.cleaning, printer.bed.origin
    step = 10**-XY_DECIMALS
    here_x, here_y = move.end[:2]
    return (
        place is not None
        and here_x is not None
        and here_y is not None
        and abs(here_x - x - place.x) <= step
        and abs(here_y - y - place.y) <= step
    )


def _of_a_pattern(moves: Sequence[Move], standing: Sequence[Move], first: Move | None, printer: Printer) -> Iterator[Finding]:
    if standing:
        primed, drawn = (math.fsum(abs(m.e) for m in standing if (m.e > 0) == forward) for forward in (True, False))
        if abs(primed - drawn) > _ROUNDING * len(standing):
            yield Finding(standing[-1].line, *_unequal(primed, drawn, printer), standing[-1].pattern)
            return
        own = [m for m in moves if m.pattern == standing[0].pattern]
        if fault := _stroke_by_stroke(own, standing, printer):
            yield fault
        else:
            yield from _as_a_whole(own, standing, printer)
    elif first and first.pattern and printer.pump.prime:
        usual = amount_of(printer.pump.prime * printer.pump.e_per_mm3, printer)
        remedy = (
            f"prime {usual} before it and retract as much after it, or say prime = 0 and retract = 0 under [pump] in the printer profile"
        )
        yield Finding(first.line, "its path is neither primed nor retracted", remedy, first.pattern)


def _stroke_by_stroke(moves: Sequence[Move], standing: Sequence[Move], printer: Printer) -> Finding | None:
    """Where a pattern draws ink back between two of its strokes, it must draw back all that it primed."""
    lines = {m.line for m in standing}
    last_ink = max((m.line for m in moves if m.e > 0 and m.is_planar), default=0)
    primed = drawn = 0.0
    last: Move | None = None  # that drew
    count = 0
    for move in moves:
        if move.line in lines and move.e < 0:
            drawn, last, count = drawn - move.e, move, count + 1
        elif move.e > 0 and (move.line in lines or move.is_planar):
            if last and last.line < last_ink and abs(primed - drawn) > _ROUNDING * count:
                return Finding(last.line, *_unequal(primed, drawn, printer), last.pattern)
            if last:
                primed, drawn, last, count = 0.0, 0.0, None, 0
            if move.line in lines:
                primed, count = primed + move.e, count + 1
    return None


def _unequal(primed: float, drawn: float, printer: Printer) -> tuple[str, str]:
    push, draw = amount_of(primed, printer), amount_of(drawn, printer)
    if not drawn:
        return f"it primes {push} and does not retract: the nozzle drips", "retract as much after the path"
    if not primed:
        return f"it retracts {draw} and does not prime: its path begins without ink", "prime as much before the path"
    return f"it primes {push} and retracts {draw}: it must end with as much ink as it began", "make both the same"


def _as_a_whole(moves: Sequence[Move], standing: Sequence[Move], printer: Printer, filling: int = 0) -> Iterator[Finding]:
    """Each stroke must start with the nozzle as full as the first one found it, and so must the next file.

    `filling` is the line that filled the nozzle before the first ink, or 0.
    """
    lines = {m.line for m in standing}
    remedy = "prime as much before each stroke as is retracted after it"
    balance, count, laid = 0.0, 0, False
    at_first: float | None = None
    last: Move | None = None
    for move in moves:
        if move.line in lines:
            balance, last, count, laid = balance + move.e, move, count + 1, False
        elif move.e > 0 and move.is_planar and not laid:
            laid = True
            at_first = balance if at_first is None else at_first
            if last and abs(balance - at_first) > _FOREIGN_ROUNDING * count:
                amount, change = amount_of(abs(balance - at_first), printer), "more" if balance > at_first else "less"
                yield Finding(last.line, f"the nozzle then holds {amount} {change} than at the first stroke's start", remedy, last.pattern)
                return
    if at_first is None or not last or abs(balance) <= _FOREIGN_ROUNDING * count:
        return
    amount, change = amount_of(abs(balance), printer), "more" if balance > 0 else "less"
    if filling and balance < 0 and at_first == 0:
        held = f"the nozzle then holds {amount} less at the end than at the first stroke's start"
        what = f"{held}: what line {filling} pushes, away from the path, fills the nozzle and is no prime"
        yield Finding(last.line, what, "push it where the stroke begins, after the way there", last.pattern)
    else:
        what = f"the nozzle then holds {amount} {change} at the end than before the first prime"
        yield Finding(last.line, what, remedy, last.pattern)


def amount_of(e: float, printer: Printer) -> str:
    """As the file says it: E, or what the spindle pumps."""
    return f"{e:.5g} mm^3" if printer.spindle else f"E{e:.6g}"
