"""Where emitters fail: far from the origin, arcs too small for the text's grid, 1e5 segments. Naive ones do; ours does not."""

import itertools
import math
import sys
import tracemalloc
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gcode import check_ink
from gcode.check import check_program, check_text
from gcode.check_ink import ink_findings, laid_pieces
from gcode.clearance import Laid
from gcode.emit import emit
from gcode.geometry import Curve, Straight, shape_of
from gcode.parse import parse
from gcode.printer import load_printer
from gcode.program import Comment, Extrude, Prime, Program, Retract, Travel, quantised
from gcode.trace import trace
from skinfab.paths import Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.tolerances import ARC_RADIUS_MM

PRINTER = load_printer()
#: For programs that are a path and nothing else.
BARE = replace(PRINTER, pump=replace(PRINTER.pump, prime=0.0, retract=0.0))
E_PER_MM3 = PRINTER.pump.e_per_mm3
AREA = 0.484  # mm^2
HEAD = "G28 X Y\nG21\nG90\nM83\nM302 P1\nG0 Z10 F300\n"


def naive(path: Path, number: Callable[[float], str]) -> str:
    """An emitter as first written: each number rounded by itself, the centre's offset from the exact start."""
    lines = [f"G0 X{number(path.start[0])} Y{number(path.start[1])} F6000", "G0 Z1.6 F300"]
    for shape in map(shape_of, path.segments):
        words = f"X{number(shape.end[0])} Y{number(shape.end[1])}"
        code = "G1"
        if isinstance(shape, Curve):
            code = "G2" if shape.clockwise else "G3"
            words += f" I{number(shape.centre[0] - shape.start[0])} J{number(shape.centre[1] - shape.start[1])}"
        lines.append(f"{code} {words} E{shape.length * AREA * E_PER_MM3:.5f} F240")
    return HEAD + "\n".join([*lines, "G0 Z10 F300", ""])


def ours(path: Path) -> Program:
    shapes = [shape_of(s) for s in path.segments]
    around = (Travel(z=10.0, speed=5.0), Comment("pattern C1"), Travel(*shapes[0].start, speed=100.0), Travel(z=1.6, speed=5.0))
    extrusions = tuple(Extrude(s, AREA * s.length, 4.0) for s in shapes)
    return quantised(Program("P1", (*around, *extrusions, Travel(z=10.0, speed=5.0)), AREA), e_per_mm3=E_PER_MM3)


def far_spirals() -> list[Path]:
    """Spirals turned anyhow in the bed's far corner, where a place takes seven digits."""
    spiral = ContactSpiral(n=4, x=1.9, b=3.1, l=5.3, s=27.0).path()
    return [spiral.transformed(angle=0.37 * k, shift=(310.0 + 0.1234567 * k, 311.0 - 0.0654321 * k)) for k in range(20)]


@pytest.mark.parametrize("number", ["{:.2f}".format, "{:g}".format, "{:.3f}".format], ids=["two decimals", "%g", "three decimals"])
def test_rounding_far_from_the_origin(number: Callable[[float], str]) -> None:
    jumps = [m.shape.radius_error for path in far_spirals() for m in trace(naive(path, number)).moves if isinstance(m.shape, Curve)]
    two = number(1 / 3) == "0.33"
    assert max(jumps) > (0.01 if two else 0.0005)  # the head jumps there
    if two:
        assert any("off the circle" in f.what for path in far_spirals() for f in check_text(naive(path, number), PRINTER))
    for path in far_spirals():
        program = ours(path)
        errors = [s.shape.radius_error for s in program.steps if isinstance(s, Extrude) and isinstance(s.shape, Curve)]
        assert max(errors) < 3e-4 < ARC_RADIUS_MM
        assert check_program(program, BARE) == ()
        assert parse(emit(program, BARE)) == program


