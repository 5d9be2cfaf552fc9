"""The whole mould lies on the bed, its marks too, and no place the nozzle visits is over it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.plan import bed_offset
from gcode.printer import Cleaning, Park, Printer
from gcode.seat import mould_plate, seat
from gcode.write import write_skin
from skinfab.errors import RefusedError
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.mould import skin_moulds
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


@pytest.fixture
def skin(make_piece: Callable[[float, float], Piece]) -> Skin:
    """One rectangle of 120 x 100 mm."""
    mesh = Mesh(np.array([[0, 0, 0], [120, 0, 0], [120, 100, 0], [0, 100, 0]], dtype=float), np.array([[0, 1, 2], [0, 2, 3]]))
    sensor = Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0), 40, 40, 0.3, 0)
    return Skin(mesh, Source("a.obj", "0", "mm", 1.0), np.empty((0, 2), dtype=np.int64), (make_piece(120, 100),), (sensor,))


@pytest.fixture
def two(make_piece: Callable[[float, float], Piece], skin: Skin) -> Skin:
    """Two squares of 60 mm sewn along x = 60: one of them has a lip there, on its right."""
    V = np.array([[0, 0, 0], [60, 0, 0], [60, 60, 0], [0, 60, 0], [120, 0, 0], [120, 60, 0]], dtype=float)
    F = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    square = np.array([[0, 0], [60, 0], [60, 60], [0, 60]], dtype=float)
    left = Piece("P1", np.array([0, 1]), np.array([0, 1, 2, 3]), np.array([[0, 1, 2], [0, 2, 3]]), square)
    right = Piece("P2", np.array([2, 3]), np.array([1, 4, 5, 2]), np.array([[0, 1, 2], [0, 2, 3]]), square)
    return replace(skin, mesh=Mesh(V, F), seams=np.array([[1, 2]]), pieces=(left, right), sensors=())


def bed(printer: Printer, width: float, depth: float) -> Printer:
    return replace(printer, bed=replace(printer.bed, size=(width, depth)), park=None)


def test_the_plate_is_the_moulds(skin: Skin, two: Skin, material: Material) -> None:
    for each in (skin, two):
        for piece, mould in zip(each.pieces, skin_moulds(each, material=material), strict=True):
            low, high = mould_plate(each, piece, material=material)
            np.testing.assert_allclose([low, high], [mould.V.min(axis=0)[:2], mould.V.max(axis=0)[:2]], atol=2e-3)


def test_a_mould_larger_than_the_bed_keeps_all_files_away(skin: Skin, printer: Printer, material: Material, tmp_path: Path) -> None:
    (low, high) = np.array(mould_plate(skin, skin.pieces[0], material=material))
    width, depth = high - low
    assert 120 < width < 150
    snug = bed(printer, width + 0.01, depth + 0.01)
    (written,) = write_skin(skin, tmp_path / "fits", printer=snug)
    (mould,) = skin_moulds(skin, material=material)
    marks = mould.marks + written.plan.offset
    assert (marks >= 0).all() and (marks <= snug.bed.size).all()
    for narrow in (bed(printer, width - 0.5, 350), bed(printer, 350, depth - 0.5)):
        with pytest.raises(
            RefusedError, match=rf"mould of piece P1 is {width:.1f} x {depth:.1f} mm .* the bed of .* is \S+ x \S+ mm; cut"
        ) as fault:
            write_skin(skin, tmp_path / "gcode", printer=narrow)
        assert fault.value.exit_status == 3
    assert not (tmp_path / "gcode").exists()


def test_a_mould_with_a_lip_on_one_side_is_itself_centred_where_the_bed_is_tight(two: Skin, printer: Printer, material: Material) -> None:
    lipped = two.pieces[0]
    (low, high) = np.array(mould_plate(two, lipped, material=material))
    assert high[0] - 60 > -low[0] + 1  # more on the right, where the lip is
    assert seat(two, lipped, printer=printer, material=material) == bed_offset(lipped, printer)
    tight = replace(bed(printer, high[0] - low[0] + 0.2, 350), park=None)
    offset = seat(two, lipped, printer=tight, material=material)
    assert offset != bed_offset(lipped, tight)
    assert low[0] + offset[0] >= 0 and high[0] + offset[0] <= tight.bed.size[0]


@pytest.mark.parametrize("name", ["cleaning", "park"])
def test_no_place_is_over_the_mould(skin: Skin, printer: Printer, material: Material, name: str) -> None:
    moved = replace(printer, bed=replace(printer.bed, origin=(-20.0, 3.0)))  # the places count from the bed's corner
    (low, high) = np.array(mould_plate(skin, skin.pieces[0], material=material)) + np.array([115, 125])
    need = printer.nozzle.outer_radius + printer.nozzle.clearance

    def at(x: float, y: float) -> Printer:
        return replace(moved, cleaning=Cleaning(x, y, 3.0, 1.0)) if name == "cleaning" else replace(moved, park=Park(x, y))

    for x, y in ((172, 175), (low[0] - need + 0.01, 175), (172, high[1] + need - 0.01)):
        with pytest.raises(RefusedError, match=f"the {name} place of .* lies over the mould of piece P1"):
            seat(skin, skin.pieces[0], printer=at(x, y), material=material)
    for x, y in ((low[0] - need - 0.01, 175), (172, high[1] + need + 0.01), (5, 345)):
        assert seat(skin, skin.pieces[0], printer=at(x, y), material=material) == bed_offset(skin.pieces[0], moved)
