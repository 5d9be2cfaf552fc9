"""What a printer would do with any G-code text: its moves, read as Marlin reads them.

A fault of the text that still leaves a clear motion becomes a `Finding`; a text without a clear motion
is an InputError that names the line.
"""

from __future__ import annotations

import math
from dataclasses import replace

from gcode.geometry import Point
from gcode.moves import Finding, Home, Move, Place, Trace
from gcode.printer import Motion, Spindle
from gcode.words import MODAL, MOTORS_OFF, SETTING, Command, read_commands
from skinfab.errors import InputError

#: What a line may have of what counts (`Command.size`): Marlin's MAX_CMD_SIZE and GRBL's LINE_BUFFER_SIZE, each without the
#: zero at its end. Marlin cuts the rest off in silence, GRBL refuses the line (its error 11).
MARLIN_LINE, GRBL_LINE = 95, 79
MM_PER_INCH = 25.4


def trace(text: str, *, spindle: Spindle | None = None, motion: Motion | None = None) -> Trace:
    """Follow a text as Marlin would, or as GRBL where a spindle is the pump.

    With a `spindle`, E of a move is what the pump gives while it lasts, mm^3; a wait with the pump on is a move
    without a way. `motion` says how fast GRBL's G0 goes; without it the speed of a G0 is None.

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
    judged, fault = trace_as_far(text, spindle=spindle, motion=motion)
    if fault:
        raise fault
    return judged


def trace_as_far(text: str, *, spindle: Spindle | None = None, motion: Motion | None = None) -> tuple[Trace, InputError | None]:
    """As `trace`, up to the line that cannot be read or followed, and what is wrong with it."""
    head, commands, fault = _Head(spindle, motion), [], None
    try:
        for told in read_commands(text, blocks=spindle is not None):
            command = head.continued(told)
            if not head.passes_over(command):
                head.follow(command)
                commands.append(command)
    except InputError as stopped:
        fault = stopped
    return Trace(tuple(head.moves), tuple(head.faults), tuple(commands), tuple(head.homes)), fault


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

    def __init__(self, spindle: Spindle | None, motion: Motion | None) -> None:
        self.spindle = spindle
        self.limits = motion
        self.flow = 0.0  # of that spindle, mm^3/s, backward negative
        self.spindle_s = 0.0  # the last S
        self.turn = "M5"  # which way it turns
        self.motion = "G0" if spindle else ""  # what a line without a G goes on with; GRBL starts with G0
        self.moves: list[Move] = []
        self.homes: list[Home] = []
        self.long_line = 0  # the last that was told to be too long
        self.ended: Command | None = None  # an M2 or M30
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
        self.homed: set[str] = set()  # axes that the file has homed, and whose motors hold since

    def passes_over(self, command: Command) -> bool:
        """A G28 O does nothing where every axis is homed (Marlin's G28.cpp)."""
        asked_if_needed = command.code == "G28" and command.words.get("O", 0.0) != 0.0 and self.spindle is None
        return asked_if_needed and len(self.homed) == len("XYZ")

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
        code = command.code
        if code and command.size > (GRBL_LINE if self.spindle else MARLIN_LINE):
            self._too_long(command)
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
        elif code in MOTORS_OFF:
            self.homed.clear()
        elif self.spindle and code in ("M3", "M4", "M5", "M2", "M30"):
            self._turn_pump(command, self.spindle)
            if code in ("M2", "M30"):
                # What GRBL resets there; units, F and offsets stay.
                self.relative, self.motion, self.ended = False, "G1", command
        elif self.spindle and code == "G4" and self.flow:
            self._pump_at_rest(command)
        elif code in ("G5", "G18", "G19"):
            raise InputError(f"line {command.line}: {code} is not supported; use lines and arcs in the XY plane")

    def _fault(self, command: Command, what: str, remedy: str) -> None:
        self.faults.append(Finding(command.line, what, remedy, self.pattern))

    def _too_long(self, command: Command) -> None:
        if command.line == self.long_line:
            return  # another code of the same line
        self.long_line = command.line
        if self.spindle:
            remedy = "shorten its numbers, or give each code a line of its own"
            what = f"it is {command.size} characters long without blanks and comments, GRBL takes {GRBL_LINE} and halts there"
        else:
            remedy = "shorten its numbers"
            what = f"it is {command.size} bytes long without its comment, Marlin cuts behind {MARLIN_LINE}"
        self._fault(command, what, remedy)

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
            unset = feed == 0 and self.spindle is not None and command.code in ("G0", SETTING)
            if feed <= 0 and not unset:
                raise InputError(f"line {command.line}: F is {feed:g}; a speed must be positive")
            # GRBL takes F0 where it needs no F, and has no speed from there on.
            self.speed = None if unset else feed * self.scale / 60

    def _move(self, command: Command) -> None:
        self._feed(command)
        end = self._target(command)
        e = self._ink(command)
        centre = self._centre(command, end) if command.code in ("G2", "G3") else None
        if centre is not None or e or any(axis in command.words for axis in "XYZ"):
            start = (self.place[0], self.place[1], self.place[2])
            to = (end[0], end[1], end[2])
            rapid = self.spindle is not None and command.code == "G0"
            speed = self._rapid_speed(start, to) if rapid else self.speed
            adrift = self.relative and any(axis in command.words and value is None for axis, value in zip("XY", end, strict=False))
            move = Move(command.line, start, to, centre, command.code == "G2", e, speed, self.pattern, rapid, adrift)
            if self.ended:
                self._moves_behind_the_end(command, self.ended)
            if rapid and self.flow:
                self._fault(
                    command, "the pump runs while G0 moves as fast as the machine can, whatever F says", "write G1 with F, or M5 before it"
                )
            self.moves.append(replace(move, e=self._pumped(move)) if self.spindle else move)
        self.place = end

    def _moves_behind_the_end(self, command: Command, ended: Command) -> None:
        self._fault(command, f"it moves behind the {ended.code} of line {ended.line}, where many senders stop", "put the end last")
        self.ended = None  # told once

    def _rapid_speed(self, start: Place, end: Place) -> float | None:
        """Of GRBL's G0, mm/s: X and Y by the one limit, Z by the other; a way nobody knows is taken for one in X or Y."""
        if self.limits is None:
            return None
        x, y, rise = (abs(b - a) if a is not None and b is not None else 0.0 for a, b in zip(start, end, strict=True))
        flat = math.hypot(x, y)
        seconds = max(flat / self.limits.max_speed, rise / self.limits.z_speed)
        return math.hypot(flat, rise) / seconds if seconds > 0 else self.limits.max_speed

    def _turn_pump(self, command: Command, spindle: Spindle) -> None:
        s = self._number(command, "S")
        if s is not None and s < 0:
            self._fault(command, f"S{s:g} is negative, and GRBL halts there", "make S positive; M4 turns the pump back")
        elif s is not None:
            self.spindle_s = s
            if s > spindle.s_max:
                self._fault(command, f"S{s:g} is not within 0 and the spindle's {spindle.s_max:g}", "lower the flow, or raise $30")
        self.turn = command.code if command.code.startswith("M") else self.turn
        sign = {"M3": 1.0, "M4": -1.0}.get(self.turn, 0.0)
        self.flow = sign * self.spindle_s / spindle.s_per_flow

    def _pump_at_rest(self, command: Command) -> None:
        seconds = max(command.words.get("P") or 0.0, 0.0)  # what else it may be is a fault of its own
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
        if value is None or self.spindle:
            return 0.0  # GRBL has no E, which is a fault of its own
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
        z, lift = self.place[2], (command.words.get("R") or 0.0) * self.scale  # R: it rises by so much before (Marlin)
        self.homes.append(Home(command.line, homed_axes(command), None if z is None else z + lift, self.pattern))
        self.homed.update(homed_axes(command))
        for axis in homed_axes(command):
            # Where the end stops are is the machine's affair: the place is known to it, not to the text.
            self.place["XYZ".index(axis)] = None
            self.shift["XYZ".index(axis)] = 0.0
