"""The dialect of Marlin: what comes before a program, so that nothing depends on what was done before, and how each step is said."""

from __future__ import annotations

from gcode.geometry import Curve
from gcode.program import CLEAN, E_DECIMALS, F_DECIMALS, XY_DECIMALS, Clean, Dwell, Extrude, Prime, Program, Retract, Step, Travel

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


class MarlinWriter:
    """Writes steps; F is sticky, so it is written only where it changes."""

    def __init__(self, e_per_mm3: float) -> None:
        self.e_per_mm3 = e_per_mm3
        self.feed = ""

    def by_step(self, program: Program) -> list[list[str]]:
        """The lines of each step."""
        return [[self._line(step)] for step in program.steps]

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
            return f"G4 P{step.seconds * 1000:.0f} ; {CLEAN}"
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
