"""`skinfab segment MESH -o OUT.skin`: cut a mesh into pieces that flatten well."""

from __future__ import annotations

import argparse
import json

from skinfab.cli import steps
from skinfab.cli.advice import many_pieces


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "segment",
        help="cut a mesh into pieces that flatten well",
        description="Cut a mesh into flat pieces and write the skin document. Seams are found automatically, or taken from a file "
        "of vertex paths: one path a line, vertex numbers counted from 0 in the order of the mesh file, joined by the cheapest way "
        "over edges.",
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
    from skinfab.progress import terminal_progress
    from skinfab.seams.cut import seam_length

    loaded = steps.load_to_cut(args)
    flattened = steps.surface(args, loaded.mesh)
    used = steps.profiles(args.printer, args.material)
    with terminal_progress(quiet=args.json) as progress:
        seams = steps.cut(args, loaded, flattened.mesh, used, progress)
    skin, distortions = steps.to_skin(loaded, flattened, seams, used=used, max_distortion=args.max_distortion, seed=args.seed)
    save_skin(skin, args.output)
    steps.say(many_pieces(skin, wrapped=args.wrap is not None))
    if args.json:
        pieces = [
            {"id": p.id, "n_faces": len(p.F), "size_mm": p.size, "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max}}
            for p, d in zip(skin.pieces, distortions, strict=True)
        ]
        print(json.dumps({"skin": str(args.output), "seam_mm": seam_length(skin.mesh, seams.cut), "pieces": pieces}))
        return 0
    for line in steps.piece_lines(skin.pieces, distortions):
        print(line)
    print(f"{args.output}: {steps.counted(len(skin.pieces), 'piece')}, {seam_length(skin.mesh, seams.cut):.0f} mm of seam")
    return 0
