"""What every pattern is: parameters with bounds, a path with its leads along +x, two pads.

A new pattern is one file in this folder with one frozen dataclass that inherits `Pattern`, states
`kind`, `senses` and an `example`, and builds `path()`; docs/patterns.md makes one step by step.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from functools import cache
from numbers import Real
from typing import Any, ClassVar, TypeAlias

import numpy as np

from skinfab.errors import InputError
from skinfab.paths import Path, Point
from skinfab.patterns.pads import pad_stroke
from skinfab.tolerances import LARGEST_PATTERN_MM, LEAST_BEAD_MM, PARAMETER_ROUNDING_MM, PARAMETER_STEP_MM

#: A length to be drawn on a pattern's picture: the parameter's name, and from where to where in the pattern's frame, mm.
Dimension: TypeAlias = tuple[str, tuple[float, float], tuple[float, float]]


class PatternError(InputError):
    """A set of parameters that cannot be drawn: names the parameter, its value, the bound and the nearest value that works.

    Attributes
    ----------
    parameter : str
    nearest : float or int
        The value nearest to the one given with which this bound holds.
    """

    def __init__(self, kind: str, parameter: str, value: Any, bound: str, nearest: float) -> None:
        super().__init__(f"{kind}: {parameter} is {value!r}; {bound}; the nearest value that works is {_shown(nearest)}")
        self.parameter = parameter
        self.nearest = nearest


@dataclass(frozen=True, kw_only=True)
class Pattern(ABC):
    """A conductor's shape in its own frame: it starts at (0, 0), both leads run along +x, the upper one at y = b.

    Parameters
    ----------
    bead : float, mm
        Width that is kept clear for the printed bead; at least 0.05, and at least as wide as the bead that the material's ink makes.
    gap : float, mm
        Least distance from bead edge to bead edge; 0 or more.
    pad : float, mm
        Side of the square contact pad at either terminal; at least 2 bead, or 0 for none.

    Attributes
    ----------
    kind : str
        The name in files and on the command line.
    senses : str
        "contact" or "strain": what is placed on faces, or across joints with its span; its first letter begins the ids.
    example : mapping of str to number
        Parameters of a typical one, for the picture; the property tests start from them.
    least : tuple of str, optional
        Parameters that must be given where `usual` makes the others from them.

    Raises
    ------
    PatternError
        A parameter is not a number, or breaks a bound.
    """

    kind: ClassVar[str]
    senses: ClassVar[str]
    example: ClassVar[Mapping[str, float]]
    least: ClassVar[tuple[str, ...]] = ()

    bead: float = 0.785
    gap: float = 0.6
    pad: float = 3.0

    def __post_init__(self) -> None:
        for name, kind in _types(type(self)).items():
            value = self.read(name, getattr(self, name))
            object.__setattr__(self, name, value)
            # Counts are bounded by the lengths, in the pattern's own words.
            if kind == "float":
                self._at_most(name, LARGEST_PATTERN_MM, "no bed is larger")
        self._at_least("bead", LEAST_BEAD_MM, "no nozzle is finer")
        self._at_least("gap", 0.0, "a distance cannot be negative")
        if self.pad:
            self._at_least("pad", 2 * self.bead, "a pad must be two beads wide, or 0 for none")

    @classmethod
    def read(cls, name: str, value: Any) -> float | int | bool:
        """A parameter's value as its type has it: a finite number, whole for a count; true or false for a switch.

        Raises
        ------
        InputError
            It is something else.
        """
        kind = _types(cls)[name]
        if kind == "bool":
            if not isinstance(value, bool):
                raise InputError(f"{cls.kind}: {name} is {value!r}; it must be true or false")
            return value
        if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
            raise InputError(f"{cls.kind}: {name} is {value!r}; it must be a finite number")
        number = float(value)
        if kind == "int" and number != round(number):
            raise PatternError(cls.kind, name, value, "it is a count and must be whole", round(number))
        return round(number) if kind == "int" else number

    @classmethod
    def required(cls) -> tuple[str, ...]:
        """The parameters that must be given: `least` where the pattern states it, else all without a value of their own."""
        return cls.least or tuple(field.name for field in fields(cls) if field.default is MISSING)

    @classmethod
    def usual(cls, given: Mapping[str, Any]) -> dict[str, float]:
        """What goes with the parameters `given` (those required, and defaults): values for the others, in mm or counts.

        Wherever `given` allows it they keep all bounds, so that an error names what was given.
        """
        return {}

    @property
    def pitch_min(self) -> float:
        """Least distance of two centre lines, mm: one bead and one gap."""
        return self.bead + self.gap

    @abstractmethod
    def path(self) -> Path:
        """The conductor from terminal to terminal, pads left out."""

    @property
    def length(self) -> float:
        """Length of the path, mm; a pattern with a closed form gives it here."""
        return self.path().length

    @property
    def span(self) -> float:
        """How long the part that senses is along x, mm: the whole unless a pattern has leads to leave out."""
        return float(np.ptp(self.path().bbox[:, 0]))

    def dimensions(self) -> tuple[Dimension, ...]:
        """What the picture shows of the parameters; each is as long as the parameter it names."""
        return ()

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
        if not value >= bound - PARAMETER_ROUNDING_MM:
            nearest = _on_step(bound, up=True)
            if nearest > LARGEST_PATTERN_MM:
                raise InputError(
                    f"{self.kind}: {name} would have to be at least {_shown(nearest)} ({why}), and no bed is larger than "
                    f"{_shown(LARGEST_PATTERN_MM)} mm; make the other parameters smaller"
                )
            raise PatternError(self.kind, name, value, f"it must be at least {_shown(nearest)} ({why})", nearest)

    def _at_most(self, name: str, bound: float, why: str) -> None:
        value = getattr(self, name)
        if not value <= bound + PARAMETER_ROUNDING_MM:
            nearest = _on_step(bound, up=False)
            raise PatternError(self.kind, name, value, f"it must be at most {_shown(nearest)} ({why})", nearest)


@cache
def _types(cls: type[Pattern]) -> dict[str, Any]:
    """The types of a pattern's parameters by name, as written: looked up once a class, for a search makes thousands of patterns."""
    return {field.name: field.type for field in fields(cls)}


def _on_step(bound: float, *, up: bool) -> float:
    """A bound rounded to a parameter's step, to the side on which it still works."""
    steps, rounding = bound / PARAMETER_STEP_MM, PARAMETER_ROUNDING_MM / PARAMETER_STEP_MM
    count = math.ceil(steps - rounding) if up else math.floor(steps + rounding)
    # Without the digits that a product with 0.001 leaves behind.
    return round(count * PARAMETER_STEP_MM, 9)


def _shown(number: float) -> str:
    """All its steps and no more: 12, 1.385, 1000.001."""
    return f"{number:.3f}".rstrip("0").rstrip(".")
