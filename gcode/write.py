"""G-code files, checked before a byte of them is written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from gcode.check import check_program
from gcode.check_wall import Wall, wall_of
from gcode.emit import Arcs, emit, on_grid_of, with_chords
from gcode.estimate import Summary, summarise
from gcode.plan import Plan, plan
from gcode.preview import draw_toolpath
from gcode.printer import Printer, load_printer
from gcode.program import Program
from gcode.seat import seat
from gcode.words import read_text
from skinfab.errors import InputError, RefusedError, SkinfabError
from skinfab.files import atomic_write, explain_os_error
from skinfab.material import load_material
from skinfab.placement.check import validate
from skinfab.placement.lifted import off_words
from skinfab.skin import Skin


@dataclass(frozen=True)
class PieceGcode:
    """One written file: which piece, where, its plan and its summary."""

    piece: str
    file: Path
    plan: Plan
    summary: Summary


def write_gcode(program: Program, target: str | Path, *, printer: Printer, arcs: Arcs = "native") -> Summary:
    """Check a program, then write its text, whole or not at all.

    Raises
    ------
    RefusedError
        The program fails its check: names the first line and pattern and what to change. Nothing is written.
    InputError
        The file cannot be written.
    """
    text, summary = checked_text(program, printer=printer, arcs=arcs)
    atomic_write(target, text)
    return summary


def write_skin(skin: Skin, folder: str | Path, *, arcs: Arcs | None = None, printer: Printer | None = None) -> tuple[PieceGcode, ...]:
    """Write ``PIECE.gcode`` for every piece of a skin that carries a sensor.

    All sensors must lie where they may, and all pieces are planned and checked before the first file is written.

    Parameters
    ----------
    skin : Skin
    folder : path
        Made if it is not there.
    arcs : "native" or "lines", optional
        By the printer profile if not given.
    printer : Printer, optional
        The skin's own if not given.

    Raises
    ------
    RefusedError
        A sensor lies outside its piece or too close to another, a mould does not lie on the bed beside the cleaning and
        park places, or a program fails its check.
    InputError
        No sensor at all, a bad profile, or a folder that cannot be written.
    """
    printer = printer or load_printer(skin.printer)
    arcs = arcs or ("native" if printer.arcs else "lines")
    material = load_material(skin.material)
    validate(skin, material)
    pieces = [p for p in skin.pieces if skin.sensors_on(p.id)]
    if not pieces:
        off = off_words(skin.lifted)
        raise InputError(f"this skin has no sensor{' in place' * bool(off)}, so there is nothing to print; {(*off, 'place one first')[0]}")
    offsets = [seat(skin, p, printer=printer, material=material) for p in pieces]
    plans = [
        plan(p, skin.sensors_on(p.id), printer=printer, material=material, offset=offset) for p, offset in zip(pieces, offsets, strict=True)
    ]
    walls = [wall_of(piece, material, planned.offset) for piece, planned in zip(pieces, plans, strict=True)]
    texts = [checked_text(planned.program, printer=printer, arcs=arcs, wall=wall) for planned, wall in zip(plans, walls, strict=True)]
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise InputError(explain_os_error(fault, folder)) from fault
    written = []
    for planned, (text, summary) in zip(plans, texts, strict=True):
        file = folder / f"{planned.program.name}.gcode"
        atomic_write(file, text)
        written.append(PieceGcode(planned.program.name, file, planned, summary))
    return tuple(written)


def write_previews(skin: Skin, written: Sequence[PieceGcode], folder: str | Path, *, printer: Printer | None = None) -> tuple[Path, ...]:
    """Write ``PIECE.svg`` for each file that `write_skin` wrote: its tool path, coloured by what the head does.

    Raises
    ------
    InputError
        A file cannot be read back or written.
    """
    printer = printer or load_printer(skin.printer)
    pieces = {piece.id: piece for piece in skin.pieces}
    targets = []
    for w in written:
        piece, target = pieces[w.piece], Path(folder) / f"{w.piece}.svg"
        edges = piece.UV[piece.topology.E[piece.topology.is_boundary]]
        draw_toolpath(read_text(w.file), target, printer=printer, title=f"Tool path of {w.piece}", outline=edges, shift=w.plan.offset)
        targets.append(target)
    return tuple(targets)


def drawn_with(arcs: Arcs, program: Program, printer: Printer) -> Program:
    """A planned program with its arcs as they are, or as chords.

    Raises
    ------
    RefusedError
        The printer draws no arcs.
    """
    if arcs == "native" and not printer.arcs:
        raise RefusedError(f"{printer.name} draws no arcs (its profile says arcs = false); emit with --arcs lines")
    return on_grid_of(with_chords(program, tolerance=printer.process.chord_tolerance), printer) if arcs == "lines" else program


def checked_text(program: Program, *, printer: Printer, arcs: Arcs = "native", wall: Wall | None = None) -> tuple[str, Summary]:
    """The text of a program that passes its check, the mould's `wall` too where it is given, and its summary.

    Raises
    ------
    RefusedError
        It does not pass.
    """
    program = drawn_with(arcs, program, printer)
    try:
        findings = check_program(program, printer, wall=wall)
    except SkinfabError as fault:
        raise RefusedError(f"the G-code of piece {program.name} was not written: {fault}") from fault
    if findings:
        more = f" ({len(findings) - 1} more like this or others)" if len(findings) > 1 else ""
        raise RefusedError(f"the G-code of piece {program.name} was not written: {findings[0]}{more}")
    text = emit(program, printer)
    return text, summarise(program, printer, lines=text.count("\n"))
