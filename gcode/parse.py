"""Our own text back into the program it was emitted from, bit by bit.

For the text of other programs see `trace`.
"""

from __future__ import annotations

import re

from gcode.emit import BEGIN, END, TITLE
from gcode.geometry import Curve, Point, Shape, Straight
from gcode.grbl import volume_along
from gcode.program import CLEAN, Clean, Comment, Dwell, Extrude, Prime, Program, Retract, Step, Travel, on_grid
from gcode.words import Command, lines_of, read_commands
from skinfab.errors import InputError

_HEADER = re.compile(
    re.escape(TITLE)
    + r"\n; piece ?(.*)\n; printer .*\n; ink (?:(\S+) mm of E for 1 mm\^3|S(\S+) for 1 mm\^3/s)\n(?:; bead (\S+) mm\^2 .*\n)?"
)


def parse(text: str) -> Program:
    """The program of a text that `emit` wrote.

    Raises
    ------
    InputError
        The text is not of this project, or was changed so that it is no longer what `emit` writes; names the line.

    Examples
    --------
    >>> from gcode.emit import emit
    >>> from gcode.printer import load_printer
    >>> program = Program("P1", (Travel(x=1.0, y=2.0, speed=50.0),))
    >>> parse(emit(program, load_printer())) == program
    True
    """
    lines = lines_of(text)
    header = _HEADER.match("\n".join(lines))
    if not header:
        raise InputError(f"line 1 is not {TITLE!r} with its facts below; only skinfab's own files can be parsed back, others only checked")
    bead_area = None if header[4] is None else _positive(header[4], 5, "mm^2")
    if BEGIN not in lines or END not in lines:
        raise InputError(f"the lines {BEGIN!r} and {END!r} are not both there; the file is cut off")
    first, last = lines.index(BEGIN) + 1, len(lines) - 1 - lines[::-1].index(END)
    reader = _Reader(_positive(header[2], 4, "mm of E")) if header[2] else _SpindleReader(_positive(header[3], 4, "S"))
    steps = [reader.step(command) for command in read_commands("\n".join(["", *[""] * (first - 1), *lines[first:last]]))]
    return Program(header[1], tuple(step for step in steps if step is not None), bead_area)


def _positive(text: str, line: int, unit: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise InputError(f"line {line}: {text!r} is no positive number of {unit}")
    return value


class _Reader:
    """Follows the head's place and the sticky F."""

    def __init__(self, e_per_mm3: float) -> None:
        self.e_per_mm3 = e_per_mm3
        self.speed: float | None = None
        self.at: tuple[float | None, float | None] = (None, None)

    def step(self, command: Command) -> Step | None:
        """The step that a line says."""
        if not command.code:
            return Comment(command.comment)
        words = self.words(command)
        if command.code == "G4" and words.keys() == {"P"}:
            seconds = float(words["P"] or 0.0) / 1000
            return Clean(seconds) if command.comment == CLEAN else Dwell(seconds)
        speed = self.fed(command, words)
        if command.code == "G0" and words and words.keys() <= set("XYZ"):
            return self.travel(words, speed)
        if command.code == "G1" and words.keys() == {"E"}:
            volume = float(words["E"] or 0.0) / self.e_per_mm3
            rate = speed / self.e_per_mm3
            return Retract(-volume, rate) if volume < 0 else Prime(volume, rate)
        shape = self.shape(command, words, "E")
        return Extrude(shape, float(words["E"] or 0.0) / self.e_per_mm3, speed)

    @staticmethod
    def words(command: Command) -> dict[str, float | None]:
        """Its words, each with a number."""
        if any(value is None for value in command.words.values()):
            raise InputError(f"line {command.line}: a word has no number")
        return dict(command.words)

    def fed(self, command: Command, words: dict[str, float | None]) -> float:
        """The speed that holds from this line on; its F is taken out of `words`."""
        if (feed := words.pop("F", None)) is not None:
            self.speed = feed / 60
            if not self.speed > 0:
                raise InputError(f"line {command.line}: F{feed:g} is no speed, which skinfab does not write")
        if self.speed is None:
            raise InputError(f"line {command.line}: no speed F was given yet")
        return self.speed

    def travel(self, words: dict[str, float | None], speed: float) -> Travel:
        """A move without ink."""
        x, y, z = (words.get(axis) for axis in "XYZ")
        self.at = (self.at[0] if x is None else x, self.at[1] if y is None else y)
        return Travel(x, y, z, speed)

    def shape(self, command: Command, words: dict[str, float | None], ink: str) -> Shape:
        """A line or an arc with ink, and the head goes to its end."""
        shape = self._shape(command, words, ink)
        self.at = shape.end
        return shape

    def _shape(self, command: Command, words: dict[str, float | None], ink: str) -> Shape:
        arc = command.code in ("G2", "G3")
        if words.keys() != {*("XYIJ" if arc else "XY"), *ink} or not (arc or command.code == "G1"):
            raise InputError(f"line {command.line}: {command.code} {' '.join(words)} is not what skinfab writes")
        if None in self.at:
            raise InputError(f"line {command.line}: it extrudes from an unknown place")
        start: Point = (float(self.at[0] or 0.0), float(self.at[1] or 0.0))
        x, y, i, j = (float(words.get(w) or 0.0) for w in "XYIJ")
        if not arc:
            return Straight(start, (x, y))
        return Curve(start, (x, y), (on_grid(start[0] + i), on_grid(start[1] + j)), clockwise=command.code == "G2")


class _SpindleReader(_Reader):
    """Follows the pump, too, which is GRBL's spindle."""

    def __init__(self, s_per_flow: float) -> None:
        super().__init__(1.0)
        self.s_per_flow = s_per_flow
        self.flow = 0.0  # mm^3/s, backward negative

    def step(self, command: Command) -> Step | None:
        """The step that a line says, or None for a turn of the pump."""
        if not command.code:
            return Comment(command.comment)
        words = self.words(command)
        if command.code in ("M3", "M4") and words.keys() == {"S"}:
            self.flow = float(words["S"] or 0.0) / self.s_per_flow * (1 if command.code == "M3" else -1)
            return None
        if command.code == "M5" and not words:
            self.flow = 0.0
            return None
        if command.code == "G4" and words.keys() == {"P"}:
            return self._wait(command, float(words["P"] or 0.0))
        speed = self.fed(command, words)
        if not self.flow and command.code == "G1" and words and words.keys() <= set("XYZ"):
            return self.travel(words, speed)
        if self.flow < 0:
            raise InputError(f"line {command.line}: it moves while the pump turns back, which skinfab does not write")
        shape = self.shape(command, words, "")
        return Extrude(shape, volume_along(shape, self.flow, speed), speed)

    def _wait(self, command: Command, seconds: float) -> Step:
        if self.flow:
            rate = abs(self.flow)
            return Prime(rate * seconds, rate) if self.flow > 0 else Retract(rate * seconds, rate)
        return Clean(seconds) if command.comment == CLEAN else Dwell(seconds)
