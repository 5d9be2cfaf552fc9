"""A program as arrays over its steps: when, where, what the head does there, and on which line it is said. Knows no widget."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gcode.emit import step_lines
from gcode.estimate import Timing, timing
from gcode.geometry import Curve
from gcode.piece import PieceProgram
from gcode.preview import ROLES, Stroke, strokes
from gcode.program import Clean, Comment, Dwell, Extrude, Prime, Retract, Travel
from gcode.trace import trace

Float = NDArray[np.float64]
Int = NDArray[np.int64]

#: What the head does, in the order in which it is drawn: ink lies over what is no ink. A wait is not drawn.
DRAWN = ("travel", "overrun", "cleaning", "print", "print-overrun", "retract", "prime")
ROLE_NAMES = (*DRAWN, "wait")

#: How far the drawn chords may leave an arc, mm: less than a pixel at any scale at which a whole arc is seen.
CHORD_MM = 0.02


@dataclass(frozen=True, eq=False)
class Instant:
    """What there is to say of one moment.

    Parameters
    ----------
    time : float, s
    step : int
        Index of what is being done.
    done : float
        The share of it that is done.
    line : int
        Of the text, from 1.
    at : (3,) float, mm
        The head's place; nan where nobody knows.
    ink : float, mm^3
        Laid along paths so far.
    role, pattern : str
    speed : float, mm/s
        That is asked for; 0 at standstill.
    """

    time: float
    step: int
    done: float
    line: int
    at: Float
    ink: float
    role: str
    pattern: str
    speed: float


@dataclass(frozen=True, eq=False)
class Timeline:
    """The n steps of a program that take time or go somewhere; its comments are left out.

    Parameters
    ----------
    piece : str
    lines : tuple of str
        The text; line 1 is the first.
    index : (n,) int
        Position of each step among those of the program.
    role : (n,) int
        Index into `ROLE_NAMES`.
    line : (n,) int
        The line of the text that says it.
    ink : (n + 1,) float, mm^3
        Laid before each step, and at the end.
    place : (n + 1, 3) float, mm
        Before each step, and at the end.
    speed : (n,) float, mm/s
    pattern : (n,) int
        Index into `patterns`.
    patterns : tuple of str
        "" is the first.
    parts : (k, 2, 2) float, mm
        What is drawn: straight parts, one point twice where ink moves at standstill.
    part_step : (k,) int
        The step that each belongs to, never falling.
    width : (n,) float, mm
        How wide it is drawn.
    length : (n,) float, mm
        Of its way, an arc as an arc.
    curves : dict
        The arcs among the steps.
    timing : Timing
        Of the program's steps.
    """

    piece: str
    lines: tuple[str, ...]
    index: Int
    role: Int
    line: Int
    ink: Float
    place: Float
    speed: Float
    pattern: Int
    patterns: tuple[str, ...]
    parts: Float
    part_step: Int
    width: Float
    length: Float
    curves: dict[int, Curve]
    timing: Timing

    def __len__(self) -> int:
        return len(self.index)

    @cached_property
    def start(self) -> Float:
        """(n,) s"""
        return self.timing.start[self.index]

    @cached_property
    def end(self) -> float:
        """When all is done, s."""
        return float(np.sum(self.timing.duration))

    @cached_property
    def box(self) -> tuple[Float, Float]:
        """Lowest and highest corner of what has ink along a way; of all that is drawn where there is none. mm"""
        inked = np.isin(self.role[self.part_step], [ROLE_NAMES.index(r) for r in ("print", "print-overrun")])
        points = (self.parts[inked] if inked.any() else self.parts).reshape(-1, 2)
        if not len(points):
            return np.zeros(2), np.zeros(2)
        return points.min(axis=0), points.max(axis=0)

    @cached_property
    def amounts(self) -> dict[str, tuple[float, int]]:
        """Of each role that is drawn: the length of its ways, mm, and how often it is done at standstill."""
        drawn = np.unique(self.part_step)
        roles, lengths = self.role[drawn], self.length[drawn]
        return {
            name: (float(lengths[mine].sum()), int((lengths[mine] == 0).sum()))
            for k, name in enumerate(DRAWN)
            if (mine := roles == k).any()
        }

    def step_at(self, time: float) -> int:
        """The step that is being done at a time; the last one at and after the end."""
        return max(int(np.searchsorted(self.start, time, side="right")) - 1, 0)

    def step_of_line(self, line: int) -> int:
        """The step that a line of the text says, or the next one."""
        return min(int(np.searchsorted(self.line, line)), len(self) - 1)

    def at(self, time: float) -> Instant:
        """All there is to say of a time, s; before the start and after the end it stands still."""
        time = min(max(time, 0.0), self.end)
        k = self.step_at(time)
        done = 1.0 if time >= self.end else self.timing.done(int(self.index[k]), time)
        return Instant(
            time=time,
            step=k,
            done=done,
            line=int(self.line[k]),
            at=self._place(k, done),
            ink=float(self.ink[k] + done * (self.ink[k + 1] - self.ink[k])),
            role=ROLE_NAMES[self.role[k]],
            pattern=self.patterns[self.pattern[k]],
            speed=float(self.speed[k]),
        )

    def way(self, step: int, done: float) -> Float:
        """(k, 2) mm, the part of a step's drawn way that is done."""
        first, last = np.searchsorted(self.part_step, [step, step + 1])
        if first == last:
            return np.zeros((0, 2))
        points = np.concatenate([self.parts[first:last, 0], self.parts[last - 1 : last, 1]])
        gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        if gone[-1] <= 0.0:
            return points[:1]
        # Chords of one arc are of one length, so the share of the arc is the share of its chords.
        until = done * gone[-1]
        return np.concatenate([points[gone < until], [[np.interp(until, gone, points[:, j]) for j in range(2)]]])

    def _place(self, k: int, done: float) -> Float:
        before, after = self.place[k], self.place[k + 1]
        if k in self.curves:
            return np.array([*self.curves[k].point_at(done), after[2]])
        if done >= 1.0:
            return after
        # From an unknown place nobody knows the way.
        return np.where(before == after, before, before + done * (after - before))


