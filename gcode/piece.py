"""The program of one piece of a skin, as `gcode.write` would write it, to be looked at and judged before it is written."""

from __future__ import annotations

from dataclasses import dataclass

from gcode.check import Judgement, judge
from gcode.check_mould import Mould
from gcode.check_wall import wall_of
from gcode.emit import Arcs, emit
from gcode.plan import plan
from gcode.printer import Printer
from gcode.program import Program
from gcode.seat import seat
from gcode.write import drawn_with
from skinfab.material import Material
from skinfab.skin import Skin


@dataclass(frozen=True, eq=False)
class PieceProgram:
    """What is printed on one piece, not checked yet.

    Parameters
    ----------
    program : Program
        On the grid of the text.
    text : str
        Byte by byte what `gcode.write.write_skin` writes where it finds no fault.
    printer : Printer
    mould : Mould
        What it is printed in, and where that stands on the bed.
    bead_area : float, mm^2
        Cross-section of the material's bead.
    warnings : tuple of str
        Of its plan.
    """

    program: Program
    text: str
    printer: Printer
    mould: Mould
    bead_area: float
    warnings: tuple[str, ...]

    def judge(self) -> Judgement:
        """All faults of the text on its printer, in its mould."""
        return judge(self.text, self.printer, mould=self.mould, bead_area=self.bead_area)


def piece_program(skin: Skin, piece: str, *, printer: Printer, material: Material, arcs: Arcs | None = None) -> PieceProgram:
    """Plan the program of one piece.

    Parameters
    ----------
    skin : Skin
    piece : str
        Id of one that carries a sensor.
    printer : Printer
    material : Material
    arcs : "native" or "lines", optional
        By the printer profile if not given.

    Raises
    ------
    InputError
        No such piece, or no sensor on it.
    RefusedError
        The piece or its mould does not fit the bed, or the printer draws no arcs.
    """
    arcs = arcs or ("native" if printer.arcs else "lines")
    flat = skin.piece(piece)
    offset = seat(skin, flat, printer=printer, material=material)
    planned = plan(flat, skin.sensors_on(piece), printer=printer, material=material, offset=offset)
    program = drawn_with(arcs, planned.program, printer)
    mould = Mould(flat, planned.offset, wall_of(flat, material, planned.offset))
    return PieceProgram(program, emit(program, printer), printer, mould, material.ink.bead_area_mm2, planned.warnings)