def test_exponents_and_signs_of_zero() -> None:
    """At 350 mm one tenth of a micrometre is asked for: %g writes 350 for 350.0001 and 1e-05 for a small offset."""
    tiny = Straight((350.0 - 1e-4, 1e-5), (350.0, -1e-9))
    assert f"{tiny.start[0]:g}" == "350" and "e" in f"{tiny.start[1]:g}"
    program = Program(
        "P1", (Travel(*tiny.start, speed=10.0), Extrude(tiny, 1e-7, 4.0), Extrude(Straight(tiny.end, (349.0, 0.0)), 0.5, 4.0))
    )
    body = emit(program, PRINTER).partition("; begin")[2]
    assert "e-" not in body and "-0.0000" not in body and "X349.9999" in body


@pytest.mark.parametrize("radius", [3e-5, 1e-4, 1e-3])
def test_arcs_smaller_than_the_grid(radius: float) -> None:
    """A naive emitter turns a tiny arc into a full circle, or into one about another centre."""
    start = (100.00002, 50.00002)
    curve = Curve(start, (start[0] + 2 * radius, start[1]), (start[0] + radius, start[1]), clockwise=True)
    path = Path((shape_of_line((90.0, 50.00002), start), curve.segment, shape_of_line(curve.end, (110.0, 50.00002))))
    if radius < 1e-4:
        with pytest.raises(Exception, match="the arc's centre is its start"):
            trace(naive(path, "{:.4f}".format))
    drawn = [m.shape for m in trace(naive(path, "{:.3f}".format).replace("I0.000 ", "I0.001 ")).moves if isinstance(m.shape, Curve)]
    if radius <= 1e-4:
        assert drawn[0].start == drawn[0].end and abs(drawn[0].sweep) == pytest.approx(math.tau)  # a whole circle
    program = ours(path)
    shapes = [s.shape for s in program.steps if isinstance(s, Extrude)]
    assert not any(isinstance(s, Curve) and (s.start == s.end or s.radius_error > ARC_RADIUS_MM) for s in shapes)
    assert program.ink == pytest.approx(AREA * path.length, abs=1e-5 / E_PER_MM3)
    assert all(a.end == b.start for a, b in itertools.pairwise(shapes))
    assert parse(emit(program, BARE)) == program and check_program(program, BARE) == ()


def shape_of_line(a: tuple[float, float], b: tuple[float, float]):  # type: ignore[no-untyped-def]
    return Straight(a, b).segment


def wavy(count: int, *, patterns: int = 20) -> Program:
    """Wavy lines of so many segments in all, with all that a pattern has around it, and overruns."""
    steps: list = [Travel(z=10.0, speed=5.0)]
    each = count // patterns
    for p in range(patterns):
        x = 20 + 300 * p / patterns
        points = [(x + 0.5 * math.sin(0.01 * k), 20 + 300 * k / each) for k in range(each + 1)]
        steps += [Comment(f"pattern C{p}"), Travel(x, 19.0, speed=100.0), Travel(z=1.6, speed=5.0)]
        steps += [Travel(*points[0], speed=4.0), Prime(0.2, 1.0)]
        steps += [Extrude(Straight(a, b), AREA * math.dist(a, b), 4.0) for a, b in itertools.pairwise(points)]
        steps += [Retract(0.2, 1.0), Travel(points[-1][0], 320.9, speed=4.0), Travel(z=10.0, speed=5.0)]
    return Program("P1", tuple(steps), AREA)


@pytest.fixture(scope="module")
def long() -> Program:
    return quantised(wavy(100_000), e_per_mm3=E_PER_MM3)


def test_the_ink_of_a_hundred_thousand_segments_does_not_drift(long: Program) -> None:
    exact = [s.volume * E_PER_MM3 for s in wavy(100_000).steps if isinstance(s, Extrude)]
    # Each E rounded by itself: the same way up to a hundred thousand times.
    by_itself = sum(round(e, 3) for e in [exact[0]] * 100_000) - 100_000 * exact[0]
    assert abs(by_itself) > 10.0
    # E absolute, as Marlin holds it, in single precision: what a command asks for is a difference of large numbers.
    absolute = np.cumsum(exact).astype(np.float32)
    assert np.abs(np.diff(absolute) - exact[1:]).max() > 0.0019  # 0.8 % of 0.24 mm, and the bead with it
    laid = math.fsum(s.volume * E_PER_MM3 for s in long.steps if isinstance(s, Extrude))
    assert laid == pytest.approx(math.fsum(exact), abs=1e-5)


