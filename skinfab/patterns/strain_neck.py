"""A strain sensor whose body is wider than the pair of its leads: a meander behind a narrow neck.

The leads of the two further strain meanders of TSDF (nicolaistein/TSDF), with four and with six lines; here any
even number. Between joints, or past a nail or a knuckle, the neck leaves room beside it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from skinfab.paths import Path, Point
from skinfab.patterns.base import Dimension, Pattern, PatternError
from skinfab.patterns.pen import Pen


@dataclass(frozen=True, kw_only=True)
class StrainNeck(Pattern):
    """A meander of `lines` lines, `b2` wide, whose outer two lines close in on leads only `b1` apart.

    Parameters
    ----------
    l1 : float, mm
        From the terminals to the body; at least a corner's radius, bead and gap. Unless given: three eighths of l2.
    l2 : float, mm
        Length of the body; at least l3 + bead + gap, which keeps the loops off the neck.
    l3 : float, mm
        Length of the inner loops, turns included; at least two radii and a bead. Unless given: four fifths of l2.
    b1 : float, mm
        Distance of the two leads; at least bead + gap. Unless given: 2.
    b2 : float, mm
        Width of the body: lines are b2 / (lines - 1) apart, and all radii are half of that; at least (lines - 1) (bead + gap), and
        (lines - 1) / (lines - 3) (b1 + 2 bead), for the corners. Unless given: three tenths of l2.
    lines : int
        How many parallel lines; even, 4 or more.

    Raises
    ------
    PatternError
        A parameter breaks a bound; the message has the nearest value that works.

    Examples
    --------
    >>> neck = StrainNeck(l1=15, l2=40, l3=32, b1=2, b2=12)
    >>> round(neck.length, 3) == round(neck.path().length, 3), neck.path().bbox.round(6).tolist()
    (True, [[0.0, -5.0], [55.0, 7.0]])
    """

    kind: ClassVar[str] = "strain-neck"
    senses: ClassVar[str] = "strain"
    example: ClassVar[Mapping[str, float]] = {"l1": 15.0, "l2": 40.0, "l3": 32.0, "b1": 2.0, "b2": 12.0}
    least: ClassVar[tuple[str, ...]] = ("l2",)

    l1: float
    l2: float
    l3: float
    b1: float
    b2: float
    lines: int = 4

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.lines < 4 or self.lines % 2:
            nearest = max(4, self.lines - self.lines % 2)
            raise PatternError(self.kind, "lines", self.lines, "it must be even and at least 4", nearest)
        self._at_least("b1", self.pitch_min, "one bead and one gap")
        least = self._least_body(self.lines, self.b1, self.bead, self.gap)
        self._at_least("b2", least, "the lines' pitches, and four corners beside the leads")
        self._at_least("l1", self._radius + self.pitch_min, "a corner and one bead and one gap")
        self._at_least("l3", 2 * self._radius + self.bead, "two turns and a bead of straight line")
        self._at_least("l2", self.l3 + self.pitch_min, "l3 and one bead and one gap")

    @staticmethod
    def _least_body(lines: int, b1: float, bead: float, gap: float) -> float:
        """Least b2, mm: room for the lines, and beside the leads for two corners with a bead of straight line between them."""
        return max((lines - 1) * (bead + gap), (lines - 1) / (lines - 3) * (b1 + 2 * bead))

    @classmethod
    def usual(cls, given: Mapping[str, Any]) -> dict[str, float]:
        """The proportions of the example, a body of 40 mm, as far as bead and gap allow."""
        l2, bead, pitch_min, lines = given["l2"], given["bead"], given["bead"] + given["gap"], max(given["lines"], 4)
        b1 = given.get("b1", max(2.0, pitch_min))
        b2 = given.get("b2", max(round(0.3 * l2, 2), cls._least_body(lines, b1, bead, given["gap"])))
        radius = b2 / (2 * (lines - 1))
        l3 = max(min(round(0.8 * l2, 2), l2 - pitch_min), 2 * radius + bead)
        return {"l1": max(round(0.375 * l2, 2), radius + pitch_min), "l3": l3, "b1": b1, "b2": b2}

    @property
    def _radius(self) -> float:
        return self.b2 / (2 * (self.lines - 1))

    @property
    def length(self) -> float:
        """Length of the path in closed form, mm."""
        r, inner = self._radius, self.lines - 2
        straight = 2 * (self.l1 - r) + (self.b2 - self.b1 - 4 * r) + 2 * (self.l2 - 2 * r) + inner * (self.l3 - 2 * r)
        return straight + (self.lines + 1) * math.pi * r

    @property
    def middle(self) -> Point:
        """Of the body, which belongs across the joint."""
        return np.array([self.l1 + self.l2 / 2, self.b1 / 2])

    @property
    def span(self) -> float:
        """Of the body."""
        return self.l2

    def dimensions(self) -> tuple[Dimension, ...]:
        """Lengths below and above, widths at both ends."""
        low, high, end = self.b1 / 2 - self.b2 / 2, self.b1 / 2 + self.b2 / 2, self.l1 + self.l2
        return (
            ("l1", (0.0, low), (self.l1, low)),
            ("l2", (self.l1, low), (end, low)),
            ("l3", (end - self.l3, high), (end, high)),
            ("b1", (0.0, 0.0), (0.0, self.b1)),
            ("b2", (end, low), (end, high)),
        )

    def path(self) -> Path:
        """The conductor: each line and arc tangent to the next, mm."""
        r, corner = self._radius, math.pi / 2
        beside = self.b2 / 2 - self.b1 / 2 - 2 * r  # of the neck, between its two corners
        pen = Pen()
        pen.forward(self.l1 - r)
        pen.bend(r, -corner)
        pen.forward(beside)
        pen.bend(r, corner)
        pen.forward(self.l2 - 2 * r)
        for k in range(self.lines - 1):
            pen.bend(r, -math.pi if k % 2 else math.pi)
            # The two outer lines reach to the neck, the loops between them do not.
            pen.forward((self.l3 if k < self.lines - 2 else self.l2) - 2 * r)
        pen.bend(r, corner)
        pen.forward(beside)
        pen.bend(r, -corner)
        pen.forward(self.l1 - r)
        return pen.path
