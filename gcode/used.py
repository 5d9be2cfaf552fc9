"""The printer and the material that a skin is made with, by name, and what they ask of its pieces and sensors."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from gcode.check_wall import nozzle_margin
from gcode.printer import DEFAULT_PRINTER, Printer, load_printer
from skinfab.material import DEFAULT_MATERIAL, Material, load_material
from skinfab.mould_plan import mould_fits
from skinfab.seams.judge import Limits
from skinfab.skin import Skin


@dataclass(frozen=True)
class Used:
    """Printer and material, by the names that go into the document."""

    printer_name: str
    printer: Printer
    material_name: str
    material: Material


def load_used(printer: str | None = None, material: str | None = None) -> Used:
    """Load the profiles; a file of one's own is named by its absolute path, so that the document finds it again.

    Parameters
    ----------
    printer, material : str, optional
        Names, or paths that end in ``.toml``; default the bundled ones.

    Raises
    ------
    InputError
        A profile is missing or damaged.

    Examples
    --------
    >>> used = load_used()
    >>> used.printer_name, used.material_name
    ('ender5plus-vipro', 'carbon-grease-ecoflex')
    """
    names = (printer or DEFAULT_PRINTER, material or DEFAULT_MATERIAL)
    name, inks = (str(Path(each).resolve()) if each.endswith(".toml") else each for each in names)
    return Used(name, load_printer(name), inks, load_material(inks))


def used_by(skin: Skin) -> Used:
    """What a document names."""
    return load_used(skin.printer, skin.material)


def limits_for(used: Used, max_distortion: float) -> Limits:
    """Pieces within the distortion bound whose moulds fit the bed, without necks that would tear.

    Examples
    --------
    >>> limits_for(load_used(), 4.05).mean
    4.05
    """
    mould = used.material.mould
    rim = 2 * (mould.wall + mould.mark)
    width, depth = used.printer.bed_size
    # A piece lies with its long side along x, so a bed that is deeper than wide has no use for the rest.
    size = (width - rim, min(width, depth) - rim)
    fits = partial(mould_fits, mould=mould, bed=(width, depth))
    return Limits(mean=max_distortion, size=size, fits=fits, neck=used.material.neck)


def limits_of(skin: Skin) -> Limits:
    """What the pieces of a document have to keep to: its own bound, its own printer's bed."""
    return limits_for(used_by(skin), skin.max_distortion)


def with_room_for_nozzle(material: Material, printer: Printer) -> tuple[Material, list[str]]:
    """The material with its margin widened to what the nozzle needs beside the wall, if that is more, and a sentence about it.

    A thick nozzle keeps further from the mould's wall than the margin does; sensors are placed where their printer can print them.
    """
    margin = nozzle_margin(printer, material)
    if margin <= material.margin:
        return material, []
    why = f"the nozzle of {printer.name} is {2 * printer.nozzle.outer_radius:g} mm thick and must not touch the mould's wall"
    note = f"sensors were kept {margin:.2f} mm from the pieces' edges, not the material's {material.margin:g}: {why}"
    return replace(material, margin=margin), [note]
