"""A program as G-code text in its printer's dialect; `parse` turns the text back into the same program."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from gcode import grbl, marlin
from gcode.geometry import Curve
from gcode.grbl import GrblWriter, SpindleGrid
from gcode.marlin import MarlinWriter
from gcode.printer import Printer
from gcode.program import Comment, Extrude, Program, Step, quantised, snapped
from skinfab import __version__

Arcs = Literal["native", "lines"]

#: First line of every file; `parse` reads the facts behind it.
TITLE = "; skinfab print program, version 1"
BEGIN, END = "; begin", "; end"


def emit(program: Program, printer: Printer, *, arcs: Arcs = "native") -> str:
    """The program as G-code text.

    Parameters
    ----------
    program : Program
        Quantised here if it is not yet; a quantised program comes back identical from `parse`.
    printer : Printer
    arcs : "native" or "lines"
        G2 and G3, or chords within the profile's ``process.chord_tolerance``.

    Returns
    -------
    str
        The same program, printer and version of skinfab always give the same bytes: there is no date in it.

    Examples
    --------
    >>> from gcode.geometry import Straight
    >>> from gcode.printer import load_printer
    >>> from gcode.program import Travel
    >>> steps = (Travel(x=0.0, y=0.0, speed=50.0), Extrude(Straight((0.0, 0.0), (10.0, 0.0)), 4.84, 4.0))
    >>> emit(Program("P1", steps), load_printer()).splitlines()[-2]
    'G1 X10.0000 Y0.0000 E40.00000 F240.0'
    """
    if arcs == "lines":
        program = with_chords(program, tolerance=printer.process.chord_tolerance)
    program = on_grid_of(program, printer)
    ending = grbl.ENDING if printer.spindle else ()
    body = (line for lines in _writer(printer).by_step(program) for line in lines)
    return "\n".join([*_header(program, printer), *body, END, *ending]) + "\n"


def step_lines(program: Program, printer: Printer) -> NDArray[np.int64]:
    """The first and the last line, counted from 1, that each step of a program has in the text that `emit` makes of it.

    Parameters
    ----------
    program : Program
        On the grid already (`on_grid_of`), so that its steps are those of the text.

    Returns
    -------
    (n, 2) int
    """
    counts = [len(lines) for lines in _writer(printer).by_step(program)]
    last = len(_header(program, printer)) + np.cumsum(np.array(counts, dtype=np.int64))
    return np.stack([last - counts + 1, last], axis=1)


def _writer(printer: Printer) -> GrblWriter | MarlinWriter:
    return GrblWriter(printer.spindle) if printer.spindle else MarlinWriter(printer.pump.e_per_mm3)


def _header(program: Program, printer: Printer) -> list[str]:
    """All lines before the first step's."""
    spindle = printer.spindle
    unit = f"S{spindle.s_per_flow!r} for 1 mm^3/s" if spindle else f"{printer.pump.e_per_mm3!r} mm of E for 1 mm^3"
    reasons, preamble, home = _beginning(printer)
    return [
        TITLE,
        f"; piece {program.name}",
        *emit_comment(f"printer {printer.name}"),
        f"; ink {unit}",
        *([] if program.bead_area is None else [f"; bead {program.bead_area!r} mm^2 in cross-section"]),
        *emit_comment(f"made by skinfab {__version__}"),
        *reasons,
        *preamble,
        *home,
        BEGIN,
    ]


def on_grid_of(program: Program, printer: Printer) -> Program:
    """The program as this printer's file can say it; doing it twice changes nothing more."""
    if printer.spindle:
        return snapped(program, SpindleGrid(printer.spindle, program))
    return quantised(program, e_per_mm3=printer.pump.e_per_mm3)


def _beginning(printer: Printer) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """What the person should know, the modes, and the homing."""
    if printer.spindle:
        return grbl.REASONS, grbl.PREAMBLE, ()
    reasons, home = marlin.HOMING[printer.home]
    return reasons, marlin.PREAMBLE, home


def emit_comment(text: str) -> list[str]:
    """A comment line, cut to what a line may hold."""
    return [f"; {step.text}" for step in quantised(Program("", (Comment(text),)), e_per_mm3=1.0).steps if isinstance(step, Comment)]


def with_chords(program: Program, *, tolerance: float) -> Program:
    """The program with every arc as chords that leave it by at most `tolerance` mm; the ink stays the same, and so does its flow."""
    steps: list[Step] = []
    for step in program.steps:
        if isinstance(step, Extrude) and isinstance(step.shape, Curve):
            chords = step.shape.chords(tolerance)
            # Chords are shorter than their arc: as fast as along it, a head at the flow's limit would be beyond it.
            total = math.fsum(chord.length for chord in chords)
            speed = step.speed * (total / step.shape.length)
            steps += [Extrude(chord, step.volume * (chord.length / total), speed) for chord in chords]
        else:
            steps.append(step)
    return replace(program, steps=tuple(steps))