def timeline(planned: PieceProgram) -> Timeline:
    """Lay a program out over time.

    Parameters
    ----------
    planned : PieceProgram
        With one step at least that is no comment, as every plan has.
    """
    steps = planned.program.steps
    drawn = _drawn(planned)
    lines = step_lines(planned.program, planned.printer)
    table = _Table()
    x = y = z = float("nan")
    ink, pattern = 0.0, ""
    for k, step in enumerate(steps):
        if isinstance(step, Comment):
            pattern = step.text.removeprefix("pattern ").strip() if step.text.startswith("pattern ") else pattern
            continue
        before = (x, y, z)
        speed = 0.0
        if isinstance(step, Travel):
            x, y, z = (old if new is None else new for old, new in zip(before, (step.x, step.y, step.z), strict=True))
            speed = step.speed
        elif isinstance(step, Extrude):
            (x, y), speed = step.shape.end, step.speed
            ink += step.volume
        first, last = lines[k]
        stroke = next((drawn[n] for n in range(first, last + 1) if n in drawn), None)
        if stroke is not None and stroke.shape is not None:
            before = (*stroke.shape.start, before[2])  # known at first by homing alone
        elif isinstance(step, Clean) and np.isfinite(before[:2]).all():
            stroke = Stroke("cleaning", None, before[:2], 1.0, pattern, int(last))
        line, role, width = (last, _undrawn(step), 0.0) if stroke is None else (stroke.line, stroke.role, stroke.width)
        table.add(k, line, role, width, before, ink, speed, pattern)
        if stroke is not None:
            table.draw(stroke)
    return table.made(planned, (x, y, z))


def _drawn(planned: PieceProgram) -> dict[int, Stroke]:
    """What is drawn for a line of the text."""
    judged = trace(planned.text, spindle=planned.printer.spindle, motion=planned.printer.motion)
    found: dict[int, Stroke] = {}
    for stroke in strokes(judged, planned.printer):
        # The dot of a cleaning comes after the move that led there; here it is the wait's own.
        if stroke.shape is not None or stroke.role != "cleaning":
            found[stroke.line] = stroke
    return found


