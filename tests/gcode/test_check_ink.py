"""Ink over wet ink is refused, at its line; neighbours along a path, pads and other strokes a bead away are not."""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.ops import substring

from gcode.check import check_text
from gcode.check_ink import CLOSE, TURN, ink_findings, laid_pieces
from gcode.emit import emit
from gcode.geometry import Curve, Shape
from gcode.moves import Finding, Move
from gcode.plan import Plan, plan
from gcode.printer import Printer, load_printer
from gcode.trace import trace
from skinfab.material import Material
from skinfab.patterns.registry import PATTERNS, make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor

HEAD = "G28 X Y\nG90\nM83\nM302 P1\nG0 Z10 F300\nG0 X100 Y100 F6000\nG0 Z1.6 F300\n"
LINE = "G1 X120 Y100 E80 F240\n"
LIFT = "G0 Z10 F300\n"


def found(body: str, printer: Printer) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in check_text(HEAD + body + LIFT, printer)]


def inked(text: str, printer: Printer) -> list[Finding]:
    judged = trace(text, spindle=printer.spindle)
    return list(ink_findings(judged, laid_pieces(judged, printer)))


def stroke(x: float, y: float, to: str, e: float) -> str:
    return f"{LIFT}G0 X{x} Y{y} F6000\nG0 Z1.6 F300\nG1 {to} E{e} F240\n"


@pytest.mark.parametrize(
    ("body", "line", "says"),
    [
        (
            LINE + stroke(110, 90, "X110 Y110", 80),
            12,
            "0.00 mm from the wet ink of line 8, centre to centre, where 0.76 is needed",
        ),  # crossed
        (LINE + "G1 X100 Y100 E80\n", 9, "wet ink of line 8"),  # retraced
        (LINE + LIFT + "G0 X110 Y100 F6000\nG0 Z1.6 F300\n", 11, "at X110.00 Y100.00 it comes down into the wet ink of line 8, 0.00 mm"),
        (LINE + LIFT + "G0 X110 Y100.3 F6000\nG0 Z1.6 F300\n", 11, "comes down into the wet ink of line 8, 0.30 mm"),
        (LINE + LIFT + "G0 X110 Y100.4 F6000\nG0 Z1.6 F300\n", None, ""),  # beside the bead
        (LINE + stroke(100, 100.6, "X120 Y100.6", 80), 12, "0.60 mm from the wet ink"),  # two strokes run together
        (LINE + stroke(100, 100.8, "X120 Y100.8", 80), None, ""),
        (
            LINE + stroke(100, 101.1, "X120 Y101.1", 320),
            12,
            "1.10 mm from the wet ink of line 8, centre to centre, where 1.16 is needed",
        ),  # one bead twice as wide
        (LINE + "G1 Y100.5 E2\nG1 X100 E80\n", None, ""),  # the rows of a pad
        (LINE + "G1 Y100.3 E1.2\nG1 X100 E80\n", 10, "0.30 mm from the wet ink"),
        ("G1 X110 E40 F240\nG1 Y110 E40\n", None, ""),  # a corner
        ("G1 X110 E40 F240\nG1 X101.34 Y105 E40\n", None, ""),  # one of 30 degrees
        ("G1 X110 E40 F240\nG1 X100.15 Y101.74 E40\n", 9, "wet ink of line 8"),  # one of 10
        ("G1 X110 E40 F240\nG3 X110 Y102 I0 J1 E12.6\nG1 X100 E40\n", None, ""),
        ("G1 X110 E40 F240\nG2 X110 Y102 I0 J1 E12.6\nG1 X100 E40\n", 9, "wet ink of line 8"),  # G2 for G3
        ("G1 X110 E40 F240\nG1 Y105 E20\nG1 X105 E20\nG1 Y95 E40\n", 11, "near X105.00 Y95.00 it lays ink 0.00 mm"),  # it crosses itself
        ("G3 X100 Y104 I0 J2 E25.2 F240\nG3 X100 Y100 I0 J-2 E25.2\nG1 X105 E20\n", 9, "wet ink of line 8"),  # round upon its start
        ("G3 X100 Y104 I0 J2 E25.2 F240\nG3 X100 Y100 I0 J-2 E25.2\n", None, ""),  # a ring that closes
        ("G3 X100 Y102 I0 J1 E12.6 F240\nG3 X100 Y100 I0 J-1 E12.6\n", None, ""),
        ("G3 X100 Y104 I0 J2 E25.2 F240\nG3 X100.3894 Y100.0383 I0 J-2 E26.8\n", 9, "wet ink of line 8"),  # and 0.4 mm more
        ("G1 X110 E40 F240\nG1 Y110 E40\nG1 X100 E40\nG1 Y100 E40\n", None, ""),  # a square
        ("G1 X110 E40 F240\nG1 Y110 E40\nG1 X100 E40\nG1 Y99 E44\n", 11, "wet ink of line 8"),
        ("G1 X110 E40 F240\nG1 Y110 E40\nG1 X105 E20\nG1 Y100 E40\n", 11, "wet ink of line 8"),  # it ends amid its own bead
        ("G1 X110 E40 F240\nG1 X108.66 Y105 E20.7\nG1 X100 Y100 E40\n", 10, "wet ink of line 8"),  # a corner of 30 degrees there
        ("G1 X110 E40 F240\nG4 P500\nG1 E-0.8 F300\nG1 E0.8\nG1 X120 E40 F240\n", None, ""),  # a pause, a retract and a prime
        ("G1 E5 F300\nG1 X120 E80 F240\n", None, ""),
    ],
)
def test_ink_and_ink(body: str, line: int | None, says: str, printer: Printer) -> None:
    faults = [(at, what) for at, what in found(body, printer) if "wet ink" in what]
    if line is None:
        assert not faults
    else:
        assert any(at == line and says in what for at, what in faults), faults


