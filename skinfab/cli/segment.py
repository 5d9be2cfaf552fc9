"""`skinfab segment MESH -o OUT.skin`: cut a mesh, or a skin document anew, into pieces that flatten well."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from skinfab.cli import steps
from skinfab.cli.advice import many_pieces

if TYPE_CHECKING:
    from skinfab.flatten.distortion import Distortion
    from skinfab.skin import Skin

#: The document, each piece's distortion, and the notes and warnings that were said.
Started: TypeAlias = "tuple[Skin, Sequence[Distortion], list[str], list[str]]"


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "segment",
        help="cut a mesh into pieces that flatten well",
        description="Cut a mesh into flat pieces and write the skin document. Seams are found automatically, or taken from a file "
        "of vertex paths: one path a line, vertex numbers counted from 0 in the order of the mesh file, joined by the cheapest way "
        "over edges. In place of a mesh, a skin document may be given: it is cut anew, its locked seams are kept, its forbidden edges "
        "are not cut, painted preferences are heeded, and its sensors stay on their spots of the object.",
    )
    steps.add_mesh_options(p)
    p.add_argument("-o", "--output", metavar="OUT.skin", type=steps.named(".skin"), required=True, help="the document to write")
    steps.add_cut_options(p)
    steps.add_thickness_options(p)
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Cut, write, and say what came out."""
    steps.require_fitting_options(args)
    from skinfab.document import save_skin
    from skinfab.seams.cut import seam_length
    from skinfab.seams.rules import edge_mask

    start = _document if args.mesh.suffix.lower() == ".skin" else _mesh
    skin, distortions, notes, warnings = start(args)
    save_skin(skin, args.output)
    advice = many_pieces(skin, wrapped=args.wrap is not None)
    steps.say(advice)
    length = seam_length(skin.mesh, edge_mask(skin.mesh, skin.seams))
    if args.json:
        pieces = [
            {"id": p.id, "n_faces": len(p.F), "size_mm": p.size, "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max}}
            for p, d in zip(skin.pieces, distortions, strict=True)
        ]
        said = {"notes": [*notes, *advice], "warnings": warnings}
        print(json.dumps({"skin": str(args.output), "seam_mm": length, "pieces": pieces, **said}))
        return 0
    for line in steps.piece_lines(skin.pieces, distortions):
        print(line)
    print(f"{args.output}: {steps.counted(len(skin.pieces), 'piece')}, {length:.0f} mm of seam")
    return 0


def _mesh(args: argparse.Namespace) -> Started:
    """Read a mesh and cut it."""
    from skinfab.progress import terminal_progress

    loaded = steps.load_to_cut(args)
    flattened = steps.surface(args, loaded.mesh)
    steps.say(flattened.remarks)
    used = steps.profiles(args.printer, args.material)
    with terminal_progress(quiet=args.json) as progress:
        seams, notes = steps.cut(args, loaded, flattened.mesh, used, progress)
    bound = steps.bound_of(args)
    skin, distortions = steps.to_skin(loaded, flattened, seams, used=used, max_distortion=bound, max_p99=args.max_p99, seed=args.seed)
    return skin, distortions, [*loaded.notes, *flattened.remarks, *notes], []


def _document(args: argparse.Namespace) -> Started:
    """Read a document and cut it anew, by its marks."""
    from gcode.used import with_room_for_nozzle
    from skinfab.document import load_skin
    from skinfab.progress import terminal_progress
    from skinfab.seams.partial import auto_cut

    skin = load_skin(args.mesh)
    used = steps.profiles(args.printer or skin.printer, args.material or skin.material)
    skin = replace(skin, printer=used.printer_name, material=used.material_name, seed=args.seed or skin.seed)
    within = steps.limits(steps.bound_of(args, skin), used, args.max_p99)
    roomy, _ = with_room_for_nozzle(used.material, used.printer)
    with terminal_progress(quiet=args.json) as progress:
        found = auto_cut(skin, within, neck=used.material.neck, material=roomy, aim=args.pieces, progress=progress)
    steps.say(found.notes)
    warnings = [fault.text for fault in found.faults]
    steps.say(warnings, kind="warning")
    return found.skin, found.distortions, list(found.notes), warnings
