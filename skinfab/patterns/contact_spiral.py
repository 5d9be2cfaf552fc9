"""The contact sensor: a bifilar spiral whose half-turns alternate between two centres.

"Soft Sensing Skins for Arbitrary Objects", figure 2A. There the lead is drawn to the nominal circle;
here it is trimmed to where it meets the arc, so that every arc starts and ends on its own circle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from skinfab.paths import Arc, Line, Path, Point, Segment
from skinfab.patterns.base import Dimension, Pattern, PatternError
from skinfab.tolerances import LEAST_BEAD_MM, PARAMETER_ROUNDING_MM


@dataclass(frozen=True, kw_only=True)
class ContactSpiral(Pattern):
    """Two leads wound side by side towards the middle; neighbouring turns are `x` apart everywhere.

    Parameters
    ----------
    n : int
        Inward half-turns after the outer pair; 1 or more, and no more than fit: (s - bead - gap) / (2 x) - 1. Unless given: all that
        fit, 6 at most.
    x : float, mm
        Distance of neighbouring centre lines; at least bead + gap. Unless given: 1.7 to 3.2 as s goes from 15 to 45.
    b : float, mm
        Distance of the two leads; at least bead + gap, at most s - 2 x. Unless given: 1.5 to 8 as s goes from 15 to 45.
    l : float, mm
        Length of the leads to the outer circle; at least bead + gap, which keeps the pads off the turns. Unless given: 3 to 8 as s
        goes from 15 to 45.
    s : float, mm
        Outer diameter; at least 4 x + bead + gap.
    caps : bool
        Half-circles of radius x/2 in place of the two links' square corners, outermost and at the centre; true or false.

    Raises
    ------
    PatternError
        A parameter breaks a bound; the message has the nearest value that works.

    Examples
    --------
    >>> spiral = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15)
    >>> round(spiral.path().length, 3) == round(spiral.length, 3), spiral.path().bbox.round(3).tolist()
    (True, [[0.0, -6.75], [18.0, 6.55]])
    >>> ContactSpiral(n=4, x=1.7, b=1.5, l=3, s=15)
    Traceback (most recent call last):
    ...
    skinfab.patterns.base.PatternError: contact-spiral: n is 4; at s = 15 and x = 1.7 no more than 3 half-turns fit; ...
    """

    kind: ClassVar[str] = "contact-spiral"
    senses: ClassVar[str] = "contact"
    example: ClassVar[Mapping[str, float]] = {"n": 3, "x": 2.0, "b": 3.0, "l": 6.0, "s": 22.0}
    least: ClassVar[tuple[str, ...]] = ("s",)

    n: int
    x: float
    b: float
    l: float  # noqa: E741 - the paper's name
    s: float
    caps: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.n < 1:
            raise PatternError(self.kind, "n", self.n, "it must be at least 1", 1)
        for name in ("x", "b", "l"):
            self._at_least(name, self.pitch_min, "one bead and one gap")
        fitting = self.half_turns_max(s=self.s, x=self.x, pitch_min=self.pitch_min)
        if fitting < 1:
            self._at_least("s", 2 * (2 * self.x + self.pitch_min / 2), f"one half-turn at x = {self.x:g}")
        if self.n > fitting:
            bound = f"at s = {self.s:g} and x = {self.x:g} no more than {fitting} half-turn{'s fit' if fitting > 1 else ' fits'}"
            raise PatternError(self.kind, "n", self.n, bound, fitting)
        self._at_most("b", self.s - 2 * self.x, "the upper lead must meet the outer turn: s - 2 x")

    @classmethod
    def usual(cls, given: Mapping[str, Any]) -> dict[str, float]:
        """The paper's proportions: its ranges of x, b and l from s = 15 to s = 45, as far as bead and gap allow, and six half-turns."""
        s, pitch_min = given["s"], given["bead"] + given["gap"]
        t = min(max((s - 15) / 30, 0.0), 1.0)
        x, b, l = (max(round(low + t * (high - low), 2), pitch_min) for low, high in ((1.7, 3.2), (1.5, 8.0), (3.0, 8.0)))  # noqa: E741
        # No more than a given pitch leaves room for.
        x = given.get("x", x)
        fitting = cls.half_turns_max(s=s, x=max(x, pitch_min, LEAST_BEAD_MM), pitch_min=pitch_min)
        return {"n": max(min(fitting, 6), 1), "x": x, "b": max(min(b, s - 2 * x), pitch_min), "l": l}

    @staticmethod
    def half_turns_max(*, s: float, x: float, pitch_min: float) -> int:
        """The most half-turns `n` that fit: the innermost turn keeps bead + gap across, R_(n+1) >= pitch_min / 2."""
        return math.floor((s / 2 - pitch_min / 2 + PARAMETER_ROUNDING_MM) / x) - 1

    @property
    def length(self) -> float:
        """Length of the path in closed form, mm."""
        turns = math.pi * (self.n + 1) * (self.s - (self.n + 1) * self.x)
        trims = 0.0
        for radius in (self._radius(0), self._radius(1)):
            trims += radius - math.sqrt(max(radius**2 - self.b**2 / 4, 0.0)) - radius * math.asin(min(self.b / (2 * radius), 1.0))
        links = math.pi * self.x if self.caps else 2 * self.x
        return 2 * self.l + links + turns + trims

    @property
    def middle(self) -> Point:
        """Half-way between the two centres."""
        return np.array([self.l + self.s / 2 - self.x / 2, self.b / 2])

    def dimensions(self) -> tuple[Dimension, ...]:
        """Lead and diameter below, pitch at the outermost bottom turns, the leads' distance at the terminals."""
        low, mid, bottom = self.b / 2 - self.s / 2, self.l + self.s / 2, self.b / 2 - self._radius(1)
        return (
            ("l", (0.0, low), (self.l, low)),
            ("s", (self.l, low), (self.l + self.s, low)),
            ("x", (mid, bottom), (mid, low)),
            ("b", (0.0, 0.0), (0.0, self.b)),
        )

    def _radius(self, k: int) -> float:
        return self.s / 2 - k * self.x

    def path(self) -> Path:
        """The conductor: 2 n + 2 arcs, two leads, two short links, mm."""
        middle = self.b / 2
        bottom, top = np.array([self.l + self.s / 2, middle]), np.array([self.l + self.s / 2 - self.x, middle])
        half = math.pi
        # Where the leads meet the outer turns, as an angle off the -x direction.
        first, last = (math.asin(min(self.b / (2 * self._radius(k)), 1.0)) for k in (0, 1))
        segments: list[Segment] = [
            Arc(bottom, self._radius(0), half + first, half - first),
            self._link(np.array([self.l + self.s, middle]), -self.x),
            Arc(bottom, self._radius(1), 0.0, -half),
        ]
        for m in range(1, self.n + 1):
            segments.append(Arc(top, self._radius(m + 1), half, -half) if m % 2 else Arc(bottom, self._radius(m + 1), 0.0, -half))
        inner: list[Segment] = []
        for m in range(self.n, 1, -1):
            inner.append(Arc(top, self._radius(m), 0.0, half) if m % 2 else Arc(bottom, self._radius(m), half, half))
        inner.append(Arc(top, self._radius(1), 0.0, half - last))
        link = self._link(segments[-1].end, self.x if self.n % 2 else -self.x)
        lead_in = Line(np.zeros(2), segments[0].start)
        lead_out = Line(inner[-1].end, np.array([0.0, self.b]))
        return Path((lead_in, *segments, link, *inner, lead_out))

    def _link(self, start: Point, step: float) -> Segment:
        """From one turn to its neighbour, `step` along x."""
        if not self.caps:
            return Line(start, start + np.array([step, 0.0]))
        # Counter-clockwise on either side: over the top going left, below going right.
        return Arc(start + np.array([step / 2, 0.0]), self.x / 2, 0.0 if step < 0 else math.pi, math.pi)