@pytest.mark.parametrize("shift", [0.0, 3.0])
@pytest.mark.parametrize("arcs", ["native", "lines"])
@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
def test_a_pattern_printed_twice(planned: Plan, shift: float, arcs: str, name: str) -> None:
    judge = load_printer(name)
    text = emit(planned.program, judge, arcs=arcs)  # type: ignore[arg-type]
    assert not inked(text, judge)
    lines = text.splitlines()
    starts = [k for k, line in enumerate(lines) if line.startswith("; pattern")]
    again = [re.sub(r"X(-?[\d.]+)", lambda m: f"X{float(m[1]) + shift:.4f}", line) for line in lines[starts[0] : starts[1]]]
    faults = inked("\n".join(lines[: starts[1]] + again + lines[starts[1] :]), judge)
    assert faults and all("wet ink of line" in f.what and f.line > starts[1] for f in faults)
    assert {f.pattern for f in faults} == {lines[starts[0]].removeprefix("; pattern ")}


@pytest.mark.parametrize("arcs", ["native", "lines"])
@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-marlin", "generic-grbl"])
@pytest.mark.parametrize("kind", sorted(PATTERNS))
def test_our_own_patterns_pass(kind: str, name: str, arcs: str, material: Material, make_piece: Callable[..., Piece]) -> None:
    """Pads, whose rows lie closer than a bead, hairpins, and the corners of each pattern; two of them, as near as they may be."""
    judge, pattern = load_printer(name), make_pattern(kind, {**PATTERNS[kind].example, "pad": 3.1})
    low, high = pattern.printed_path().bbox
    down = high[1] - low[1] + material.ink.bead_width + material.gap
    sensors = [Sensor(f"S{k}", "P1", pattern, 90.0, 20.0 - low[1] + k * down, 0.0, 0) for k in range(2)]
    planned = plan(make_piece(190, 190), sensors, printer=judge, material=material)
    text = emit(planned.program, judge, arcs=arcs)  # type: ignore[arg-type]
    assert [f for f in check_text(text, judge) if "wet ink" in f.what] == []


def test_an_arc_the_wrong_way_round(planned: Plan, printer: Printer) -> None:
    text, count = re.subn("^G3", "G2", emit(planned.program, printer), count=1, flags=re.MULTILINE)
    at = next(k for k, line in enumerate(text.splitlines(), 1) if line.startswith("G2 "))
    assert count == 1 and at in {f.line for f in check_text(text, printer) if "lays ink" in f.what}


def test_faulty_ink_hides_no_other_fault(printer: Printer) -> None:
    """Faults in the first two thousand pieces, then one among faultless ink far behind."""
    heap = "".join(f"G1 X{100 + 2 * (k % 2)} E8 F240\n" for k in range(1, 2001))
    rows = "".join(f"G1 X{200 - 0.3 * k:.1f} Y{110 + 0.01 * (k % 2):.2f} E1.2\n" for k in range(1, 301))
    body = heap + LIFT + "G0 X200 Y110\nG0 Z1.6\n" + rows + stroke(150, 105, "X150 Y115", 40)
    lines = [at for at, what in found(body, printer) if "lays ink" in what]
    assert lines[0] == 9 and lines[-1] == (HEAD + body).count("\n") and len(lines) == 2000


def test_short_pieces_are_joined_without_losing_a_fault(printer: Printer) -> None:
    """A micrometre at a time: as long as the pieces of the stroke they run along, and then over another."""
    steps = "".join(f"G1 Y{99.5 + 0.0009 * k:.4f} E0.0036\n" for k in range(1, 1111))
    clear = LINE + LIFT + "G0 X110 Y98.1\nG0 Z1.6\n" + re.sub(r"Y(\S+)", lambda m: f"Y{float(m[1]) - 1.4:.4f}", steps) + LIFT
    assert not [f for f in check_text(HEAD + clear, printer) if "wet ink" in f.what]
    faults = [f for f in check_text(HEAD + LINE + LIFT + "G0 X110 Y99.5\nG0 Z1.6\n" + steps, printer) if "lays ink" in f.what]
    assert faults and "line 8" in faults[0].what
    assert faults[0].line == pytest.approx(12, abs=20)  # within the pieces joined to one


