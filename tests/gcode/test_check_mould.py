"""Ink outside the piece is told for each of its strokes; a hole of the piece is outside too."""

from collections.abc import Callable

import numpy as np
import pytest

from gcode.check import judge
from gcode.check_mould import Mould, head_piece, mould_of
from gcode.check_wall import wall_of
from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer, load_printer
from skinfab.material import Material
from skinfab.pieces import Piece

HEAD = "G28 X Y\nM83\nM302 P1\nG0 Z10 F300\n"


def stroke(x: float, y: float, to: float) -> str:
    return f"G0 X{x} Y{y} F6000\nG0 Z1.6 F300\nG1 X{to} E{4 * abs(to - x):.3f} F240\nG0 Z10 F300\n"


def standing(piece: Piece, material: Material, offset: tuple[float, float]) -> Mould:
    return Mould(piece, offset, wall_of(piece, material, offset))


@pytest.fixture(scope="module")
def ring() -> Piece:
    inner = np.array([[40, 40], [60, 40], [60, 60], [40, 60]], dtype=float)
    outer = np.array([[0, 0], [100, 0], [100, 100], [0, 100]], dtype=float)
    F = np.array([[k, (k + 1) % 4, 4 + k] for k in range(4)] + [[(k + 1) % 4, 4 + (k + 1) % 4, 4 + k] for k in range(4)])
    return Piece("P1", np.arange(8), np.arange(8), F, np.vstack([outer, inner]))


@pytest.mark.parametrize(
    ("body", "lines"),
    [
        (stroke(110, 110, 130), []),
        (stroke(90, 150, 98), [7]),  # beside it
        (stroke(145, 150, 155), [7]),  # in its hole, 5 mm from any wall
        (stroke(110, 110, 130) + stroke(250, 110, 260) + stroke(110, 120, 130) + stroke(250, 120, 260), [11, 19]),
    ],
)
def test_strokes_outside(ring: Piece, printer: Printer, material: Material, body: str, lines: list[int]) -> None:
    faults = judge(HEAD + body, printer, mould=standing(ring, material, (100.0, 100.0))).findings
    assert [f.line for f in faults] == lines
    assert all("outside piece P1, whose mould holds X100.0 to X200.0 and Y100.0 to Y200.0" in f.what for f in faults)


def test_a_stroke_that_runs_out_crosses_the_wall(ring: Piece, printer: Printer, material: Material) -> None:
    faults = judge(HEAD + stroke(190, 150, 220), printer, mould=standing(ring, material, (100.0, 100.0))).findings
    assert faults and all("runs across the mould's wall" in f.what or "from the mould's wall" in f.what for f in faults)


@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_our_own_plan_lies_in_its_mould(
    make_piece: Callable[..., Piece], planned: Plan, printer: Printer, material: Material, arcs: str
) -> None:
    mould = standing(make_piece(120, 100), material, planned.offset)
    judgement = judge(emit(planned.program, printer, arcs=arcs), printer, mould=mould)  # type: ignore[arg-type]
    assert judgement.findings == () and judgement.notes == ()


def test_the_mould_stands_where_the_writer_puts_it(planned: Plan, make_piece: Callable[..., Piece], material: Material) -> None:
    from skinfab.mesh.model import Mesh
    from skinfab.skin import Skin, Source

    piece, printer = make_piece(120, 100), load_printer()
    mesh = Mesh(np.c_[piece.UV, np.zeros(4)], piece.F)
    skin = Skin(mesh, Source("plate.obj", "0" * 64, "mm", 1.0), np.empty((0, 2), dtype=np.int64), (piece,), ())
    mould = mould_of(skin, emit(planned.program, printer), printer=printer, material=material)
    assert mould.piece is piece and mould.offset == planned.offset


def test_of_the_wrong_piece_no_more_is_told(make_piece: Callable[..., Piece], planned: Plan, printer: Printer, material: Material) -> None:
    mould = standing(make_piece(120, 100), material, (planned.offset[0] + 18, planned.offset[1]))
    text = emit(planned.program, printer)
    advice = [f for f in judge(text, printer, mould=mould).findings if "mm inward" in f.remedy or "outside piece" in f.what]
    assert advice
    (fault,) = judge(text.replace("; piece P1", "; piece P9"), printer, mould=mould).findings
    assert fault.what == "its head says it is for piece P9, it is judged for piece P1"
    assert fault.remedy.endswith("or --piece as the head says; the mould is judged then")
    # The rest is judged all the same.
    assert len(judge(text.replace("; piece P1", "; piece P9") + "G0 X400\n", printer, mould=mould).findings) == 2


@pytest.mark.parametrize("name", ["ender5plus-vipro", "generic-grbl"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", " \r\n"])
def test_the_head_reads_the_same_with_any_line_end(planned: Plan, name: str, end: str) -> None:
    own = load_printer(name)
    text = emit(planned.program, own)
    assert head_piece(text.replace("\n", end)) == "P1"
    assert judge(text.replace("\n", end), own) == judge(text, own)
    assert judge(text.replace("\n", end), load_printer("generic-marlin")).notes == judge(text, load_printer("generic-marlin")).notes
