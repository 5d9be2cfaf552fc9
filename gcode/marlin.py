"""Text for Marlin, written so that nothing in it depends on what the printer did before."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from gcode.geometry import Curve
from gcode.printer import Printer
from gcode.program import (
    E_DECIMALS,
    F_DECIMALS,
    XY_DECIMALS,
    Clean,
    Comment,
    Dwell,
    Extrude,
    Prime,
    Program,
    Retract,
    Step,
    Travel,
    quantised,
)
from skinfab import __version__

Arcs = Literal["native", "lines"]

#: First line of every file; `parse` reads the facts behind it.
TITLE = "; skinfab print program, version 1"
BEGIN, END = "; begin", "; end"

#: G90 also makes E absolute, so M83 comes after it; M302 since there is no heater; the others undo what was left set.
PREAMBLE = (
    "G21 ; millimetres",
    "G90 ; absolute places",
    "M83 ; relative ink, after the line above, which sets it absolute",
    "M302 P1 ; extrude cold",
    "M220 S100 ; speed as written",
    "M221 S100 ; flow as written",
    "M900 K0 ; no linear advance",
)

HOMING = {
    "xyz": (
        (
            "; home xyz: Z too. Home before the mould lies on the bed: a probe would dip into wet silicone.",
            "; Z is counted from the floor of the cavity: give the firmware that floor's height (M206 Z).",
        ),
        ("G28",),
    ),
    "xy": (
        (
            "; home xy: Z is left alone, for a probe at bed centre would dip into the wet mould.",
            "; Z is counted from the floor of the cavity: before the start, with the nozzle on the glass,",
            "; send G92 Z-(thickness of the mould's floor); the report says how much.",
        ),
        ("G28 X Y",),
    ),
    "none": (("; home none: before the start set X, Y and Z by hand; the places below are the machine's.",), ()),
}


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
    >>> steps = (Travel(x=0.0, y=0.0, speed=50.0), Extrude(Straight((0.0, 0.0), (10.0, 0.0)), 4.84, 4.0))
    >>> emit(Program("P1", steps), load_printer()).splitlines()[-2]
    'G1 X10.0000 Y0.0000 E40.00000 F240.0'
    """
    e_per_mm3 = printer.pump.e_per_mm3
    if arcs == "lines":
        program = with_chords(program, tolerance=printer.process.chord_tolerance)
    program = quantised(program, e_per_mm3=e_per_mm3)
    reasons, home = HOMING[printer.home]
    header = [
        TITLE,
        f"; piece {program.name}",
        *emit_comment(f"printer {printer.name}"),
        f"; ink {e_per_mm3!r} mm of E for 1 mm^3",
        *([] if program.bead_area is None else [f"; bead {program.bead_area!r} mm^2 in cross-section"]),
        *emit_comment(f"made by skinfab {__version__}"),
        *reasons,
        *PREAMBLE,
        *home,
        BEGIN,
    ]
    return "\n".join([*header, *_Writer(e_per_mm3).lines(program), END]) + "\n"


def emit_comment(text: str) -> list[str]:
    """A comment line, cut to what a line may hold."""
    return [f"; {step.text}" for step in quantised(Program("", (Comment(text),)), e_per_mm3=1.0).steps if isinstance(step, Comment)]


def with_chords(program: Program, *, tolerance: float) -> Program:
    """The program with every arc as chords that leave it by at most `tolerance` mm; the ink stays the same."""
    steps: list[Step] = []
    for step in program.steps:
        if isinstance(step, Extrude) and isinstance(step.shape, Curve):
            chords = step.shape.chords(tolerance)
            steps += [Extrude(chord, step.volume / len(chords), step.speed) for chord in chords]
        else:
            steps.append(step)
    return replace(program, steps=tuple(steps))


class _Writer:
    """Writes steps; F is sticky, so it is written only where it changes."""

    def __init__(self, e_per_mm3: float) -> None:
        self.e_per_mm3 = e_per_mm3
        self.feed = ""

    def lines(self, program: Program) -> list[str]:
        return [self._line(step) for step in program.steps]

    def _line(self, step: Step) -> str:
        if isinstance(step, Travel):
            words = [f"{axis}{v:.{XY_DECIMALS}f}" for axis, v in zip("XYZ", (step.x, step.y, step.z), strict=True) if v is not None]
            return " ".join(["G0", *words, *self._feed(step.speed)])
        if isinstance(step, Extrude):
            return self._extrude(step)
        if isinstance(step, (Prime, Retract)):
            sign = "-" if isinstance(step, Retract) else ""
            return " ".join(["G1", f"E{sign}{step.volume * self.e_per_mm3:.{E_DECIMALS}f}", *self._feed(step.rate * self.e_per_mm3)])
        if isinstance(step, Dwell):
            return f"G4 P{step.seconds * 1000:.0f}"
        if isinstance(step, Clean):
            return f"G4 P{step.seconds * 1000:.0f} ; clean"
        return f"; {step.text}"

    def _extrude(self, step: Extrude) -> str:
        shape = step.shape
        code, words = "G1", [f"X{shape.end[0]:.{XY_DECIMALS}f}", f"Y{shape.end[1]:.{XY_DECIMALS}f}"]
        if isinstance(shape, Curve):
            code = "G2" if shape.clockwise else "G3"
            # Offsets from the arc's start, of numbers that are rounded already.
            words += [f"{axis}{shape.centre[k] - shape.start[k]:.{XY_DECIMALS}f}" for k, axis in enumerate("IJ")]
        return " ".join([code, *words, f"E{step.volume * self.e_per_mm3:.{E_DECIMALS}f}", *self._feed(step.speed)])

    def _feed(self, speed: float) -> list[str]:
        feed = f"F{speed * 60:.{F_DECIMALS}f}"
        changed = feed != self.feed
        self.feed = feed
        return [feed] if changed else []
