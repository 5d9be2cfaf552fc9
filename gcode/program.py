"""A print as a neutral list of steps: no firmware, no text, only mm, mm^3, mm/s, mm^3/s and s.

`quantised` is the one place where numbers meet the grid of the text (0.0001 mm, 0.00001 mm of E,
0.1 mm/min, 1 ms). A program that went through it survives emit and parse unchanged, bit by bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeAlias

from gcode.geometry import Curve, Point, Shape, Straight
from skinfab.errors import InputError
from skinfab.tolerances import GRID_FLOW_FRACTION, JOIN_MM, SHORT_ARC_MM

#: Decimals of the emitted words.
XY_DECIMALS, E_DECIMALS, F_DECIMALS = 4, 5, 1

#: Longest comment, so that "; " and the text stay under Marlin's 96 bytes a line.
COMMENT_BYTES = 80


@dataclass(frozen=True)
class Travel:
    """Move without ink; an axis that is None keeps its place."""

    x: float | None = None
    y: float | None = None
    z: float | None = None
    speed: float = 0.0  # mm/s


@dataclass(frozen=True)
class Extrude:
    """Lay `volume` mm^3 of ink along one line or arc, at the height the head is at."""

    shape: Shape
    volume: float
    speed: float  # mm/s along the shape


@dataclass(frozen=True)
class Prime:
    """Push `volume` mm^3 at standstill."""

    volume: float
    rate: float  # mm^3/s


@dataclass(frozen=True)
class Retract:
    """Draw `volume` mm^3 back at standstill."""

    volume: float
    rate: float  # mm^3/s


@dataclass(frozen=True)
class Dwell:
    """Stand still."""

    seconds: float


@dataclass(frozen=True)
class Clean:
    """Stand at the cleaning place while the nozzle is wiped."""

    seconds: float


#: The comment before ink that is laid beyond a path's end; the next comment ends it.
PRINT_OVERRUN = "print-overrun"

#: The comment behind the wait at the cleaning place.
CLEAN = "clean"


@dataclass(frozen=True)
class Comment:
    """A line for the person who reads the file. ``pattern C1`` opens the pattern of that name, see `PRINT_OVERRUN` too."""

    text: str


Step: TypeAlias = Travel | Extrude | Prime | Retract | Dwell | Clean | Comment


@dataclass(frozen=True)
class Program:
    """Steps in the order they are done, in machine coordinates.

    Parameters
    ----------
    name : str
        The piece it prints.
    steps : tuple of steps
    bead_area : float, mm^2, optional
        Cross-section of the bead it was planned for, named in the file's header.

    Raises
    ------
    InputError
        A number that is not finite or has the wrong sign, or an extrusion that does not start where the head is.

    Examples
    --------
    >>> line = Extrude(Straight((0.0, 0.0), (10.0, 0.0)), volume=4.84, speed=4.0)
    >>> Program("P1", (Travel(x=0.0, y=0.0, speed=50.0), line)).ink
    4.84
    """

    name: str
    steps: tuple[Step, ...]
    bead_area: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "steps", tuple(self.steps))
        if self.bead_area is not None and not 0 < self.bead_area < math.inf:
            raise InputError(f"the bead of program {self.name} is {self.bead_area} mm^2; it must be positive")
        x: float | None = None
        y: float | None = None
        for k, step in enumerate(self.steps):
            if fault := _fault(step):
                raise InputError(f"step {k} ({type(step).__name__}) of program {self.name}: {fault}")
            if isinstance(step, Travel):
                x, y = (x if step.x is None else step.x), (y if step.y is None else step.y)
            elif isinstance(step, Extrude):
                if x is None or y is None or math.dist((x, y), step.shape.start) > JOIN_MM:
                    at = "an unknown place" if x is None or y is None else f"({x:.4f}, {y:.4f})"
                    raise InputError(
                        f"step {k} (Extrude) of program {self.name} starts at {step.shape.start}, the head is at {at}; travel there first"
                    )
                x, y = step.shape.end

    @property
    def ink(self) -> float:
        """Ink laid along paths, mm^3 (prime and retract, which cancel, left out)."""
        return math.fsum(s.volume for s in self.steps if isinstance(s, Extrude))


def _fault(step: Step) -> str | None:
    if isinstance(step, Comment):
        return None
    if isinstance(step, (Dwell, Clean)):
        return None if 0 <= step.seconds < math.inf else f"its time is {step.seconds} s; it must be zero or more"
    if isinstance(step, Travel):
        if not all(math.isfinite(v) for v in (step.x, step.y, step.z) if v is not None):
            return "a coordinate is not finite"
        return None if 0 < step.speed < math.inf else f"its speed is {step.speed} mm/s; it must be positive"
    if not 0 <= step.volume < math.inf:
        return f"its volume is {step.volume} mm^3; it must be zero or more"
    speed = step.speed if isinstance(step, Extrude) else step.rate
    if not 0 < speed < math.inf:
        return f"its speed is {speed}; it must be positive"
    if isinstance(step, Extrude) and not all(map(math.isfinite, (*step.shape.start, *step.shape.end, *getattr(step.shape, "centre", ())))):
        return "a coordinate is not finite"
    return None


def quantised(program: Program, *, e_per_mm3: float) -> Program:
    """The same program on the grid of the emitted text; quantising twice changes nothing more.

    Coordinates are rounded one by one and each extrusion starts exactly where the one before it ended,
    arcs beyond a half turn are split, arcs too short for the grid become lines, and what rounding leaves
    over of the ink is carried into the next extrusion, so that the total never drifts.

    Parameters
    ----------
    program : Program
    e_per_mm3 : float
        The printer's E axis, mm per mm^3 of ink.
    """
    return snapped(program, InkGrid(e_per_mm3))


def snapped(program: Program, grid: InkGrid) -> Program:
    """The program on another grid of ink than that of an E axis, see `quantised`."""
    return replace(program, name=_plain(program.name), steps=tuple(done for step in program.steps for done in grid.place(step)))


class InkGrid:
    """Carries the head's rounded place and the ink that is still owed from step to step."""

    def __init__(self, e_per_mm3: float) -> None:
        self.e_per_mm3 = e_per_mm3
        self.at: tuple[float | None, float | None] = (None, None)
        self.owed = 0.0  # mm of E

    def place(self, step: Step) -> list[Step]:
        if isinstance(step, Travel):
            x, y, z = (None if v is None else on_grid(v) for v in (step.x, step.y, step.z))
            self.at = (self.at[0] if x is None else x, self.at[1] if y is None else y)
            return [] if x is y is z is None else [Travel(x, y, z, speed_on_grid(step.speed))]
        if isinstance(step, Extrude):
            return self._extrude(step)
        if isinstance(step, (Prime, Retract)):
            return self.standing(step)
        if isinstance(step, (Dwell, Clean)):
            return [replace(step, seconds=round(step.seconds * 1000) / 1000)]
        return [Comment(_plain(step.text))]

    def standing(self, step: Prime | Retract) -> list[Step]:
        """Ink moved at standstill."""
        e = round(step.volume * self.e_per_mm3, E_DECIMALS)
        rate = speed_on_grid(step.rate * self.e_per_mm3) / self.e_per_mm3
        return [replace(step, volume=e / self.e_per_mm3, rate=rate)] if e else []

    def laid(self, step: Extrude, shape: Shape) -> Extrude:
        """A rounded shape of a step, with what is owed of ink."""
        speed = speed_on_grid(step.speed * self._slowing(step.volume / step.shape.length, shape))
        e = max(round(self.owed, E_DECIMALS), 0.0)
        self.owed -= e
        return Extrude(shape, e / self.e_per_mm3, speed)

    def _extrude(self, step: Extrude) -> list[Step]:
        done: list[Step] = []
        parts = step.shape.split(_half_turns(step.shape)) if isinstance(step.shape, Curve) else (step.shape,)
        for part in parts:
            self.owed += step.volume * self.e_per_mm3 / len(parts)
            shape = self._shape(part)
            if shape is None:
                continue
            self.at = shape.end
            done.append(self.laid(step, shape))
        return done

    def _slowing(self, area: float, shape: Shape) -> float:
        """Share of the speed that keeps the flow what it was, where a shape has become shorter or bears the ink of one left out."""
        owed = self.owed / self.e_per_mm3
        share = area * shape.length / owed if owed > 0 else 1.0
        # The grid alone changes the flow of any shape a little; that is no reason to slow down.
        return share if share < 1 - GRID_FLOW_FRACTION else 1.0

    def _shape(self, part: Shape) -> Shape | None:
        start: Point = (self.at[0], self.at[1])  # type: ignore[assignment]  # a Program's extrusions follow a travel
        end = (on_grid(part.end[0]), on_grid(part.end[1]))
        if start == end:
            return None
        if isinstance(part, Curve) and math.dist(start, end) > SHORT_ARC_MM:
            return Curve(start, end, (on_grid(part.centre[0]), on_grid(part.centre[1])), part.clockwise)
        return Straight(start, end)


def _half_turns(curve: Curve) -> int:
    # A half turn stays whole although rounding to the grid may have made it a hair longer.
    spare = 10 * 10**-XY_DECIMALS / max(curve.radius, SHORT_ARC_MM)
    return max(math.ceil((abs(curve.sweep) - spare) / math.pi), 1)


def on_grid(value: float) -> float:
    """A coordinate as it will be read back, mm (and never -0)."""
    return round(value, XY_DECIMALS) + 0.0


def speed_on_grid(speed: float, *, decimals: int = F_DECIMALS) -> float:
    """A speed as it will be read back, mm/s: F in mm/min rounded down to its `decimals`, so that a limit stays kept."""
    steps = max(math.floor(speed * 60 * 10**decimals + 1e-6), 1)
    return round(steps / 10**decimals, decimals) / 60


def _plain(text: str) -> str:
    """One printable line of ASCII."""
    line = " ".join(text.encode("ascii", "replace").decode().split())
    return "".join(c for c in line if c.isprintable())[:COMMENT_BYTES].strip()