def test_ten_thousand_segments_are_emitted_checked_and_read() -> None:
    many = quantised(wavy(10_000), e_per_mm3=E_PER_MM3)
    text = emit(many, PRINTER)
    assert text.count("\n") > 10_000
    assert parse(text) == many
    assert check_text(text, PRINTER) == ()


def test_a_heap_of_segments_one_upon_another_is_found_out_in_bounded_memory() -> None:
    """Asked of one tree of all ink, each of a heap meets all others: 3e7 pairs. Faulty ink is left out after its batch."""
    heap = [f"G1 X{100 + 2 * (k % 2)} E8 F240" for k in range(1, 8_001)]
    judged = trace(HEAD + "G0 X100 Y100 F6000\nG0 Z1.6 F300\n" + "\n".join([*heap, "G0 Z10 F300"]))
    tracemalloc.start()
    faults = list(ink_findings(judged, laid_pieces(judged, PRINTER)))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert [f.line for f in faults] == list(range(10, 8_009))  # all but the first
    assert peak < 3e8  # the pairs of 1024 pieces, and the findings


def test_pieces_shorter_than_the_bead_is_wide_have_few_neighbours_once_joined() -> None:
    """20 mm in micrometres: each piece has 1500 neighbours within a bead's width, 3e7 pairs in all."""
    steps = "\n".join(f"G1 X{100 + 0.001 * k:.3f} E0.004 F240" for k in range(1, 20_001))
    judged = trace(HEAD + "G0 X100 Y100 F6000\nG0 Z1.6 F300\n" + steps + "\nG0 Z10 F300")
    pairs = 0
    exact = check_ink._distances

    def counted(pieces, later, earlier):  # type: ignore[no-untyped-def]
        nonlocal pairs
        pairs += len(later)
        return exact(pieces, later, earlier)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(check_ink, "_distances", counted)
        assert not list(ink_findings(judged, laid_pieces(judged, PRINTER)))
    assert 0 < pairs < 2e6


def calls_of(work: Callable[[], object]) -> int:
    """How many Python functions a piece of work calls: a time that no other process changes."""
    count = 0

    def seen(frame: object, event: str, arg: object) -> None:
        nonlocal count
        count += event == "call"

    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def test_work_and_memory_grow_with_the_segments_and_no_faster() -> None:
    def emit_and_check(program: Program) -> None:
        check_text(emit(program, PRINTER), PRINTER)

    few, many = wavy(500, patterns=1), wavy(4_000, patterns=8)
    calls = [calls_of(lambda program=program: emit_and_check(program)) for program in (few, many)]
    assert calls[1] < 8 * 1.1 * calls[0]
    peaks = []
    for program in (few, many):
        tracemalloc.start()
        emit_and_check(program)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 8 * 1.2 * peaks[0] and peaks[1] / 4_000 < 4_000  # bytes a segment


def test_asking_all_ink_anew_at_each_overrun_is_quadratic() -> None:
    """What the height check did at first: chords of all that is laid, at each low travel."""

    def naive_way(patterns: int) -> None:
        laid: list[Straight] = []
        for p in range(patterns):
            laid += [Straight((p, k), (p, k + 1.0)) for k in range(50)]
            Laid(laid).distance(((p + 0.5, 0.0), (p + 0.5, 1.0)))

    def our_way(patterns: int) -> None:
        laid = Laid()
        for p in range(patterns):
            for k in range(50):
                laid.add(Straight((p, k), (p, k + 1.0)))
            laid.distance(((p + 0.5, 0.0), (p + 0.5, 1.0)))

    from gcode import clearance

    cut = {"naive": 0, "ours": 0}
    exact = clearance.chords
    for name, way in (("naive", naive_way), ("ours", our_way)):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(clearance, "chords", lambda shapes, name=name: cut.__setitem__(name, cut[name] + len(shapes)) or exact(shapes))
            way(40)
    assert cut["ours"] == 40 * 50 and cut["naive"] == 50 * 40 * 41 // 2