STEP = st.tuples(st.sampled_from(["line", "arc", "lift"]), st.floats(-3.1, 3.1), st.floats(0.3, 4.0), st.floats(-2.5, 2.5))


def drawn(steps: list[tuple[str, float, float, float]], thickness: list[float]) -> str:
    """A scribble: lines, arcs and lifts; each stroke with a bead of its own."""
    x, y, strokes, text = 100.0, 100.0, 0, HEAD
    for kind, heading, size, bend in steps:
        area = thickness[strokes % len(thickness)]
        if kind == "lift":
            x, y, strokes = round(x + size * math.cos(heading), 4), round(y + size * math.sin(heading), 4), strokes + 1
            text += f"{LIFT}G0 X{x:.4f} Y{y:.4f} F6000\nG0 Z1.6 F300\n"
        elif kind == "line" or abs(bend) < 0.05:
            x, y = round(x + size * math.cos(heading), 4), round(y + size * math.sin(heading), 4)
            text += f"G1 X{x:.4f} Y{y:.4f} E{size * area * 8.2644628:.5f} F240\n"
        else:
            i, j = size * math.cos(heading), size * math.sin(heading)
            turned = math.pi + heading + bend
            x, y = round(x + i + size * math.cos(turned), 4), round(y + j + size * math.sin(turned), 4)
            text += f"G{3 if bend > 0 else 2} X{x:.4f} Y{y:.4f} I{i:.4f} J{j:.4f} E{abs(bend) * size * area * 8.2644628:.5f} F240\n"
    return text + LIFT


def line_of(shape: Shape) -> shapely.LineString:
    parts = shape.chords(1e-4) if isinstance(shape, Curve) else (shape,)
    return shapely.LineString([parts[0].start, *(p.end for p in parts)])


def rooms(moves: list[Move], printer: Printer) -> dict[int, float]:
    """By shapely and brute force: for each line that lays ink or comes down, room beyond what is needed, mm."""
    room: dict[int, float] = {}
    strokes: list[list[tuple[Move, shapely.LineString, float]]] = [[]]
    lengths = stroke_lengths(moves)
    for move in moves:
        if move.e > 0 and move.shape is not None:
            line = line_of(move.shape)
            radius = math.sqrt(move.e / printer.pump.e_per_mm3 / move.shape.length / math.pi)
            least = [line.distance(other) - radius - r for stroke in strokes[:-1] for _, other, r in stroke]
            way = sum(other.length for _, other, _ in strokes[-1])
            begun = 0.0
            for _, other, r in strokes[-1]:
                least.append(within_a_stroke(line, way, other, begun, r, lengths[len(strokes) - 1]))
                begun += other.length
            least.append(within_a_stroke(line, way, line, way, radius, lengths[len(strokes) - 1]))
            strokes[-1].append((move, line, radius))
            room[move.line] = min(least)
        elif move.start[2] != move.end[2] or move.shape is not None:
            here = shapely.Point(move.end[0], move.end[1] or 0.0) if move.end[0] is not None else None
            if here is not None and (move.end[2] or 0.0) < 5.0:
                room[move.line] = min([other.distance(here) - r for stroke in strokes for _, other, r in stroke], default=math.inf)
            strokes.append([])
    return room


def stroke_lengths(moves: list[Move]) -> list[float]:
    lengths = [0.0]
    for move in moves:
        if move.e > 0 and move.shape is not None:
            lengths[-1] += line_of(move.shape).length
        elif move.start[2] != move.end[2] or move.shape is not None:
            lengths.append(0.0)
    return lengths


def within_a_stroke(line: shapely.LineString, way: float, other: shapely.LineString, begun: float, radius: float, length: float) -> float:
    """Room of the places of `line` from what of `other` was laid so far before."""
    least = math.inf
    for s in np.linspace(0.0, line.length, 200):
        until = way + s - TURN * radius - begun
        since = CLOSE * radius - begun if way + s > length - CLOSE * radius else 0.0  # the end of a ring upon its start
        if until > max(since, 0.0) and since < other.length:
            laid = substring(other, max(since, 0.0), min(until, other.length))
            least = min(least, laid.distance(line.interpolate(s)) - radius)
    return least


@given(st.lists(STEP, min_size=2, max_size=7), st.lists(st.floats(0.1, 1.0), min_size=1, max_size=3))
@settings(max_examples=60, deadline=None)
def test_against_brute_force(printer: Printer, steps: list, thickness: list[float]) -> None:
    judged = trace(drawn(steps, thickness))
    faulty = {f.line for f in ink_findings(judged, laid_pieces(judged, printer))}
    for line, room in rooms(list(judged.moves), printer).items():
        if room < -0.05:  # chords, joined pieces and places are rounded, and brute force steps along
            assert line in faulty, (line, room)
        elif room > 0.0:
            assert line not in faulty, (line, room)
