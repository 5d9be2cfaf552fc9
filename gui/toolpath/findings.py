"""What a check has found, as lines of the problems list: one for each kind of fault. Knows no widget."""

from __future__ import annotations

from gcode.check import Judgement
from gcode.moves import Finding
from gcode.piece import PieceProgram
from gui.state.problem import Problem
from gui.state.selection import Target

SOURCE = "toolpath check"


def problems_of(program: PieceProgram, judgement: Judgement) -> list[Problem]:
    """The first fault of each kind with how many more there are, then notes; one note where there is nothing to find."""
    piece = program.program.name
    kinds: dict[str, list[Finding]] = {}
    for finding in judgement.findings:
        kinds.setdefault(finding.kind, []).append(finding)
    found = []
    for alike in kinds.values():
        more = len({f.line for f in alike}) - 1
        words = f"G-code of {piece}, {alike[0]}" + (f" (and {more} more line{'s' * (more > 1)} like it)" if more else "")
        found.append(Problem(words, SOURCE, target=Target(piece=piece, sensor=alike[0].pattern)))
    if judgement.broken_off:
        found.append(Problem(f"G-code of {piece}: {judgement.broken_off}", SOURCE))
    if not found:
        found.append(Problem(f"G-code of {piece}: no fault found on {program.printer.name}, in its mould", SOURCE, kind="note"))
    return found + [Problem(f"G-code of {piece}: {note}", SOURCE, kind="note") for note in judgement.notes]
