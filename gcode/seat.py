"""Where a piece's mould stands on the bed: all of it, with its registration marks, and beside the places the nozzle visits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gcode.geometry import Box, Point
from gcode.plan import bed_offset
from gcode.printer import Cleaning, Printer
from gcode.program import on_grid
from skinfab.errors import RefusedError
from skinfab.material import Material
from skinfab.mould import FREEBOARD_MM, seam_lips
from skinfab.mould_plan import mould_plan
from skinfab.pieces import Piece
from skinfab.skin import Skin
from skinfab.wire_exits import wire_pads


def seat(skin: Skin, piece: Piece, *, printer: Printer, material: Material) -> Point:
    """Machine coordinates of a piece frame's origin, mm, with which the whole mould lies on the bed.

    The piece is centred, as `gcode.plan.bed_offset` does it; where an adhesive lip would then stand over the bed's
    edge, its mould is. The mould is planned only where it comes near an edge or a place.

    Parameters
    ----------
    skin : Skin
        Its seams say where the mould has lips.
    piece : Piece
        One of its pieces.
    printer : Printer
    material : Material

    Raises
    ------
    RefusedError
        The piece or its mould is larger than the bed, or the nozzle would be cleaned or parked over the mould.
    """
    offset = bed_offset(piece, printer)
    at_most = _plate_at_most(piece, material)
    if _on_bed(at_most, offset, printer) and not _blocked(at_most, offset, printer):
        return offset
    plate = mould_plate(skin, piece, material=material)
    if not _on_bed(plate, offset, printer):
        offset = _centred(plate, piece, printer)
    if place := _blocked(plate, offset, printer):
        (x0, y0), (x1, y1) = _on_the_bed(plate, offset, printer)
        raise RefusedError(
            f"the {place} place of {printer.name} lies over the mould of piece {piece.id}, which covers X{x0:.1f} to X{x1:.1f} and "
            f"Y{y0:.1f} to Y{y1:.1f} on the bed, or nearer to it than the nozzle is wide; "
            "move it beside the mould in the printer profile, or cut the piece smaller"
        )
    return offset


def mould_plate(skin: Skin, piece: Piece, *, material: Material) -> Box:
    """The floor plate of a piece's mould as `skinfab.mould` makes it, in the piece frame (mm); its marks lie on it."""
    k = [each.id for each in skin.pieces].index(piece.id)
    lips = seam_lips(skin, material=material).get(k, [])
    # The plate reaches as far with leaning walls as with upright ones, and these are planned for every outline.
    upright = replace(material.mould, draft_deg=0.0)
    pads = wire_pads(skin.sensors_on(piece.id))
    planned = mould_plan(piece, mould=upright, depth=material.depth, freeboard=FREEBOARD_MM, pads=pads, lips=lips)
    x0, y0, x1, y1 = planned.plate.bounds
    return (x0, y0), (x1, y1)


def _plate_at_most(piece: Piece, material: Material) -> Box:
    """A box that holds the plate, however the outline turns: lips and walls are mitred up to twice their width."""
    mould = material.mould
    low, high = piece.UV.min(axis=0), piece.UV.max(axis=0)
    grown = 2 * mould.lip + 4 * mould.wall + mould.mark
    return (float(low[0]) - grown, float(low[1]) - grown), (float(high[0]) + grown, float(high[1]) + grown)


def _on_the_bed(plate: Box, offset: Point, printer: Printer) -> Box:
    """From the piece frame to the bed frame."""
    x, y = (offset[k] - printer.bed.origin[k] for k in range(2))
    return (plate[0][0] + x, plate[0][1] + y), (plate[1][0] + x, plate[1][1] + y)


def _on_bed(plate: Box, offset: Point, printer: Printer) -> bool:
    low, high = _on_the_bed(plate, offset, printer)
    return all(low[k] >= 0 and high[k] <= printer.bed.size[k] for k in range(2))


def _centred(plate: Box, piece: Piece, printer: Printer) -> Point:
    width, depth = (plate[1][k] - plate[0][k] for k in range(2))
    if width > printer.bed.size[0] or depth > printer.bed.size[1]:
        raise RefusedError(
            f"the mould of piece {piece.id} is {width:.1f} x {depth:.1f} mm with its registration marks, the bed of {printer.name} is "
            f"{printer.bed.size[0]:g} x {printer.bed.size[1]:g} mm; cut the piece smaller or choose a larger printer"
        )
    x, y = (printer.bed.origin[k] + (printer.bed.size[k] - plate[0][k] - plate[1][k]) / 2 for k in range(2))
    return on_grid(x), on_grid(y)


def _blocked(plate: Box, offset: Point, printer: Printer) -> str | None:
    """Which place the nozzle could not visit without being over the mould."""
    box = np.array(_on_the_bed(plate, offset, printer))
    need = printer.nozzle.outer_radius + printer.nozzle.clearance
    for name, place in (("cleaning", printer.cleaning), ("park", printer.park)):
        if place is not None:
            # The nozzle is wiped along +x.
            stroke = place.wipe if isinstance(place, Cleaning) else 0.0
            low, high = np.array([place.x, place.y]), np.array([place.x + stroke, place.y])
            if np.hypot(*np.maximum(np.maximum(box[0] - high, low - box[1]), 0.0)) < need:
                return name
    return None
