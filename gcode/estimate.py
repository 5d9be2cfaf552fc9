"""How long a program takes, how much ink it lays and where.

Time follows the firmware's own planner: a trapezoid of velocity for each move, bounded at the joints by junction
deviation (Jeon, "Improving Grbl: cornering algorithm", 2011, as Marlin has it) and over all moves by looking ahead.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gcode.geometry import Curve
from gcode.grbl import spindle_s
from gcode.printer import Printer
from gcode.program import Clean, Comment, Dwell, Extrude, Prime, Program, Retract, Travel


@dataclass(frozen=True)
class Summary:
    """What the report says of one file: text lines, s, mm^3, ((x, y, z) low, high) of the ink in mm, number of arcs."""

    lines: int
    time_s: float
    ink_mm3: float
    bbox_mm: tuple[tuple[float, float, float], tuple[float, float, float]]
    arcs: int


@dataclass(frozen=True)
class _Block:
    """One move as the planner sees it; `into` and `out` are unit vectors in space."""

    step: int
    length: float
    speed: float
    into: tuple[float, float, float]
    out: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Timing:
    """When each of n steps is done.

    Parameters
    ----------
    start, duration : (n,) float, s
        Homing is left out; a comment takes no time.
    entry, peak, leave : (n,) float
        Speeds of a move, mm/s of its way (or of E, where only that moves); nan where nothing moves steadily.
    acceleration : float, mm/s^2
    """

    start: NDArray[np.float64]
    duration: NDArray[np.float64]
    entry: NDArray[np.float64]
    peak: NDArray[np.float64]
    leave: NDArray[np.float64]
    acceleration: float

    def done(self, step: int, time: float) -> float:
        """The share of its way that a step has gone at a time (s from the start of the program), 0 to 1."""
        whole = float(self.duration[step])
        t = min(max(time - float(self.start[step]), 0.0), whole)
        if whole <= 0.0:
            return float(time >= self.start[step])
        entry, peak, leave, a = float(self.entry[step]), float(self.peak[step]), float(self.leave[step]), self.acceleration
        if math.isnan(peak):
            return t / whole
        up, down = (peak - entry) / a, (peak - leave) / a
        length = _gone(whole, entry, peak, up, whole - down, a)
        return min(_gone(t, entry, peak, up, whole - down, a) / length, 1.0)


def _gone(t: float, entry: float, peak: float, up: float, fall: float, a: float) -> float:
    """The way after `t` s of speeding up until `up`, and slowing down from `fall`."""
    gone = entry * min(t, up) + a * min(t, up) ** 2 / 2
    gone += peak * max(min(t, fall) - up, 0.0)
    late = max(t - fall, 0.0)
    return gone + peak * late - a * late**2 / 2


def summarise(program: Program, printer: Printer, *, lines: int) -> Summary:
    """The summary of a program that was emitted as a text of `lines` lines."""
    corners: list[tuple[float, float, float]] = []
    z = 0.0
    for step in program.steps:
        if isinstance(step, Travel):
            z = z if step.z is None else step.z
        elif isinstance(step, Extrude):
            corners += [(*corner, z) for corner in step.shape.bbox]
    box = np.array(corners or [(0.0, 0.0, 0.0)])
    low, high = ((float(v[0]), float(v[1]), float(v[2])) for v in (box.min(axis=0), box.max(axis=0)))
    arcs = sum(isinstance(s, Extrude) and isinstance(s.shape, Curve) for s in program.steps)
    return Summary(lines, print_time(program, printer), program.ink, (low, high), arcs)


def primed(program: Program) -> float:
    """The most ink that is pushed beyond what is laid at any time, mm^3: what the cartridge needs besides `Program.ink`.

    Examples
    --------
    >>> primed(Program("P1", (Prime(0.2, 1.0), Retract(0.2, 1.0), Prime(0.25, 1.0), Retract(0.25, 1.0))))
    0.25
    """
    pushed = (s.volume if isinstance(s, Prime) else -s.volume for s in program.steps if isinstance(s, Prime | Retract))
    return max(itertools.accumulate(pushed, initial=0.0))


def print_time(program: Program, printer: Printer) -> float:
    """Time from the first step to the last, s; homing is left out.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> program = Program("P1", (Travel(x=0.0, y=0.0, speed=1.0), Travel(x=100.0, speed=50.0), Dwell(2.0)))
    >>> round(print_time(program, load_printer()), 3)  # 100 / 50 + 50 / 500 + 2
    4.1
    """
    return math.fsum(timing(program, printer).duration)


def timing(program: Program, printer: Printer) -> Timing:
    """When each step of a program is done, see `print_time`."""
    table = np.full((4, len(program.steps)), math.nan)
    table[0] = 0.0
    run: list[_Block] = []
    flow = 0.0  # S of a pump that is a spindle: GRBL stops the head before it changes that
    x: float | None = None
    y: float | None = None
    z: float | None = None
    for k, step in enumerate(program.steps):
        if isinstance(step, Comment):
            continue
        if isinstance(step, Travel):
            if flow:  # the pump is turned off, for which GRBL stops
                _time_run(run, printer, table)
                run, flow = [], 0.0
            now = (x, y, z)
            x, y, z = (old if new is None else new for old, new in zip(now, (step.x, step.y, step.z), strict=True))
            moved = [0.0 if old is None or new is None else new - old for old, new in zip(now, (x, y, z), strict=True)]
            if (length := math.hypot(*moved)) > 0:
                unit = (moved[0] / length, moved[1] / length, moved[2] / length)
                run.append(_Block(k, length, step.speed, unit, unit))
        elif isinstance(step, Extrude):
            if printer.spindle and (asked := spindle_s(step, printer.spindle)) != flow:
                _time_run(run, printer, table)
                run, flow = [], asked
            into, out = step.shape.directions
            run.append(_Block(k, step.shape.length, step.speed, (*into, 0.0), (*out, 0.0)))
            x, y = step.shape.end
        else:
            # A command at standstill ends the run: the head stops before it and starts anew after it.
            _time_run(run, printer, table)
            run, flow = [], 0.0
            if isinstance(step, (Dwell, Clean)):
                table[0, k] = step.seconds
            elif isinstance(step, (Prime, Retract)):
                if printer.spindle:
                    table[0, k] = step.volume / step.rate
                    continue
                e = step.volume * printer.pump.e_per_mm3
                table[:, k] = _trapezoid(e, step.rate * printer.pump.e_per_mm3, 0.0, 0.0, printer.motion.acceleration)
    _time_run(run, printer, table)
    start = np.concatenate([[0.0], np.cumsum(table[0])[:-1]])[: table.shape[1]]
    return Timing(start, table[0], table[1], table[2], table[3], printer.motion.acceleration)


def _time_run(run: list[_Block], printer: Printer, table: NDArray[np.float64]) -> None:
    """Times and speeds of moves without a stop between them, from rest to rest, into the columns of their steps."""
    if not run:
        return
    a = printer.motion.acceleration
    joints = [0.0, *(_junction_speed(one, two, printer) for one, two in itertools.pairwise(run)), 0.0]
    for k in range(len(run) - 1, -1, -1):  # slow down in time for what comes
        joints[k] = min(joints[k], math.sqrt(joints[k + 1] ** 2 + 2 * a * run[k].length))
    for k in range(len(run)):  # and speed up no faster than can be
        joints[k + 1] = min(joints[k + 1], math.sqrt(joints[k] ** 2 + 2 * a * run[k].length))
    for k, b in enumerate(run):
        table[:, b.step] = _trapezoid(b.length, b.speed, joints[k], joints[k + 1], a)


def _junction_speed(one: _Block, two: _Block, printer: Printer) -> float:
    cosine = -sum(u * v for u, v in zip(one.out, two.into, strict=True))
    limit = min(one.speed, two.speed)
    if cosine < -0.999999:
        return limit  # straight on
    half_sine = math.sqrt(max(0.5 * (1 - cosine), 0.0))
    if half_sine >= 1.0:
        return limit
    return min(limit, math.sqrt(printer.motion.acceleration * printer.motion.junction_deviation * half_sine / (1 - half_sine)))


def _trapezoid(length: float, speed: float, entry: float, leave: float, a: float) -> tuple[float, float, float, float]:
    """Time (s) over `length` from `entry` to `leave`, at most at `speed`, with acceleration `a`; the speeds at its start, most and end."""
    peak = min(speed, math.sqrt(a * length + (entry**2 + leave**2) / 2))
    ramps = (2 * peak**2 - entry**2 - leave**2) / (2 * a)
    return (2 * peak - entry - leave) / a + max(length - ramps, 0.0) / peak, entry, peak, leave
