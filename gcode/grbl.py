"""The dialect of GRBL 1.1, which knows three axes and no E: the pump is its spindle.

M3 runs the pump forward, M4 backward (the wire that turns a spindle the other way), M5 stops it; S is its rate,
so many units for each mm^3/s. The ink of a move is therefore its rate times the time the move takes, and a step says
its volume by S and F. What follows from GRBL:

* G0 takes no speed, so every move is G1; one with the pump at rest is a travel.
* A change of S waits until the head has stopped, and the pump runs on while the head speeds up and slows down: a bead
  is a little thicker within v / a of a stop (0.01 s at 5 mm/s and 500 mm/s^2). S therefore stays one number as long
  as the bead does, and F gives way by what that number is off: see `SpindleGrid`.
* Homing is ``$H``, which is no G-code and homes Z too: it is done before, by hand.
* Spindle mode, not laser mode ($32=0): in laser mode M4 would be forward, by the speed of the head.
"""

from __future__ import annotations

from dataclasses import replace

from gcode.geometry import Curve, Shape
from gcode.printer import Spindle
from gcode.program import CLEAN, XY_DECIMALS, Clean, Dwell, Extrude, InkGrid, Prime, Program, Retract, Step, Travel, speed_on_grid
from skinfab.tolerances import SPINDLE_FRACTION

#: Digits of the greatest S, and decimals of F: GRBL reads eight digits of a number into a float of 32 bits, which holds seven.
S_DIGITS, F_DECIMALS = 7, 3

REASONS = (
    "; GRBL: $32=0 (spindle mode) and $30 as the profile's s_max;",
    "; the spindle's output drives the pump, M4 turns it back.",
    "; home with $H before the mould lies on the bed; then G10 L20 P1 sets X, Y at the bed's corner",
    "; and Z over the glass, as the report says.",
    "; Nothing here moves Z to find a zero in the wet mould.",
)

PREAMBLE = (
    "G21 ; millimetres",
    "G90 ; absolute places",
    "G17 ; arcs in XY",
    "G94 ; speeds in mm/min",
    "M5 ; pump at rest",
)

ENDING = ("M2",)


class SpindleGrid(InkGrid):
    """Ink as S times time, with few different S.

    Of all rates a program asks for, those within ``tolerances.SPINDLE_FRACTION`` above the lowest are run at that
    lowest, and so on upward; where S gives way F does by the same share, down and never up, so that the ink per mm
    stays what it was. A program on this grid has each rate apart by more than that, and stays as it is.
    """

    def __init__(self, spindle: Spindle, program: Program) -> None:
        super().__init__(1.0)
        self.spindle = spindle
        rates = sorted({spindle_s(step, spindle) for step in program.steps if isinstance(step, Extrude)})
        self.rate: dict[float, float] = {}  # S of the file for S as asked for
        lowest = 0.0
        for s in rates:
            lowest = s if s > lowest * (1 + SPINDLE_FRACTION) else lowest
            self.rate[s] = lowest

    def standing(self, step: Prime | Retract) -> list[Step]:
        """Ink moved at standstill, in whole ms."""
        rate = s_on_grid(step.rate, self.spindle) / self.spindle.s_per_flow
        seconds = round(step.volume / rate * 1000) / 1000
        return [replace(step, volume=rate * seconds, rate=rate)] if seconds else []

    def laid(self, step: Extrude, shape: Shape) -> Extrude:
        """A rounded shape of a step; nothing is carried on, for the ink per mm is that of the step, whatever its length became."""
        self.owed = 0.0
        asked = spindle_s(step, self.spindle)
        s = self.rate[asked]
        speed = speed_on_grid(step.speed * (s / asked), decimals=F_DECIMALS)
        return Extrude(shape, volume_along(shape, s / self.spindle.s_per_flow, speed), speed)


def s_on_grid(flow: float, spindle: Spindle) -> float:
    """S for a flow, mm^3/s, as it will be read back; never 0, which would read as a travel."""
    decimals = _s_decimals(spindle)
    return max(round(flow * spindle.s_per_flow, decimals), 10.0**-decimals)


def spindle_s(step: Extrude, spindle: Spindle) -> float:
    """S that a step needs at its speed."""
    return s_on_grid(step.volume * step.speed / step.shape.length, spindle)


def _s_decimals(spindle: Spindle) -> int:
    return max(S_DIGITS - len(str(int(spindle.s_max))), 0)


def volume_along(shape: Shape, flow: float, speed: float) -> float:
    """What a steady `flow`, mm^3/s, lays along a shape, mm^3."""
    return flow * (shape.length / speed)


class GrblWriter:
    """Writes steps; F and S are sticky, so each is written only where it changes."""

    def __init__(self, spindle: Spindle) -> None:
        self.spindle = spindle
        self.feed = ""
        self.pump = "M5"

    def by_step(self, program: Program) -> list[list[str]]:
        """The lines of each step, the pump at rest at the end."""
        lines = [self._lines(step) for step in program.steps]
        lines[-1:] = [last + self._turn("M5") for last in lines[-1:]]
        return lines

    def _lines(self, step: Step) -> list[str]:
        if isinstance(step, Travel):
            words = [f"{axis}{v:.{XY_DECIMALS}f}" for axis, v in zip("XYZ", (step.x, step.y, step.z), strict=True) if v is not None]
            return [*self._turn("M5"), " ".join(["G1", *words, *self._feed(step.speed)])]
        if isinstance(step, Extrude):
            return [*self._turn(f"M3 {self._rate(step.volume * step.speed / step.shape.length)}"), self._drawn(step)]
        if isinstance(step, (Prime, Retract)):
            code = "M3" if isinstance(step, Prime) else "M4"
            dwell = f"G4 P{step.volume / step.rate:.3f}"
            self.pump = "M5"
            return [f"{code} {self._rate(step.rate)}", dwell, "M5"]
        if isinstance(step, (Dwell, Clean)):
            note = f" ; {CLEAN}" if isinstance(step, Clean) else ""
            return [*self._turn("M5"), f"G4 P{step.seconds:.3f}{note}"]
        return [f"; {step.text}"]

    def _drawn(self, step: Extrude) -> str:
        shape = step.shape
        code, words = "G1", [f"X{shape.end[0]:.{XY_DECIMALS}f}", f"Y{shape.end[1]:.{XY_DECIMALS}f}"]
        if isinstance(shape, Curve):
            code = "G2" if shape.clockwise else "G3"
            words += [f"{axis}{shape.centre[k] - shape.start[k]:.{XY_DECIMALS}f}" for k, axis in enumerate("IJ")]
        return " ".join([code, *words, *self._feed(step.speed)])

    def _rate(self, flow: float) -> str:
        return f"S{s_on_grid(flow, self.spindle):.{_s_decimals(self.spindle)}f}"

    def _turn(self, pump: str) -> list[str]:
        changed = pump != self.pump
        self.pump = pump
        return [pump] if changed else []

    def _feed(self, speed: float) -> list[str]:
        feed = f"F{speed * 60:.{F_DECIMALS}f}"
        changed = feed != self.feed
        self.feed = feed
        return [feed] if changed else []
