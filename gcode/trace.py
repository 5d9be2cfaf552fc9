"""What a printer would do with any G-code text: its moves, read as Marlin reads them.

A fault of the text that still leaves a clear motion becomes a `Finding`; a text without a clear motion
is an InputError that names the line.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from gcode.geometry import Curve, Point, Shape, Straight
from gcode.printer import Spindle
from gcode.words import MODAL, SETTING, Command, read_commands
from skinfab.errors import InputError

Place: TypeAlias = tuple[float | None, float | None, float | None]  # machine x, y, z in mm; None where nobody knows

#: Marlin's MAX_CMD_SIZE: what is beyond is cut off in silence.
LINE_BYTES = 96
MM_PER_INCH = 25.4


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
        return self.centre is not None or self.start[:2] != self.end[:2]


@dataclass(frozen=True)
class Trace:
    """Moves of a text, the faults of its wording, and all its commands (comments alone have the code "")."""

    moves: tuple[Move, ...]
    faults: tuple[Finding, ...]
    commands: tuple[Command, ...]


def trace(text: str, *, spindle: Spindle | None = None) -> Trace:
    """Follow a text as Marlin would, or as GRBL where a spindle is the pump.

    With a `spindle`, E of a move is what the pump gives while it lasts, mm^3; a wait with the pump on is a move
    without a way.

    Raises
    ------
    InputError
        A line that cannot be read or followed.

    Examples
    --------
    >>> t = trace("G90\\nM83\\nM302 P1\\nG0 X0 Y0 F600\\nG3 X2 Y0 I1 J0 E0.5")
    >>> t.moves[1].shape.length.__round__(6), t.faults
    (3.141593, ())
    """
    judged, fault = trace_as_far(text, spindle=spindle)
    if fault:
        raise fault
    return judged


def trace_as_far(text: str, *, spindle: Spindle | None = None) -> tuple[Trace, InputError | None]:
    """As `trace`, up to the line that cannot be read or followed, and what is wrong with it."""
    head, commands, fault = _Head(spindle), [], None
    try:
        for told in read_commands(text, blocks=spindle is not None):
            command = head.continued(told)
            head.follow(command)
            commands.append(command)
    except InputError as stopped:
        fault = stopped
    return Trace(tuple(head.moves), tuple(head.faults), tuple(commands)), fault


def homed_axes(command: Command) -> str:
    """Axes that a G28 homes: those it names, or all.

    Examples
    --------
    >>> [homed_axes(command) for command in read_commands("G28 Y X\\nG28")]
    ['XY', 'XYZ']
    """
    return "".join(axis for axis in "XYZ" if axis in command.words) or "XYZ"


class _Head:
    """Marlin's modes and the head's place."""

    def __init__(self, spindle: Spindle | None) -> None:
        self.spindle = spindle
        self.flow = 0.0  # of that spindle, mm^3/s, backward negative
        self.spindle_s = 0.0  # the last S
        self.turn = "M5"  # which way it turns
        self.motion = "G0" if spindle else ""  # what a line without a G goes on with; GRBL starts with G0
        self.moves: list[Move] = []
        self.faults: list[Finding] = []
        self.place: list[float | None] = [None, None, None]  # of the machine, mm
        self.shift = [0.0, 0.0, 0.0]  # machine place minus the place as written, set by G92
        self.e = 0.0  # as written, for absolute E
        self.scale = 1.0
        self.speed: float | None = None
        self.relative = self.relative_e = False
        self.cold = self.warned_cold = False
        self.undone: Command | None = None  # a G90 that has undone an M83
        self.pattern = ""

    def continued(self, command: Command) -> Command:
        """A line of places alone as the motion it goes on with (RS-274/NGC, modal group 1)."""
        if command.code not in (MODAL, SETTING):
            return command
        if not self.spindle:
            # What the writer meant is judged, once this is said.
            self._fault(
                command,
                "it has no G before its words, and Marlin passes it over unless it was built with GCODE_MOTION_MODES",
                "write the G of its motion before it",
            )
        elif command.code == MODAL and not self.motion:
            raise InputError(f"line {command.line}: there is no motion to go on with; begin with G0, G1, G2 or G3")
        return replace(command, code=self.motion) if command.code == MODAL and self.motion else command

    def follow(self, command: Command) -> None:
        if command.comment.startswith("pattern ") and not command.code:
            self.pattern = command.comment.removeprefix("pattern ").strip()
        if command.code and command.size > LINE_BYTES:
            self._fault(command, f"it is {command.size} bytes long, Marlin cuts at {LINE_BYTES}", "shorten its numbers or its comment")
        code = command.code
        if self.spindle and "S" in command.words and code in ("G0", "G1", "G2", "G3", SETTING):
            self._turn_pump(command, self.spindle)
        if code in ("G0", "G1", "G2", "G3"):
            self.motion = code
            self._move(command)
        elif code == SETTING:
            self._feed(command)
        elif code == "G80" or code.startswith("G38"):
            self.motion = ""
        elif code in ("G20", "G21"):
            self.scale = MM_PER_INCH if code == "G20" else 1.0
        elif code in ("G90", "G91"):
            self._distance_mode(command)
        elif code in ("M82", "M83"):
            self.relative_e, self.undone = code == "M83", None
        elif code == "M302":
            self.cold = command.words.get("P") == 1 or command.words.get("S") == 0
        elif code == "G92":
            self._set_place(command)
        elif code == "G28":
            self._home(command)
        elif self.spindle and code in ("M3", "M4", "M5", "M2", "M30"):
            self._turn_pump(command, self.spindle)
        elif self.spindle and code == "G4" and self.flow:
            self._pump_at_rest(command)
        elif code in ("G5", "G18", "G19"):
            raise InputError(f"line {command.line}: {code} is not supported; use lines and arcs in the XY plane")

    def _fault(self, command: Command, what: str, remedy: str) -> None:
        self.faults.append(Finding(command.line, what, remedy, self.pattern))

    def _distance_mode(self, command: Command) -> None:
        self.relative = command.code == "G91"
        if command.code == "G91":
            self.relative_e = True
        elif self.relative_e:
            # Marlin sets E absolute here. What the writer meant is relative: the ink is judged as that, once this is said.
            self.undone = command

    def _number(self, command: Command, letter: str) -> float | None:
        value = command.words.get(letter)
        if value is None and letter in command.words:
            raise InputError(f"line {command.line}: {letter} has no number")
        return value

    def _target(self, command: Command) -> list[float | None]:
        end = list(self.place)
        for k, axis in enumerate("XYZ"):
            if axis not in command.words or (value := self._number(command, axis)) is None:
                continue
            if self.relative:
                here = self.place[k]
                end[k] = None if here is None else here + value * self.scale
            else:
                end[k] = value * self.scale + self.shift[k]
        return end

    def _feed(self, command: Command) -> None:
        if (feed := self._number(command, "F")) is not None:
            if feed <= 0:
                raise InputError(f"line {command.line}: F is {feed:g}; a speed must be positive")
            self.speed = feed * self.scale / 60

    def _move(self, command: Command) -> None:
        self._feed(command)
        end = self._target(command)
        e = self._ink(command)
        centre = self._centre(command, end) if command.code in ("G2", "G3") else None
        if centre is not None or e or any(axis in command.words for axis in "XYZ"):
            start = (self.place[0], self.place[1], self.place[2])
            move = Move(command.line, start, (end[0], end[1], end[2]), centre, command.code == "G2", e, self.speed, self.pattern)
            self.moves.append(replace(move, e=self._pumped(move)) if self.spindle else move)
        self.place = end

    def _turn_pump(self, command: Command, spindle: Spindle) -> None:
        self.spindle_s = self.spindle_s if (s := self._number(command, "S")) is None else s
        if self.spindle_s < 0 or self.spindle_s > spindle.s_max:
            self._fault(command, f"S{self.spindle_s:g} is not within 0 and the spindle's {spindle.s_max:g}", "lower the flow, or raise $30")
        self.turn = command.code if command.code.startswith("M") else self.turn
        sign = {"M3": 1.0, "M4": -1.0}.get(self.turn, 0.0)
        self.flow = sign * self.spindle_s / spindle.s_per_flow

    def _pump_at_rest(self, command: Command) -> None:
        seconds = self._number(command, "P") or 0.0
        place = (self.place[0], self.place[1], self.place[2])
        self.moves.append(Move(command.line, place, place, None, False, self.flow * seconds, abs(self.flow), self.pattern))

    def _pumped(self, move: Move) -> float:
        """What the running pump gives during a move, mm^3."""
        if not self.flow or not move.speed:
            return 0.0
        if move.shape is not None:
            return self.flow * (move.shape.length / move.speed)
        low, high = move.start[2], move.end[2]
        # A way of unknown length still lays ink: as much as in one second.
        return self.flow * (abs(high - low) / move.speed if low is not None and high is not None and not move.is_planar else 1.0)

    def _ink(self, command: Command) -> float:
        value = self._number(command, "E")
        if value is None:
            return 0.0
        if self.undone:
            self._fault(
                self.undone, f"G90 after M83 makes E absolute again, so E from line {command.line} on is misread", "put M83 after G90"
            )
            self.undone = None
        value *= self.scale
        if self.relative_e:
            e = value
        else:
            e, self.e = value - self.e, value
        if e and not self.cold and not self.warned_cold:
            self.warned_cold = True
            self._fault(
                command, "it extrudes before M302 P1: a printer without a heater drops the ink in silence", "put M302 P1 at the start"
            )
        return e

    def _centre(self, command: Command, end: list[float | None]) -> Point:
        if None in self.place[:2]:
            raise InputError(f"line {command.line}: an arc begins at an unknown place; move to its start with G0 X Y first")
        if self._number(command, "Z") is not None:
            self._fault(command, "Z on an arc is overwritten under mesh levelling", "move Z on a line of its own")
        x, y = float(self.place[0] or 0.0), float(self.place[1] or 0.0)
        if (radius := self._number(command, "R")) is not None:
            self._fault(command, "the R form of an arc is clamped or refused by firmwares", "give the centre as I and J")
            return self._centre_by_radius(command, (x, y), (float(end[0] or 0.0), float(end[1] or 0.0)), radius * self.scale)
        i, j = self._number(command, "I"), self._number(command, "J")
        if i is None and j is None:
            raise InputError(f"line {command.line}: {command.code} has neither I nor J; give the centre's offset from the start")
        if not (i or j):
            raise InputError(f"line {command.line}: the arc's centre is its start; its radius must be more than zero")
        return x + (i or 0.0) * self.scale, y + (j or 0.0) * self.scale

    @staticmethod
    def _centre_by_radius(command: Command, start: Point, end: Point, radius: float) -> Point:
        half = math.dist(start, end) / 2
        if half == 0 or not radius:
            raise InputError(f"line {command.line}: an arc by R needs a radius and two different ends")
        # The short way round for R > 0; a radius under half the chord is clamped to it, as Marlin does.
        rise = math.sqrt(max(radius**2 - half**2, 0.0)) * (1 if (command.code == "G2") == (radius < 0) else -1)
        dx, dy = (end[0] - start[0]) / (2 * half), (end[1] - start[1]) / (2 * half)
        return (start[0] + end[0]) / 2 - dy * rise, (start[1] + end[1]) / 2 + dx * rise

    def _set_place(self, command: Command) -> None:
        if not command.words:
            raise InputError(f"line {command.line}: G92 without an axis; name the axes it sets")
        if (e := self._number(command, "E")) is not None:
            self.e = e * self.scale
        for k, axis in enumerate("XYZ"):
            if (value := self._number(command, axis)) is None:
                continue
            # G92 renames the place the head is at; where that is unknown, what it says is taken for the machine's.
            here = self.place[k]
            if here is None:
                self.place[k] = here = value * self.scale
            self.shift[k] = here - value * self.scale

    def _home(self, command: Command) -> None:
        for axis in homed_axes(command):
            # Where the end stops are is the machine's affair: the place is known to it, not to the text.
            self.place["XYZ".index(axis)] = None
            self.shift["XYZ".index(axis)] = 0.0
