"""Parts of what is made from a skin, each for itself: whole or not at all, and with its files known beforehand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal, get_args

from gcode.emit import Arcs
from gcode.outputs import write_all
from gcode.used import Used, used_by, with_room_for_nozzle
from gcode.write import write_skin
from skinfab.drawings.dxf import write_dxf
from skinfab.drawings.obj import write_flat_obj
from skinfab.drawings.pdf import write_pdf
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.svg import write_svg
from skinfab.errors import InputError
from skinfab.files import explain_os_error
from skinfab.mould import can_be_cast, skin_moulds, write_mould
from skinfab.placement.bare import bare_pieces
from skinfab.placement.check import validate
from skinfab.progress import Progress, part_of, silent
from skinfab.seams.enclosed import enclosed_words
from skinfab.skin import Skin
from skinfab.staging import staged_folder

#: What fills a folder.
Folder = Literal["gcode", "moulds", "everything"]
#: What is one file.
Drawing = Literal["svg", "dxf", "pdf", "obj"]

#: What `skinfab make` writes in any case, besides files for each piece.
ALWAYS = (
    *("flat.dxf", "flat.obj", "flat.pdf", "flat.svg", "preview.png", "report.html", "report.json"),
    *("skin.skin", "wiring.csv", "wrap_strain.svg"),
)


@dataclass(frozen=True)
class Exported:
    """What was written, and what there is to say of it.

    Parameters
    ----------
    files : tuple of Path
    notes : tuple of str
    """

    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()


def files_of(what: Folder, skin: Skin) -> tuple[str, ...]:
    """The files that an export into a folder writes, by their paths in it."""
    material = used_by(skin).material
    gcode = [f"{piece.id}.gcode" for piece in skin.pieces if skin.sensors_on(piece.id)]
    moulds = [f"{piece.id}.stl" for piece in skin.pieces if can_be_cast(piece, material)]
    if what == "gcode":
        return tuple(gcode)
    if what == "moulds":
        return tuple(moulds)
    paths = [f"toolpath/{Path(name).stem}.svg" for name in gcode]
    return (*ALWAYS, *(f"gcode/{name}" for name in gcode), *(f"mould/{name}" for name in moulds), *paths)


def export_gcode(*, skin: Skin, folder: Path, arcs: Arcs | None = None, progress: Progress = silent) -> Exported:
    """``PIECE.gcode`` for every piece with sensors, the same bytes as `skinfab gcode` writes.

    Raises
    ------
    RefusedError
        A sensor or a program fails its check; nothing is written.
    InputError
        No sensor, or the folder cannot be written.
    """
    progress(0.1, "writing and checking G-code")
    with staged_folder(folder, tidy=False) as stage:
        written = write_skin(skin, stage, arcs=arcs)
    notes = [f"{w.file.name}: {warning}" for w in written for warning in w.plan.warnings]
    return _told(folder, [w.file.name for w in written], notes)


def export_moulds(*, skin: Skin, folder: Path, progress: Progress = silent) -> Exported:
    """``PIECE.stl`` for every piece that can be cast.

    Raises
    ------
    RefusedError
        A mould fails its check.
    InputError
        No piece can be cast, or the folder cannot be written.
    """
    progress(0.1, "making moulds")
    moulds = skin_moulds(skin, material=used_by(skin).material)
    if not moulds:
        raise InputError("every piece is too small to be cast, so there is no mould to write; scale the object up")
    progress(0.9, "writing moulds")
    with staged_folder(folder, tidy=False) as stage:
        for mould in moulds:
            write_mould(mould, stage / f"{mould.piece}.stl")
    return _told(folder, [f"{mould.piece}.stl" for mould in moulds], [warning for mould in moulds for warning in mould.warnings])


def export_everything(*, skin: Skin, folder: Path, progress: Progress = silent) -> Exported:
    """What `skinfab make` writes of a skin document; files of an earlier run that this one does not make are removed, as there."""
    used = used_by(skin)
    validate(skin, used.material)
    named = replace(skin, printer=used.printer_name, material=used.material_name)
    with staged_folder(folder) as stage:
        report = write_all(named, stage, used, notes=_said_of(skin, used), progress=progress)
        files = sorted(str(path.relative_to(stage)) for path in stage.rglob("*") if path.is_file())
    return Exported(tuple(folder / name for name in files), tuple(report["warnings"]))


def export_drawing(*, skin: Skin, kind: Drawing, path: Path, progress: Progress = silent) -> Exported:
    """The flat skin as one file, 1:1; a PDF with the marks of its moulds.

    Raises
    ------
    InputError
        The file cannot be written.
    RefusedError
        A mould fails its check.
    """
    if kind not in get_args(Drawing):
        raise ValueError(f"no drawing {kind!r}; there are {', '.join(get_args(Drawing))}")
    progress(0.1, f"drawing {path.name}")
    writers: dict[str, Callable[[], None]] = {
        "svg": lambda: write_svg(skin, path),
        "dxf": lambda: write_dxf(skin, path),
        "pdf": lambda: write_pdf(skin, path, moulds=skin_moulds(skin, material=used_by(skin).material)),
        "obj": lambda: write_flat_obj(skin.mesh, skin.pieces, sheet_offsets(skin.pieces), path),
    }
    writers[kind]()
    return Exported((path,))


def export_report(*, skin: Skin, path: Path, progress: Progress = silent) -> Exported:
    """The report as one page with its pictures inside; all that it tells of is made on the way, and thrown away."""
    used = used_by(skin)
    validate(skin, used.material)
    try:
        with TemporaryDirectory(prefix=".skinfab-", dir=path.parent) as place:
            made = Path(place) / "made"
            made.mkdir()
            report = write_all(skin, made, used, notes=_said_of(skin, used), progress=part_of(progress, 0.0, 0.95))
            (made / "report.html").replace(path)
    except OSError as fault:
        raise InputError(explain_os_error(fault, path)) from fault
    return Exported((path,), tuple(report["warnings"]))


def _said_of(skin: Skin, used: Used) -> list[str]:
    """What `skinfab make` says of pieces that locked seams close in, and of those that have no sensor."""
    roomy, _ = with_room_for_nozzle(used.material, used.printer)
    return [*enclosed_words(skin, used.material.neck), *bare_pieces(skin, roomy)]


def _told(folder: Path, names: list[str], notes: list[str]) -> Exported:
    """What was written, and a warning of what lies there beside it and might be taken for it."""
    kind = Path(names[0]).suffix
    others = sorted(path.name for path in folder.glob(f"*{kind}") if path.name not in names)
    if others:
        notes = [*notes, f"{folder} also holds {', '.join(others)} of an earlier run, left alone: take care not to print the wrong one"]
    return Exported(tuple(folder / name for name in names), tuple(notes))
