"""`skinfab segment MESH -o OUT.skin`: cut a mesh into pieces that flatten well."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.mesh.io import Loaded
    from skinfab.seams.auto import Seams
    from skinfab.seams.judge import Limits


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
    p.add_argument("-o", "--output", metavar="OUT.skin", type=Path, required=True, help="the document to write")
    p.add_argument("--cuts", metavar="FILE", type=Path, help="seams by hand: a text file of vertex paths; just these are cut")
    p.add_argument(
        "--complete", action="store_true", help="with --cuts: add automatic seams where the hand-made ones do not give good pieces"
    )
    steps.add_cut_options(p)
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Cut, write, and say what came out."""
    if args.complete and args.cuts is None:
        args.wrong_usage("--complete goes with --cuts FILE")
    from skinfab.document import save_skin
    from skinfab.progress import terminal_progress
    from skinfab.seams.cut import seam_length

    loaded = steps.load(args)
    used = steps.profiles(args.printer)
    within = steps.limits(args.max_distortion, used)
    with terminal_progress(quiet=args.json) as progress:
        if args.cuts is None:
            seams = steps.cut(loaded, within, neck=used.material.neck, progress=progress)
        else:
            seams = _by_hand(args, loaded, within)
    skin, distortions = steps.to_skin(loaded, seams, used=used, max_distortion=args.max_distortion, seed=args.seed)
    save_skin(skin, args.output)
    if args.json:
        pieces = [
            {"id": p.id, "n_faces": len(p.F), "size_mm": p.size, "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max}}
            for p, d in zip(skin.pieces, distortions, strict=True)
        ]
        print(json.dumps({"skin": str(args.output), "seam_mm": seam_length(loaded.mesh, seams.cut), "pieces": pieces}))
        return 0
    for line in steps.piece_lines(skin.pieces, distortions):
        print(line)
    print(f"{args.output}: {len(skin.pieces)} pieces, {seam_length(loaded.mesh, seams.cut):.0f} mm of seam")
    return 0


def _by_hand(args: argparse.Namespace, loaded: Loaded, within: Limits) -> Seams:
    from skinfab.mesh.io import load_mesh
    from skinfab.seams.auto import Seams
    from skinfab.seams.manual import cut_along, read_cuts, seams_by_hand
    from skinfab.seams.refine import refine_seams
    from skinfab.seams.weights import seam_weights

    # Numbers in the file count the mesh file's vertices, before any cleaning.
    raw = load_mesh(args.mesh, units=args.units, scale=args.scale).mesh
    paths = [raw.V[path] for path in read_cuts(args.cuts, len(raw.V))]
    by_hand = cut_along(loaded.mesh, paths)
    if not args.complete:
        return seams_by_hand(loaded.mesh, by_hand, within)
    seams = Seams(*refine_seams(loaded.mesh, by_hand, within, seam_weights(loaded.mesh)))
    added = int((seams.cut & ~by_hand).sum())
    steps.say([f"{added} edges were cut beyond those given by hand"] if added else [])
    return seams