def _undrawn(step: object) -> str:
    if isinstance(step, Clean):
        return "cleaning"
    if isinstance(step, Dwell):
        return "wait"
    return {Extrude: "print", Prime: "prime", Retract: "retract"}.get(type(step), "travel")


class _Table:
    """Rows, and what is made of them."""

    def __init__(self) -> None:
        self.rows: list[tuple[int, int, int, float, float, float, int]] = []
        self.places: list[tuple[float, float, float]] = []
        self.patterns = {"": 0}
        self.parts: list[Float] = []
        self.owners: list[tuple[int, int]] = []
        self.lengths: dict[int, float] = {}
        self.curves: dict[int, Curve] = {}

    def add(
        self, k: int, line: int, role: str, width: float, before: tuple[float, float, float], ink: float, speed: float, pattern: str
    ) -> None:
        number = self.patterns.setdefault(pattern, len(self.patterns))
        self.rows.append((k, line, ROLE_NAMES.index(role), width, ink, speed, number))
        self.places.append(before)

    def draw(self, stroke: Stroke) -> None:
        """The way of the step that was added last."""
        k, shape = len(self.rows) - 1, stroke.shape
        if isinstance(shape, Curve):
            self.curves[k] = shape
            points = shape.chord_points(CHORD_MM)
        else:
            points = np.array([stroke.at, stroke.at] if shape is None else [shape.start, shape.end])
        self.parts.append(np.stack([points[:-1], points[1:]], axis=1))
        self.owners.append((k, len(points) - 1))
        self.lengths[k] = 0.0 if shape is None else shape.length

    def made(self, planned: PieceProgram, end: tuple[float, float, float]) -> Timeline:
        index, line, role, width, ink, speed, pattern = (np.array(column) for column in zip(*self.rows, strict=True))
        owners = np.array(self.owners, dtype=np.int64).reshape(-1, 2)
        return Timeline(
            piece=planned.program.name,
            lines=tuple(planned.text.splitlines()),
            index=index,
            role=role,
            line=line,
            ink=np.concatenate([[0.0], ink]),
            place=np.array([*self.places, end]),
            speed=speed,
            pattern=pattern,
            patterns=tuple(self.patterns),
            parts=np.concatenate(self.parts) if self.parts else np.zeros((0, 2, 2)),
            part_step=np.repeat(owners[:, 0], owners[:, 1]),
            width=width,
            length=np.array([self.lengths.get(k, 0.0) for k in range(len(index))]),
            curves=self.curves,
            timing=timing(planned.program, planned.printer),
        )


def legend(line: Timeline) -> list[tuple[str, str]]:
    """Each role that is drawn, and how it is said with how much there is of it."""
    said = []
    for role in ROLES:
        if role in line.amounts:
            length, dots = line.amounts[role]
            amount = f"{dots} time{'s' * (dots > 1)}" if not length else f"{length:.0f} mm"
            said.append((role, f"{ROLES[role][1].split(',')[0].split(':')[0]} {amount}"))
    return said


def runs(line: Timeline) -> list[tuple[str, float, Float]]:
    """What is drawn as few long lines: role, width (mm) and points (k, 2) mm, in the order in which they cover each other."""
    roles, widths = line.role[line.part_step], np.round(line.width[line.part_step], 2)
    joined = np.all(line.parts[1:, 0] == line.parts[:-1, 1], axis=1) & (roles[1:] == roles[:-1]) & (widths[1:] == widths[:-1])
    ends = [0, *(np.flatnonzero(~joined) + 1).tolist(), len(line.parts)]
    found = [
        (DRAWN[roles[a]], float(widths[a]), np.concatenate([line.parts[a:b, 0], line.parts[b - 1 : b, 1]]))
        for a, b in itertools.pairwise(ends)
        if b > a
    ]
    return sorted(found, key=lambda run: DRAWN.index(run[0]))
