"""What every pattern is: parameters with bounds, a path with its leads along +x, two pads.

A new pattern is one file with one frozen dataclass that inherits `Pattern`, states `kind`, and
builds `path()`; list it in `registry.PATTERNS` and the command line, the report and the property
tests know it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from skinfab.errors import InputError
from skinfab.paths import Path


class PatternError(InputError):
    """A set of parameters that cannot be drawn: names the parameter, its value, the bound and the nearest value that works."""


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
    """

    kind: ClassVar[str]

    bead: float = 0.785
    gap: float = 0.6
    pad: float = 3.0

    @abstractmethod
    def path(self) -> Path:
        """The conductor from terminal to terminal, pads left out."""

    @abstractmethod
    def printed_path(self) -> Path:
        """Pad, conductor, pad: one stroke of the printer."""
