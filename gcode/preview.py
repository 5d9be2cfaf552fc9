"""The tool path of a G-code text as SVG, 1:1 in millimetres with true arcs, coloured by what the head does there."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gcode.check_height import at_cleaning_place, bead_radius
from gcode.geometry import Curve, Point, Shape, Straight, joined_box
from gcode.moves import Move, Trace
from gcode.printer import Printer
from gcode.program import CLEAN, PRINT_OVERRUN, XY_DECIMALS
from gcode.trace import trace
from skinfab.files import atomic_write

#: What the head does, the colour of it, and its words in the legend; drawn in this order. The eight colours of Okabe and Ito
#: ("Color Universal Design", 2008) are told apart with any kind of colour blindness.
ROLES = {
    "print": ("#000000", "print"),
    "print-overrun": ("#0072b2", "print-overrun: ink beyond the path"),
    "travel": ("#56b4e9", "travel, above the walls"),
    "prime": ("#d55e00", "prime"),
    "retract": ("#cc79a7", "retract"),
    "overrun": ("#e69f00", "overrun: low, without ink"),
    "cleaning": ("#009e73", "cleaning"),
}

#: Roles with ink along a way.
_INKED = ("print", "print-overrun")

#: White border round what is shown, the height of a letter and of a row of the legend, and the narrowest sheet, mm.
MARGIN_MM, TEXT_MM, ROW_MM, NARROWEST_MM = 8.0, 3.0, 4.5, 70.0

#: SVG gives an arc by its ends and radius; near half a turn the centre is then ill-determined.
_LONGEST_ARC = 2 * math.pi / 3

#: Widths of lines without ink, and the radius of a dot, mm.
_THIN, _DOT = 0.25, 0.5


@dataclass(frozen=True)
class Stroke:
    """One move as it is drawn: a shape, or a place where ink moves at standstill; `width` in mm."""

    role: str
    shape: Shape | None
    at: Point
    width: float
    pattern: str
    line: int = 0  # of the text


def strokes(judged: Trace, printer: Printer) -> Iterator[Stroke]:
    """What each move is, by its height and its ink, in order; moves from or to an unknown place are left out.

    Examples
    --------
    >>> from gcode.printer import load_printer
    >>> text = "G90\\nM83\\nM302 P1\\nG0 Z10 F300\\nG0 X1 Y1\\nG0 X9\\nG0 Z1.6\\nG0 X10\\nG1 E1\\nG1 X20 E40"
    >>> [s.role for s in strokes(trace(text), load_printer())]
    ['travel', 'overrun', 'prime', 'print']
    """
    beyond, cleaned = _said(judged)
    for move in judged.moves:
        x, y = move.end[:2]
        if x is None or y is None:
            continue
        if move.shape is not None:
            role = _role(move, printer, beyond)
            width = 2 * bead_radius(move, printer) if role in _INKED else _THIN if role == "travel" else 2 * _THIN
            yield Stroke(role, move.shape, (x, y), width, move.pattern, move.line)
        elif move.e and not move.is_planar:
            yield Stroke("prime" if move.e > 0 else "retract", None, (x, y), _DOT, move.pattern, move.line)
        if move.line in cleaned:
            yield Stroke("cleaning", None, (x, y), 2 * _DOT, move.pattern, move.line)


def _said(judged: Trace) -> tuple[set[int], set[int]]:
    """Lines of ink beyond a path, and of the last move before each wait at the cleaning place."""
    moves = {move.line for move in judged.moves}
    beyond, cleaned = set(), set()
    last, said = 0, ""
    for command in judged.commands:
        if not command.code:
            said = command.comment
        elif command.code == "G4" and command.comment == CLEAN:
            cleaned.add(last)
        elif command.line in moves:
            last = command.line
            if said == PRINT_OVERRUN:
                beyond.add(last)
    return beyond, cleaned


def _role(move: Move, printer: Printer, beyond: Container[int]) -> str:
    if move.e > 0:
        return "print-overrun" if move.line in beyond else "print"
    heights = [z for z in (move.start[2], move.end[2]) if z is not None]
    if not heights or min(heights) >= printer.heights.travel - 10**-XY_DECIMALS:
        return "travel"
    return "cleaning" if at_cleaning_place(move, min(heights), printer) else "overrun"


def draw_toolpath(
    text: str, path: str | Path, *, printer: Printer, title: str = "", outline: ArrayLike | None = None, shift: Point = (0.0, 0.0)
) -> None:
    """Write the tool path of a G-code text.

    What is shown is where ink is laid, with a border; travels to the park or the cleaning place leave the picture.

    Parameters
    ----------
    text : str
        Ours or any other.
    path : path
        An SVG file.
    printer : Printer
    title : str, optional
    outline : (n, 2, 2) float, mm, optional
        Edges of the piece, drawn as the mould's wall.
    shift : (x, y), mm
        Added to the outline: where the piece lies on the bed.

    Raises
    ------
    InputError
        A line of the text cannot be read, or the file cannot be written.
    """
    drawn = list(strokes(trace(text, spindle=printer.spindle, motion=printer.motion), printer))
    wall = np.zeros((0, 2, 2)) if outline is None else np.asarray(outline, dtype=float) + shift
    (x0, y0), (x1, y1) = _shown(drawn, wall)
    used = [role for role in ROLES if any(s.role == role for s in drawn)]
    width = max(x1 - x0 + 2 * MARGIN_MM, NARROWEST_MM)
    head = MARGIN_MM + ROW_MM * (1 + len(used))
    height = y1 - y0 + head + 2 * MARGIN_MM
    # From machine coordinates, y up, to the sheet's, y down.
    place = f"matrix(1 0 0 -1 {_n(MARGIN_MM - x0)} {_n(head + MARGIN_MM + y1)})"
    clip = f'<clipPath id="c"><rect x="0" y="{_n(head)}" width="{_n(width)}" height="{_n(height - head)}"/></clipPath>'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(width)}mm" height="{_n(height)}mm" viewBox="0 0 {_n(width)} {_n(height)}">',
        f"<style>text{{font:{TEXT_MM:g}px sans-serif;fill:#212f3d;dominant-baseline:central}}</style>{clip}",
        f'<rect width="{_n(width)}" height="{_n(height)}" fill="#fff"/>',
        f'<text x="{_n(MARGIN_MM)}" y="{_n(MARGIN_MM)}" font-weight="bold">{escape(title)}</text>',
        *_legend(drawn, used),
        f'<g clip-path="url(#c)"><g transform="{place}" fill="none" stroke-linecap="round" stroke-linejoin="round">',
        *_wall(wall),
        *(_group(role, [s for s in drawn if s.role == role]) for role in used),
        "</g></g>",
        "</svg>",
    ]
    atomic_write(path, "\n".join(lines) + "\n")


def _shown(drawn: Sequence[Stroke], wall: NDArray[np.float64]) -> tuple[Point, Point]:
    boxes = [s.shape.bbox for s in drawn if s.role in _INKED and s.shape] or [(s.at, s.at) for s in drawn] or [((0.0, 0.0), (0.0, 0.0))]
    if len(wall):
        low, high = wall.reshape(-1, 2).min(axis=0), wall.reshape(-1, 2).max(axis=0)
        boxes = [*boxes, ((float(low[0]), float(low[1])), (float(high[0]), float(high[1])))]
    return joined_box(boxes)


def _legend(drawn: Sequence[Stroke], used: Sequence[str]) -> Iterator[str]:
    for k, role in enumerate(used, 1):
        colour, words = ROLES[role]
        y = MARGIN_MM + ROW_MM * k
        mine = [s for s in drawn if s.role == role]
        length = sum(s.shape.length for s in mine if s.shape)
        dots = [s for s in mine if not s.shape]
        amount = f"{len(dots)} time{'s' * (len(dots) > 1)}" if dots else f"{length:.0f} mm"
        if role == "cleaning" and dots:  # most often beyond what is shown
            amount += f" at X{_n(dots[0].at[0])} Y{_n(dots[0].at[1])}"
        yield f'<line x1="{_n(MARGIN_MM)}" y1="{_n(y)}" x2="{_n(MARGIN_MM + 6)}" y2="{_n(y)}" stroke="{colour}" stroke-width="1"/>'
        yield f'<text x="{_n(MARGIN_MM + 8)}" y="{_n(y)}">{words}: {amount}</text>'


def _wall(wall: NDArray[np.float64]) -> Iterator[str]:
    if len(wall):
        edges = " ".join(f"M{_n(a[0])} {_n(a[1])}L{_n(b[0])} {_n(b[1])}" for a, b in wall)
        yield f'<path class="wall" d="{edges}" stroke="#aab7b8" stroke-width="0.4"/>'


def _group(role: str, mine: Sequence[Stroke]) -> str:
    colour, _ = ROLES[role]
    body = []
    at: Point | None = None
    words: list[str] = []
    width = 0.0
    for s in mine:
        if s.shape is None:
            body.append(f'<circle cx="{_n(s.at[0])}" cy="{_n(s.at[1])}" r="{_n(s.width)}" fill="{colour}"/>')
            continue
        if words and abs(s.width - width) > _THIN / 10:
            body.append(_stroked(words, width))
            words, at = [], None
        width = s.width
        words += ([] if s.shape.start == at else [f"M{_n(s.shape.start[0])} {_n(s.shape.start[1])}"]) + _to(s.shape)
        at = s.shape.end
    if words:
        body.append(_stroked(words, width))
    dashes = ' stroke-dasharray="1 0.8"' if role == "travel" else ""
    return f'<g class="{role}" stroke="{colour}"{dashes}>' + "".join(body) + "</g>"


def _stroked(words: Sequence[str], width: float) -> str:
    return f'<path d="{"".join(words)}" stroke-width="{_n(width)}"/>'


def _to(shape: Shape) -> list[str]:
    if isinstance(shape, Straight):
        return [f"L{_n(shape.end[0])} {_n(shape.end[1])}"]
    parts: Sequence[Curve] = shape.split(max(math.ceil(abs(shape.sweep) / _LONGEST_ARC), 1))
    side = 0 if shape.clockwise else 1  # before y is turned over
    return [f"A{_n(p.radius)} {_n(p.radius)} 0 0 {side} {_n(p.end[0])} {_n(p.end[1])}" for p in parts]


def _n(value: float) -> str:
    """Three decimals, no exponent, no needless zeros."""
    return f"{value:.3f}".rstrip("0").rstrip(".") or "0"
