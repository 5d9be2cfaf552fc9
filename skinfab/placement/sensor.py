"""A pattern put somewhere on a flat piece."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

from skinfab.paths import Path
from skinfab.patterns.base import Pattern

#: What an id of a sensor or piece may be: it becomes a file name, a comment in G-code and a cell of a spreadsheet.
ID = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,63}")
ID_WORDS = "1 to 64 letters from A to Z, digits, - or _, and does not begin with -"


@dataclass(frozen=True)
class Sensor:
    """One sensor of the skin.

    Parameters
    ----------
    id : str
        "C1", "C2", ... for contact, "S1", ... for strain.
    piece : str
        Id of the piece it lies on.
    pattern : Pattern
    x, y : float, mm
        Where the pattern's origin lies in the piece frame.
    angle : float, rad
        Direction of the pattern's x axis in the piece frame.
    channel : int
        Readout channel, counted from 0 over the whole skin.
    """

    id: str
    piece: str
    pattern: Pattern
    x: float
    y: float
    angle: float
    channel: int

    @cached_property
    def path(self) -> Path:
        """The conductor between its two terminals, in the piece frame."""
        return self.pattern.path().transformed(angle=self.angle, shift=(self.x, self.y))

    @cached_property
    def printed_path(self) -> Path:
        """What the printer draws without a stop: pad, conductor, pad."""
        return self.pattern.printed_path().transformed(angle=self.angle, shift=(self.x, self.y))
