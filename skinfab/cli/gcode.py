"""`skinfab gcode`: the G-code of a skin's sensors, or a check of any G-code file."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps
from skinfab.cli.left_over import left_over, say_left_over
from skinfab.errors import InputError, RefusedError

if TYPE_CHECKING:
    from gcode.check import Judgement
    from gcode.check_mould import Mould
    from gcode.moves import Finding
    from gcode.printer import Printer
    from gcode.write import PieceGcode
    from skinfab.skin import Skin

_NOT_JUDGED = "the mould's wall was not judged"


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "gcode",
        help="G-code for the sensors, or check a G-code file",
        usage="skinfab gcode SKIN -o DIR [--arcs native|lines] [--printer NAME|FILE] [--preview] [--json]\n"
        "       skinfab gcode check FILE [--skin SKIN [--piece ID]] [--printer NAME|FILE] [--json]",
        description="Write PIECE.gcode for every piece of a skin that carries sensors, or check any G-code file by the same rules.",
        epilog="A skin file that is itself named 'check' is given as ./check.",
    )
    p.add_argument("words", nargs="+", metavar="SKIN | check FILE", help="a skin document, or the word check and a G-code file")
    p.add_argument("-o", "--output", metavar="DIR", help="folder for the G-code files, made if it is not there")
    p.add_argument("--arcs", choices=("native", "lines"), help="arcs as G2 and G3, or as chords (default: what the printer draws)")
    p.add_argument(
        "--printer",
        type=steps.profile,
        metavar="NAME|FILE",
        help="printer profile (default: the skin's own; for check without one: ender5plus-vipro)",
    )
    p.add_argument("--skin", metavar="SKIN", help="for check: the skin it is printed in, to judge the nozzle against the mould's wall")
    p.add_argument("--piece", metavar="ID", help="for check with --skin: the piece, such as P1 (default: the one the file's head names)")
    p.add_argument("--preview", action="store_true", help="write PIECE.svg too: the tool path, coloured by what the head does")
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Do what the first word asks for."""
    if args.words[0] == "check":
        return _check(args)
    return _write(args)


def _write(args: argparse.Namespace) -> int:
    for option, given in (("--skin", args.skin), ("--piece", args.piece)):
        if given is not None:
            args.wrong_usage(f"{option} belongs to gcode check")
    if len(args.words) != 1:
        args.wrong_usage(f"one skin document is expected, not {len(args.words)}")
    if args.output is None:
        args.wrong_usage("-o DIR is missing: the folder for the G-code files")
    from gcode.printer import load_printer
    from gcode.write import write_previews, write_skin
    from skinfab.document import load_skin
    from skinfab.placement.lifted import off_words

    skin = load_skin(args.words[0])
    printer = load_printer(args.printer) if args.printer else None
    written = write_skin(skin, args.output, arcs=args.arcs, printer=printer)
    previews = write_previews(skin, written, args.output, printer=printer) if args.preview else ()
    others = left_over(Path(args.output), [*(w.file for w in written), *previews], ".gcode")
    if args.json:
        described = [_described(w) for w in written]
        print(json.dumps({"gcode": described, "previews": [str(f) for f in previews], "left_over": [str(f) for f in others]}))
        return 0
    say_left_over(Path(args.output), others)
    steps.say(off_words(skin.lifted), kind="warning")
    for w in written:
        s = w.summary
        x, y = w.plan.offset
        print(f"{w.file}: {s.lines} lines, {s.arcs} arcs, {s.ink_mm3:.1f} mm^3 of ink, {s.time_s / 60:.1f} min")
        print(f"  the piece's lower left corner is at X{x:.4f} Y{y:.4f}")
        for warning in w.plan.warnings:
            print(f"  {warning}")
    for file in previews:
        print(f"{file}: its tool path")
    return 0


def _described(written: PieceGcode) -> dict[str, object]:
    return {
        "piece": written.piece,
        "file": str(written.file),
        **asdict(written.summary),
        "offset_mm": written.plan.offset,
        "warnings": written.plan.warnings,
    }


def _check(args: argparse.Namespace) -> int:
    if len(args.words) != 2:
        args.wrong_usage("check takes one G-code file")
    for option, given in (("-o", args.output), ("--arcs", args.arcs), ("--preview", args.preview or None)):
        if given is not None:
            args.wrong_usage(f"check reads a file and writes none, so it takes no {option}")
    if args.piece is not None and args.skin is None:
        args.wrong_usage("--piece names a piece of a skin, so it needs --skin")
    from gcode.check import judge
    from gcode.printer import DEFAULT_PRINTER, load_printer
    from gcode.words import read_text

    file = args.words[1]
    text = read_text(file)
    skin = _skin(args.skin)
    printer = load_printer(args.printer or (skin.printer if skin else DEFAULT_PRINTER))
    mould, area = _mould(skin, text, printer, args) if skin else (None, None)
    judgement = judge(text, printer, mould=mould, bead_area=area)
    if args.json:
        print(json.dumps(_told(file, printer.name, judgement, mould)))
    else:
        for note in judgement.notes:
            print(f"note: {note}")
        _show(judgement.findings)
    if judgement.broken_off:
        raise InputError(f"{file}: {judgement.broken_off}")
    if args.json:
        return RefusedError.exit_status if judgement.findings else 0
    if count := len(judgement.findings):
        raise RefusedError(f"{file} has {count} fault{'s' * (count > 1)} on {printer.name}; correct them before printing")
    where = f" in the mould of piece {mould.piece.id}" if mould else f"; {_NOT_JUDGED}, for that give --skin SKIN"
    print(f"{file}: no fault found by these rules on {printer.name}{where}")
    return 0


def _skin(file: str | None) -> Skin | None:
    from skinfab.document import load_skin

    return None if file is None else load_skin(file)


def _mould(skin: Skin, text: str, printer: Printer, args: argparse.Namespace) -> tuple[Mould, float]:
    """What the file is printed in, and the cross-section of the bead of the skin's ink, mm^2."""
    from gcode.check_mould import mould_of
    from skinfab.material import load_material

    material = load_material(skin.material)
    try:
        mould = mould_of(skin, text, printer=printer, material=material, piece=args.piece)
    except InputError as fault:
        raise InputError(f"{args.words[1]}: {fault}") from fault
    return mould, material.ink.bead_area_mm2


def _told(file: str, printer: str, judgement: Judgement, mould: Mould | None) -> dict[str, object]:
    return {
        "file": file,
        "printer": printer,
        "ok": not judgement.findings and not judgement.broken_off,
        "findings": [asdict(f) for f in judgement.findings],
        "notes": judgement.notes,
        "broken_off": judgement.broken_off or None,
        "piece": mould.piece.id if mould else None,
        "not_judged": [] if mould else [_NOT_JUDGED],
    }


def _show(findings: tuple[Finding, ...]) -> None:
    """One line for each kind of fault, at the first place that has it; --json lists every place."""
    kinds: dict[str, list[Finding]] = {}
    for finding in findings:
        kinds.setdefault(finding.kind, []).append(finding)
    for alike in kinds.values():
        more = len({f.line for f in alike}) - 1
        print(f"{alike[0]} (and {more} more line{'s' * (more > 1)} like it)" if more else alike[0])
