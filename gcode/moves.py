"""What a text makes a printer do, and what is wrong with it: moves, homings and findings."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TypeAlias

from gcode.geometry import Curve, Point, Shape, Straight
from gcode.words import Command

Place: TypeAlias = tuple[float | None, float | None, float | None]  # machine x, y, z in mm; None where nobody knows


@dataclass(frozen=True)
class Finding:
    """One thing wrong with a file: where (line from 1, 0 for the file as a whole), what, and what to change."""

    line: int
    what: str
    remedy: str
    pattern: str = ""

    @property
    def kind(self) -> str:
        """What it says but for the numbers: the same for all findings of one sort."""
        return re.sub(r"-?\d[\d.]*", "#", self.what)

    def __str__(self) -> str:
        where = f"line {self.line}" if self.line else "file"
        return f"{where}{f', pattern {self.pattern}' if self.pattern else ''}: {self.what}; {self.remedy}"


@dataclass(frozen=True, slots=True)
class Move:
    """One motion command.

    Parameters
    ----------
    line : int
    start, end : (x, y, z), mm
        None for an axis whose place nobody knows yet.
    centre : (x, y) mm, or None for a straight move
    clockwise : bool
    e : float, mm
        Change of E, positive forward.
    speed : float or None, mm/s
        None before the first F.
    pattern : str
        After the last comment ``pattern NAME``.
    rapid : bool
        A G0 of GRBL, which goes as fast as the machine can, whatever F says.
    adrift : bool
        It goes on by so much in x or y from where nobody knows.
    shape : Straight or Curve, or None
        The motion in the plane; None where there is none or its start is unknown. It follows from the others.
    """

    line: int
    start: Place
    end: Place
    centre: Point | None
    clockwise: bool
    e: float
    speed: float | None
    pattern: str
    rapid: bool = False
    adrift: bool = False
    shape: Shape | None = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        # Asked for by every rule, so it is made once; slots keep a hundred thousand moves small.
        object.__setattr__(self, "shape", self._shape())

    def _shape(self) -> Shape | None:
        if self.start[0] is None or self.start[1] is None or self.end[0] is None or self.end[1] is None:
            return None
        start, end = (self.start[0], self.start[1]), (self.end[0], self.end[1])
        if self.centre is not None:
            return Curve(start, end, self.centre, self.clockwise)
        return Straight(start, end) if start != end else None

    @property
    def is_planar(self) -> bool:
        """It moves in x or y, as far as anyone knows."""
        return self.centre is not None or self.adrift or self.start[:2] != self.end[:2]


@dataclass(frozen=True)
class Home:
    """A G28: its line, the axes it homes, and how high the nozzle is then (mm, with what it rises before; None if unknown)."""

    line: int
    axes: str
    z: float | None
    pattern: str


@dataclass(frozen=True)
class Trace:
    """Moves of a text, the faults of its wording, all its commands (comments alone have the code ""), and where it homes."""

    moves: tuple[Move, ...]
    faults: tuple[Finding, ...]
    commands: tuple[Command, ...]
    homes: tuple[Home, ...] = ()
