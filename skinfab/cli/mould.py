"""`skinfab mould SKIN -o DIR`: a casting mould for each flat piece, and the order of work."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from skinfab.cli.left_over import left_over, say_left_over


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Register the command."""
    p = subparsers.add_parser(
        "mould",
        help="casting moulds for the flat pieces",
        description="Write one printable mould (binary STL, mm) for each flat piece into DIR and print what to weigh and to do, in order.",
    )
    p.add_argument("skin", metavar="SKIN", type=Path, help="the skin document")
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for PIECE.stl; made if missing")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write the moulds, each whole or not at all; all are computed before the first is written."""
    from skinfab.document import load_skin
    from skinfab.errors import InputError
    from skinfab.files import explain_os_error
    from skinfab.material import load_material
    from skinfab.mould import skin_moulds, write_mould
    from skinfab.recipe import recipe
    from skinfab.work_order import PrintJob, work_steps

    skin = load_skin(args.skin)
    if not skin.pieces:
        raise InputError(f"{args.skin} has no flat pieces to cast; cut it first with skinfab segment")
    material = load_material(skin.material)
    moulds = skin_moulds(skin, material=material)
    if not moulds:
        raise InputError(f"{args.skin}: every piece is too small to be cast; scale the object up")
    weighed = recipe({m.piece: m.cavity_ml for m in moulds}, material, lips_ml={m.piece: m.lip_ml for m in moulds})
    try:
        args.output.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise InputError(explain_os_error(fault, args.output)) from fault
    for mould in moulds:
        path = args.output / f"{mould.piece}.stl"
        write_mould(mould, path)
        x, y = mould.marks[0]
        print(f"{path}: holds {mould.cavity_ml:.2f} ml; the lower left mark is at ({x:.2f}, {y:.2f}) mm of the piece")
        for warning in mould.warnings:
            print(f"warning: {warning}", file=sys.stderr)
    say_left_over(args.output, left_over(args.output, [args.output / f"{m.piece}.stl" for m in moulds], ".stl"))
    print()
    printed = {sensor.piece for sensor in skin.sensors}
    jobs = [PrintJob(m.piece, f"{m.piece}.gcode", m.wire_slots) for m in moulds if m.piece in printed]
    for number, step in enumerate(work_steps(weighed, material, jobs=jobs), start=1):
        print(f"{number}. {step}")
    return 0
