"""The strain sensor: parallel lines along the stretch, joined by half-circles.

"Soft Sensing Skins for Arbitrary Objects", figure 2A, there with four lines.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from skinfab.paths import Arc, Line, Path, Point, Segment
from skinfab.patterns.base import Dimension, Pattern, PatternError

#: From line to line on the paper's two fingers, where bead and gap allow it.
_PITCH_MM = 2.0


@dataclass(frozen=True, kw_only=True)
class StrainLines(Pattern):
    """A meander of `lines` parallel lines; the two outer ones go on as leads.

    Parameters
    ----------
    l1 : float, mm
        From the terminals to the far end; at least l2 + bead + gap, which keeps the pads off the turns.
    l2 : float, mm
        Length of the meander itself, turns included; at least b / (lines - 1) + bead, a turn and some straight line. Unless given:
        nine tenths of l1.
    b : float, mm
        Distance of the two leads; at least (lines - 1) (bead + gap). Unless given: 2 from line to line, 6 for four.
    lines : int
        How many parallel lines; even, 2 or more.

    Raises
    ------
    PatternError
        A parameter breaks a bound; the message has the nearest value that works.

    Examples
    --------
    >>> robot_finger = StrainLines(l1=60, l2=54, b=6)
    >>> round(robot_finger.length, 2), robot_finger.path().bbox.round(6).tolist()
    (231.42, [[0.0, 0.0], [60.0, 6.0]])
    """

    kind: ClassVar[str] = "strain-lines"
    senses: ClassVar[str] = "strain"
    example: ClassVar[Mapping[str, float]] = {"l1": 60.0, "l2": 54.0, "b": 6.0}
    least: ClassVar[tuple[str, ...]] = ("l1",)

    l1: float
    l2: float
    b: float
    lines: int = 4

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.lines < 2 or self.lines % 2:
            nearest = max(2, self.lines - self.lines % 2)
            raise PatternError(self.kind, "lines", self.lines, "it must be even and at least 2", nearest)
        self._at_least("b", (self.lines - 1) * self.pitch_min, f"{self.lines - 1} times one bead and one gap")
        # A straight part of no length at all is none that a printer could draw.
        self._at_least("l2", 2 * self._radius + self.bead, "two turns and a bead of straight line")
        self._at_least("l1", self.l2 + self.pitch_min, "l2 and one bead and one gap")

    @classmethod
    def usual(cls, given: Mapping[str, Any]) -> dict[str, float]:
        """As on the paper's robot finger, l1 = 60: l2 = 54 and lines 2 mm apart."""
        gaps, pitch_min = max(given["lines"] - 1, 1), given["bead"] + given["gap"]
        b = given.get("b", gaps * max(_PITCH_MM, pitch_min))
        # Long enough for its turns, and otherwise short enough to leave room for the pads.
        return {"l2": max(min(round(0.9 * given["l1"], 2), given["l1"] - pitch_min), b / gaps + given["bead"]), "b": b}

    @property
    def _radius(self) -> float:
        return self.b / (2 * (self.lines - 1))

    @property
    def length(self) -> float:
        """Length of the path in closed form, mm."""
        r, inner = self._radius, self.lines - 2
        return 2 * (self.l1 - r) + inner * (self.l2 - 2 * r) + (self.lines - 1) * math.pi * r

    @property
    def middle(self) -> Point:
        """Of the loops, which belong across the joint."""
        return np.array([self.l1 - self.l2 / 2, self.b / 2])

    @property
    def span(self) -> float:
        """Of the meander."""
        return self.l2

    def dimensions(self) -> tuple[Dimension, ...]:
        """Both lengths below, the leads' distance at the terminals."""
        return (
            ("l1", (0.0, 0.0), (self.l1, 0.0)),
            ("l2", (self.l1 - self.l2, 0.0), (self.l1, 0.0)),
            ("b", (0.0, 0.0), (0.0, self.b)),
        )

    def path(self) -> Path:
        """The conductor: `lines` lines and lines - 1 half-circles, each tangent to the next, mm."""
        r = self._radius
        right, left = self.l1 - r, self.l1 - self.l2 + r
        segments: list[Segment] = []
        for k in range(self.lines):
            y = self.b * k / (self.lines - 1)
            # The first and the last line reach to the terminals.
            near = np.array([0.0 if k in (0, self.lines - 1) else left, y])
            far = np.array([right, y])
            segments.append(Line(far, near) if k % 2 else Line(near, far))
            if k < self.lines - 1:
                sweep = -math.pi if k % 2 else math.pi
                segments.append(Arc(np.array([left if k % 2 else right, y + r]), r, -math.pi / 2, sweep))
        return Path(tuple(segments))
