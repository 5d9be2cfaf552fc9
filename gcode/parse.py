"""Our own text back into the program it was emitted from, bit by bit.

For the text of other programs see `trace`.
"""

from __future__ import annotations

import re

from gcode.geometry import Curve, Point, Shape, Straight
from gcode.marlin import BEGIN, END, TITLE
from gcode.program import Clean, Comment, Dwell, Extrude, Prime, Program, Retract, Step, Travel, on_grid
from gcode.words import Command, read_commands
from skinfab.errors import InputError

_HEADER = re.compile(re.escape(TITLE) + r"\n; piece ?(.*)\n; printer .*\n; ink (\S+) mm of E for 1 mm\^3\n(?:; bead (\S+) mm\^2 .*\n)?")


def parse(text: str) -> Program:
    """The program of a text that `emit` wrote.

    Raises
    ------
    InputError
        The text is not of this project, or was changed so that it is no longer what `emit` writes; names the line.

    Examples
    --------
    >>> from gcode.marlin import emit
    >>> from gcode.printer import load_printer
    >>> program = Program("P1", (Travel(x=1.0, y=2.0, speed=50.0),))
    >>> parse(emit(program, load_printer())) == program
    True
    """
    header = _HEADER.match(text)
    if not header:
        raise InputError(f"line 1 is not {TITLE!r} with its facts below; only skinfab's own files can be parsed back, others only checked")
    e_per_mm3 = _positive(header[2], 4, "mm of E")
    bead_area = None if header[3] is None else _positive(header[3], 5, "mm^2")
    lines = text.split("\n")
    if BEGIN not in lines or END not in lines:
        raise InputError(f"the lines {BEGIN!r} and {END!r} are not both there; the file is cut off")
    first, last = lines.index(BEGIN) + 1, len(lines) - 1 - lines[::-1].index(END)
    reader = _Reader(e_per_mm3)
    steps = [reader.step(command) for command in read_commands("\n".join(["", *[""] * (first - 1), *lines[first:last]]))]
    return Program(header[1], tuple(steps), bead_area)


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

    def step(self, command: Command) -> Step:
        if not command.code:
            return Comment(command.comment)
        words = dict(command.words)
        if any(value is None for value in words.values()):
            raise InputError(f"line {command.line}: a word has no number")
        if command.code == "G4" and words.keys() == {"P"}:
            seconds = float(words["P"] or 0.0) / 1000
            return Clean(seconds) if command.comment == "clean" else Dwell(seconds)
        if (feed := words.pop("F", None)) is not None:
            self.speed = feed / 60
        if self.speed is None:
            raise InputError(f"line {command.line}: no speed F was given yet")
        if command.code == "G0" and words and words.keys() <= set("XYZ"):
            x, y, z = (words.get(axis) for axis in "XYZ")
            self.at = (self.at[0] if x is None else x, self.at[1] if y is None else y)
            return Travel(x, y, z, self.speed)
        if command.code == "G1" and words.keys() == {"E"}:
            volume = float(words["E"] or 0.0) / self.e_per_mm3
            rate = self.speed / self.e_per_mm3
            return Retract(-volume, rate) if volume < 0 else Prime(volume, rate)
        shape = self._shape(command, words)
        self.at = shape.end
        return Extrude(shape, float(words["E"] or 0.0) / self.e_per_mm3, self.speed)

    def _shape(self, command: Command, words: dict[str, float | None]) -> Shape:
        arc = command.code in ("G2", "G3")
        if words.keys() != (set("XYIJE") if arc else set("XYE")) or not (arc or command.code == "G1"):
            raise InputError(f"line {command.line}: {command.code} {' '.join(words)} is not what skinfab writes")
        if None in self.at:
            raise InputError(f"line {command.line}: it extrudes from an unknown place")
        start: Point = (float(self.at[0] or 0.0), float(self.at[1] or 0.0))
        x, y, i, j = (float(words.get(w) or 0.0) for w in "XYIJ")
        if not arc:
            return Straight(start, (x, y))
        return Curve(start, (x, y), (on_grid(start[0] + i), on_grid(start[1] + j)), clockwise=command.code == "G2")
