"""The cleaning place: down to its own height beside the mould, wiped there, up again, and as much ink in the nozzle as before."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gcode.check import check_program, check_text
from gcode.check_wall import wall_of
from gcode.emit import emit
from gcode.moves import Trace
from gcode.parse import parse
from gcode.plan import Plan, plan
from gcode.preview import strokes
from gcode.printer import Cleaning, Printer, load_printer
from gcode.program import Clean, Prime, Retract
from gcode.seat import mould_plate, seat
from gcode.trace import trace
from skinfab.errors import RefusedError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.paths import Line, Path
from skinfab.pieces import Piece
from skinfab.skin import Skin, Source

LINE = Path((Line((0, 0), (10, 0)),))
PAD = Cleaning(x=5.0, y=6.0, seconds=3.0, initial_extrude=2.0, height=2.0, wipe=15.0)


@pytest.fixture(params=["ender5plus-vipro", "generic-marlin", "generic-grbl"])
def cleaned(request: pytest.FixtureRequest) -> Printer:
    return replace(load_printer(request.param), cleaning=PAD)


@pytest.fixture
def piece(make_piece: Callable[..., Piece]) -> Piece:
    return make_piece(60, 60)


@pytest.fixture(scope="module")
def skin(make_piece: Callable[..., Piece]) -> Skin:
    """One rectangle of 120 x 100 mm."""
    mesh = Mesh(np.array([[0, 0, 0], [120, 0, 0], [120, 100, 0], [0, 100, 0]], dtype=float), np.array([[0, 1, 2], [0, 2, 3]]))
    return Skin(mesh, Source("a.obj", "0", "mm", 1.0), np.empty((0, 2), dtype=np.int64), (make_piece(120, 100),), ())


@pytest.fixture
def printed(piece: Piece, make_sensor: Callable, material: Material, cleaned: Printer) -> Plan:
    """Two lines."""
    return plan(piece, [make_sensor("A", LINE, 20, 20), make_sensor("B", LINE, 20, 30)], printer=cleaned, material=material)


def followed(printed: Plan, printer: Printer) -> Trace:
    return trace(emit(printed.program, printer), spindle=printer.spindle)


def test_as_g_code(piece: Piece, make_sensor: Callable, material: Material) -> None:
    printer = replace(load_printer("generic-marlin"), cleaning=PAD)
    text = emit(plan(piece, [make_sensor("A", LINE, 20, 20)], printer=printer, material=material).program, printer)
    after = text.partition("; cleaning\n")[2].splitlines()[:7]
    assert after == [
        "G0 X5.0000 Y6.0000 F4800.0",  # at travel height
        "G0 Z2.0000 F300.0",
        "G4 P3000 ; clean",
        "G0 X20.0000 Y6.0000",
        "G0 X5.0000 Y6.0000",
        "G0 Z10.0000",
        "; park",
    ]


def test_the_nozzle_meets_neither_the_mould_nor_the_bed(skin: Skin, make_sensor: Callable, material: Material, cleaned: Printer) -> None:
    piece = skin.pieces[0]
    offset = seat(skin, piece, printer=cleaned, material=material)
    printed = plan(piece, [make_sensor("A", LINE, 20, 20)], printer=cleaned, material=material, offset=offset)
    assert check_program(printed.program, cleaned, wall=wall_of(piece, material, offset)) == ()
    low, high = np.array(mould_plate(skin, piece, material=material)) + offset
    visits = 0
    for move in followed(printed, cleaned).moves:
        z = [v for v in (move.start[2], move.end[2]) if v is not None]
        # Z = 0 is the floor of the cavity, which lies on the bed by its own thickness.
        assert all(v >= 0 for v in z)
        if not z or min(z) >= cleaned.heights.travel or None in move.end[:2]:
            continue
        at = np.array(move.end[:2], dtype=float)
        if np.all(at > low) and np.all(at < high):
            continue  # a pattern, which the wall's own check is about
        assert min(z) >= 2.0 and at[1] == 6.0 and 5.0 <= at[0] <= 20.0
        assert np.hypot(*np.maximum(np.maximum(low - at, at - high), 0.0)) >= cleaned.nozzle.outer_radius + cleaned.nozzle.clearance
        visits += 1
    assert visits >= 2 * 4  # down, to, fro and up, at first and after the pattern


def test_the_nozzle_is_as_full_after_it_as_before(printed: Plan, cleaned: Printer) -> None:
    assert check_program(printed.program, cleaned) == ()
    steps = printed.program.steps
    pushed = sum(s.volume if isinstance(s, Prime) else -s.volume for s in steps if isinstance(s, Prime | Retract))
    first = next(k for k, s in enumerate(steps) if isinstance(s, Clean))
    begun = sum(s.volume for s in steps[:first] if isinstance(s, Prime))
    assert begun == pytest.approx(2.0, abs=1e-4) and pushed == pytest.approx(begun, abs=1e-12)
    assert sum(isinstance(s, Clean) for s in steps) == 3
    assert parse(emit(printed.program, cleaned)) == printed.program


def test_without_a_height_it_stays_above_the_walls(piece: Piece, make_sensor: Callable, material: Material, cleaned: Printer) -> None:
    by_hand = replace(cleaned, cleaning=Cleaning(5.0, 6.0, 3.0, 2.0))
    printed = plan(piece, [make_sensor("A", LINE, 20, 20)], printer=by_hand, material=material)
    assert check_program(printed.program, by_hand) == ()
    at_pad = [m for m in followed(printed, by_hand).moves if m.end[:2] == (5.0, 6.0)]
    assert at_pad and {m.end[2] for m in at_pad} == {cleaned.heights.travel}


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("X20.0000 Y6.0000", "X20.5000 Y6.0000", "it travels 15.500 mm at Z2.0000, below the travel height"),
        ("X20.0000 Y6.0000", "X20.0000 Y6.5000", "below the travel height"),
        ("Z2.0000", "Z1.9000", "it travels 15.000 mm at Z1.9000, below the travel height"),
        ("G0 X5.0000 Y6.0000\nG0 Z10.0000\n", "G0 X5.0000 Y6.0000\n", "below the travel height"),
    ],
)
def test_only_the_pad_is_wiped(piece: Piece, make_sensor: Callable, material: Material, old: str, new: str, says: str) -> None:
    printer = replace(load_printer("generic-marlin"), cleaning=PAD)
    text = emit(plan(piece, [make_sensor("A", LINE, 20, 20)], printer=printer, material=material).program, printer)
    assert old in text and check_text(text, printer) == ()
    assert any(says in f.what for f in check_text(text.replace(old, new), printer))


def test_the_whole_wipe_lies_beside_the_mould(skin: Skin, printer: Printer, material: Material) -> None:
    piece = skin.pieces[0]
    offset = seat(skin, piece, printer=printer, material=material)
    low = mould_plate(skin, piece, material=material)[0][0] + offset[0]
    for wipe, clear in ((20.0, True), (40.0, False)):
        wiped = replace(printer, cleaning=replace(PAD, x=low - 30.0, y=175.0, wipe=wipe))
        if clear:
            assert seat(skin, piece, printer=wiped, material=material) == offset
        else:
            with pytest.raises(RefusedError, match=r"the cleaning place of .* lies over the mould of piece P1"):
                seat(skin, piece, printer=wiped, material=material)


def test_it_is_drawn_as_cleaning(printed: Plan, cleaned: Printer) -> None:
    drawn = [s for s in strokes(followed(printed, cleaned), cleaned) if s.role == "cleaning"]
    assert sum(s.shape is None for s in drawn) == 3
    assert sum(s.shape.length for s in drawn if s.shape) == pytest.approx(3 * 2 * 15.0)
    assert {s.at for s in drawn} == {(5.0, 6.0), (20.0, 6.0)}
