"""Sensors are placed where their printer can print them: a thick nozzle keeps further from the mould's wall than the margin does."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcode.printer import Printer
    from skinfab.material import Material


def with_room_for_nozzle(material: Material, printer: Printer) -> tuple[Material, list[str]]:
    """The material with its margin widened to what the nozzle needs beside the wall, if that is more, and a sentence about it."""
    from gcode.check_wall import nozzle_margin

    margin = nozzle_margin(printer, material)
    if margin <= material.margin:
        return material, []
    why = f"the nozzle of {printer.name} is {2 * printer.nozzle.outer_radius:g} mm thick and must not touch the mould's wall"
    note = f"sensors were kept {margin:.2f} mm from the pieces' edges, not the material's {material.margin:g}: {why}"
    return replace(material, margin=margin), [note]
