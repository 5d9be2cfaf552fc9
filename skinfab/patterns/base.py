"""What every pattern is: parameters with bounds, a path with its leads along +x, two pads.

A new pattern is one file with one frozen dataclass that inherits `Pattern`, states `kind`, and
builds `path()`; list it in `registry.PATTERNS` and the command line, the report and the property
tests know it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, ClassVar

from skinfab.errors import InputError
from skinfab.paths import Path, Point
from skinfab.patterns.pads import pad_stroke
from skinfab.tolerances import PARAMETER_STEP_MM


class PatternError(InputError):
    """A set of parameters that cannot be drawn: names the parameter, its value, the bound and the nearest value that works.

    Attributes
    ----------
    parameter : str
    nearest : float or int
        The value nearest to the one given with which this bound holds.
    """

    def __init__(self, kind: str, parameter: str, value: Any, bound: str, nearest: float) -> None:
        super().__init__(f"{kind}: {parameter} is {value!r}; {bound}; the nearest value that works is {nearest:g}")
        self.parameter = parameter
        self.nearest = nearest


@dataclass(frozen=True, kw_only=True)
class Pattern(ABC):
    """A conductor's shape in its own frame: it starts at (0, 0), both leads run along +x, the upper one at y = b.

    Parameters
    ----------
    bead : float, mm
        Width of the printed bead.
    gap : float, mm
        Least distance from bead edge to bead edge.
    pad : float, mm
        Side of the square contact pad at either terminal; 0 for none.

    Raises
    ------
    PatternError
        A parameter is not a number, or breaks a bound.
    """

    kind: ClassVar[str]

    bead: float = 0.785
    gap: float = 0.6
    pad: float = 3.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "bool":
                if not isinstance(value, bool):
                    raise InputError(f"{self.kind}: {field.name} is {value!r}; it must be true or false")
                continue
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
                raise InputError(f"{self.kind}: {field.name} is {value!r}; it must be a finite number")
            number = float(value)
            if field.type == "int" and number != round(number):
                raise PatternError(self.kind, field.name, value, "it is a count and must be whole", round(number))
            object.__setattr__(self, field.name, round(number) if field.type == "int" else number)
        self._at_least("bead", PARAMETER_STEP_MM, "the bead must have a width")
        self._at_least("gap", 0.0, "a distance cannot be negative")
        if self.pad:
            self._at_least("pad", 2 * self.bead, "a pad must be two beads wide, or 0 for none")

    @property
    def pitch_min(self) -> float:
        """Least distance of two centre lines, mm: one bead and one gap."""
        return self.bead + self.gap

    @abstractmethod
    def path(self) -> Path:
        """The conductor from terminal to terminal, pads left out."""

    @property
    def middle(self) -> Point:
        """What should lie on the spot the sensor is for, (2,) mm: the centre of the conductor's box unless a pattern knows better."""
        centre: Point = self.path().bbox.mean(axis=0)
        return centre

    def printed_path(self) -> Path:
        """Pad, conductor, pad: one stroke of the printer."""
        path = self.path()
        if not self.pad:
            return path
        first = pad_stroke(at=path.start, side=self.pad, bead=self.bead, upward=False)
        last = pad_stroke(at=path.end, side=self.pad, bead=self.bead, upward=True)
        return Path((*first.reversed().segments, *path.segments, *last.segments))

    def _at_least(self, name: str, bound: float, why: str) -> None:
        value = getattr(self, name)
        # The printed bound is rounded to the side on which it still works.
        if not value >= bound:
            nearest = math.ceil(bound / PARAMETER_STEP_MM) * PARAMETER_STEP_MM
            raise PatternError(self.kind, name, value, f"it must be at least {nearest:.6g} ({why})", nearest)

    def _at_most(self, name: str, bound: float, why: str) -> None:
        value = getattr(self, name)
        if not value <= bound:
            nearest = math.floor(bound / PARAMETER_STEP_MM) * PARAMETER_STEP_MM
            raise PatternError(self.kind, name, value, f"it must be at most {nearest:.6g} ({why})", nearest)
