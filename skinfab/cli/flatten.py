"""`skinfab flatten MESH -o OUT.obj`: flatten a mesh and say how good it is."""

from __future__ import annotations

import argparse
import json
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps
from skinfab.flatten.methods import METHODS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from skinfab.flatten.distortion import Distortion
    from skinfab.flatten.methods import Flatten
    from skinfab.flatten.simplified import Simplified
    from skinfab.mesh.model import Mesh
    from skinfab.mesh.topology import Topology
    from skinfab.pieces import Piece
    from skinfab.seams.cut import OpenPiece

#: The two that also cut, and those that flatten what is one piece already.
NAMES = ("auto", "bff-cones", *METHODS)


def cones(text: str) -> str | int | list[tuple[int, float | None]]:
    """``auto``, how many, or a comma-separated list of vertices (one vertex: ``12,``), with cone angles in degrees: ``0:270,5:180``."""
    if text == "auto":
        return text
    try:
        if "," in text or ":" in text:
            words = [word.partition(":") for word in text.split(",") if word.strip()]
            return [(int(vertex), float(angle) if colon else None) for vertex, colon, angle in words]
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is neither auto, nor a number, nor a list of vertices such as 0,5,17 or 0:270,5:180"
        ) from None
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} cones cannot be placed; give at least 1")
    return number


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "flatten",
        help="flatten a mesh and say how good it is",
        description="Flatten a mesh; OUT.obj is the mesh (v, mm) with the flat pieces as texture coordinates (vt, mm). auto minimises the "
        "distortion d, and first cuts what is no disk, with holes or without; the other methods but bff-cones need one.",
    )
    steps.add_mesh_options(p)
    p.add_argument("-o", "--output", metavar="OUT.obj", type=steps.named(".obj"), required=True, help="the file to write")
    p.add_argument(
        "--method",
        choices=NAMES,
        default="auto",
        help="auto (default): least d, cut where it must be; isometric: least d; "
        "bijective: least d that never covers itself; bff: angles kept, quick; bff-cones: cut through cone points, for near-polyhedra; "
        "lscm, harmonic, arap, slim: libigl's, to compare with (slim takes minutes on 100,000 triangles)",
    )
    p.add_argument(
        "--cones",
        type=cones,
        metavar="N|auto|LIST",
        help="for bff-cones: how many cones, auto, or vertices such as 0,5,17; with cone angles in degrees (360 less the curvature: a "
        "cube's corner has 270) such as 0:270,5:180",
    )
    p.add_argument(
        "--max-distortion",
        type=steps.mean_bound,
        default=4.05,
        metavar="D|NAME",
        help="what a skin stands; where auto cuts, each piece's bound (default: 4.05)",
    )
    p.add_argument(
        "--simplify",
        choices=("auto", "off"),
        default="off",
        help="auto (for auto and isometric): flatten fewer triangles where the mean d is within 0.002 of that of all (default: off)",
    )
    p.add_argument("--keep-area", action="store_true", help="each piece as large as on the object, not at the scale of the least d")
    steps.add_thickness_options(p)
    p.add_argument("--json", metavar="FILE", type=Path, help="write the figures to FILE as JSON")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Flatten, check, write, and say how good it is."""
    if args.cones is not None and args.method != "bff-cones":
        args.wrong_usage("--cones goes with --method bff-cones")
    if args.simplify != "off" and args.method not in ("auto", "isometric"):
        args.wrong_usage(
            f"--simplify {args.simplify} goes with --method auto or isometric, whose aim is the least d; {args.method} has another"
        )
    from skinfab.cli.flatten_figures import figures, overall
    from skinfab.drawings.obj import write_flat_obj
    from skinfab.drawings.sheet import sheet_offsets
    from skinfab.files import atomic_write

    _check_places(args)
    loaded = steps.load(args)
    flattened = steps.surface(args, loaded.mesh)
    mesh = flattened.mesh
    began = time.perf_counter()
    simplified: list[Simplified] = []
    pieces, distortions = _flatten(args, mesh, simplified)
    if args.keep_area:
        pieces, distortions = _at_kept_area(mesh, pieces)
    seconds = time.perf_counter() - began
    steps.say([found.sentence for found in simplified])
    _require_sound(args.method, pieces, distortions)
    write_flat_obj(mesh, pieces, sheet_offsets(pieces), args.output)
    if args.json:
        found = figures(
            loaded,
            mesh,
            pieces,
            distortions,
            method=args.method,
            max_distortion=args.max_distortion,
            seconds=seconds,
            flattened_at=flattened.thickness * flattened.neutral,
        )
        found |= (
            {"simplified": [{"n_faces": s.n_faces, "n_coarse": s.n_coarse, "effect": s.effect} for s in simplified]} if simplified else {}
        )
        atomic_write(args.json, json.dumps(found, indent=1, allow_nan=False) + "\n")
    for line in steps.piece_lines(pieces, distortions):
        print(line)
    mean, most = overall(mesh, pieces, distortions)
    print(f"{args.output}: {steps.counted(len(pieces), 'piece')} by {args.method} in {seconds:.2f} s, d mean {mean:.4f}, max {most:.3f}")
    if mean > args.max_distortion:
        steps.say(
            [
                f"mean d {mean:.3f} is more than a skin stands ({args.max_distortion:g}); "
                + ("" if args.method in ("auto", "isometric", "bijective") else "--method auto makes it the least without a cut, ")
                + "skinfab segment finds darts that bring it down"
            ]
        )
    return 0


def _check_places(args: argparse.Namespace) -> None:
    """Before anything is computed: where it goes can be written, and is nothing that is needed."""
    from skinfab.errors import InputError
    from skinfab.files import require_place

    for path in [args.output, *([args.json] if args.json else [])]:
        require_place(path)
        if args.mesh.exists() and path.exists() and path.samefile(args.mesh):
            raise InputError(f"{path} is the mesh itself, which would be lost; write to another file")
    if args.json and args.json.resolve() == args.output.resolve():
        raise InputError(f"{args.json} is to hold both the flat mesh and the figures; give --json another file")


def _flatten(args: argparse.Namespace, mesh: Mesh, simplified: list[Simplified]) -> tuple[list[Piece], list[Distortion]]:
    """Pieces and how good they are; what `--simplify` did to each goes into `simplified`."""
    from skinfab.seams.cut import open_pieces

    if args.method == "bff-cones":
        return _with_cones(mesh, args.cones)
    opened = open_pieces(mesh, mesh.topology.is_boundary)
    flatten = _method(args, simplified)
    if args.method == "auto":
        why = next((reason for piece in opened if (reason := _must_be_cut(piece))), "")
        if not why:
            pieces, distortions = _as_pieces(mesh, opened, [flatten(mesh.V[p.vertices], p.F, topology=p.topology) for p in opened])
            pieces, distortions = _kept_apart(mesh, opened, pieces, distortions)
            if any(d.overlap_mm2 > 0 or d.flipped for d in distortions):
                why = "laid flat in one go the surface would cover itself"
            elif any(_is_tube(mesh, p) and d.mean > args.max_distortion for p, d in zip(opened, distortions, strict=True)):
                why = "the surface is a tube, which would stretch too far"
            else:
                return pieces, distortions
        if args.simplify != "off":
            simplified.clear()
            steps.say(["--simplify has no part in an automatic cut, whose pieces are flattened on all their triangles"])
        return _cut(mesh, args.max_distortion, why)
    return _as_pieces(mesh, opened, [flatten(mesh.V[p.vertices], p.F, topology=p.topology) for p in opened])


def _must_be_cut(piece: OpenPiece) -> str:
    """Why a piece is no disk, with holes or without; empty where it is one."""
    loops = len(piece.topology.boundary_loops)
    if not loops:
        return "the surface is closed"
    return "" if piece.topology.euler == 2 - loops else "the surface has a handle"


def _is_tube(mesh: Mesh, piece: OpenPiece) -> bool:
    """A hole at least half as wide as the border is the other end of a tube."""
    import numpy as np

    V = mesh.V[piece.vertices]
    widths = sorted(float(np.linalg.norm(np.ptp(V[loop], axis=0))) for loop in piece.topology.boundary_loops)
    return len(widths) > 1 and 2 * widths[-2] >= widths[-1]


def _kept_apart(
    mesh: Mesh, opened: list[OpenPiece], pieces: list[Piece], distortions: list[Distortion]
) -> tuple[list[Piece], list[Distortion]]:
    """Pieces that cover themselves are laid out anew so that they do not."""
    from skinfab.flatten.methods import method

    over = [d.overlap_mm2 > 0 for d in distortions]
    if not any(over):
        return pieces, distortions
    steps.say(["laid flat in one go the surface covers itself, so its boundary is kept from crossing itself, as by --method bijective"])
    apart = method("bijective")
    layouts = [
        apart(mesh.V[p.vertices], p.F, topology=p.topology) if again else piece.UV
        for p, piece, again in zip(opened, pieces, over, strict=True)
    ]
    return _as_pieces(mesh, opened, layouts)


def _method(args: argparse.Namespace, simplified: list[Simplified]) -> Flatten:
    from skinfab.flatten.methods import method

    if args.simplify == "off":
        if args.method not in ("auto", "isometric"):
            return method(args.method)
        from skinfab.flatten.holes import flatten_least

        return partial(flatten_least, say=lambda sentence: steps.say([sentence]))
    from skinfab.flatten.simplified import flatten_simplified

    def flatten(V: NDArray[np.float64], F: NDArray[np.int64], *, topology: Topology | None = None) -> NDArray[np.float64]:
        simplified.append(flatten_simplified(V, F, topology=topology))
        return simplified[-1].UV

    return flatten


def _cut(mesh: Mesh, max_distortion: float, why: str) -> tuple[list[Piece], list[Distortion]]:
    from skinfab.progress import terminal_progress
    from skinfab.seams.auto import find_seams
    from skinfab.seams.finish import finish
    from skinfab.seams.judge import Limits
    from skinfab.seams.pieces import to_pieces

    steps.say([f"{why}, so it is cut automatically"])
    with terminal_progress() as progress:
        limits = Limits(mean=max_distortion)
        seams = find_seams(mesh, limits, progress=lambda done: progress(done, "cutting and flattening"))
        seams = finish(mesh, seams, limits)
    named = to_pieces(mesh, seams.pieces)
    by_first_face = {int(p.faces[0]): v.distortion for p, v in seams.pieces}
    return list(named), [by_first_face[int(p.faces[0])] for p in named]


def _with_cones(mesh: Mesh, wanted: str | int | list[tuple[int, float | None]] | None) -> tuple[list[Piece], list[Distortion]]:
    import numpy as np

    from skinfab.errors import InputError, RefusedError
    from skinfab.seams.cones import flatten_with_cones
    from skinfab.tolerances import OVERLAP_FRACTION

    vertices = angles = None
    if isinstance(wanted, list):
        vertices = np.array([vertex for vertex, _ in wanted], dtype=np.int64)
        degrees = [angle for _, angle in wanted if angle is not None]
        if degrees and len(degrees) < len(wanted):
            raise InputError(f"{len(degrees)} of {len(wanted)} cones have an angle; give all of them one, or none")
        angles = np.radians(degrees) if degrees else None
    count = wanted if isinstance(wanted, int) else None
    _, piece, uv, placed = flatten_with_cones(mesh, cones=vertices, angles=angles, count=count)
    pieces, distortions = _as_pieces(mesh, [piece], [uv])
    if not (over := distortions[0].overlap_mm2) <= OVERLAP_FRACTION * pieces[0].area:
        raise RefusedError(
            f"laid flat with {len(placed)} cones the surface covers {over:.3g} mm^2 twice; cones suit near-polyhedra and plain "
            f"round bodies, so use --method auto, or other cones"
        )
    return pieces, distortions


def _as_pieces(mesh: Mesh, opened: list[OpenPiece], layouts: list[NDArray[np.float64]]) -> tuple[list[Piece], list[Distortion]]:
    from skinfab.flatten.distortion import measure
    from skinfab.flatten.orient import orient
    from skinfab.pieces import Piece

    together = enumerate(zip(opened, layouts, strict=True), start=1)
    pieces = [Piece(f"P{k}", p.faces, p.vertices, p.F, orient(uv), p.topology) for k, (p, uv) in together]
    return pieces, [measure(p.V(mesh), p.F, p.UV, topology=p.topology) for p in pieces]


def _at_kept_area(mesh: Mesh, pieces: list[Piece]) -> tuple[list[Piece], list[Distortion]]:
    from dataclasses import replace

    import numpy as np

    from skinfab.flatten.distortion import measure

    scaled = [replace(p, UV=p.UV * np.sqrt(mesh.face_areas[p.faces].sum() / p.area), known=p.topology) for p in pieces]
    return scaled, [measure(p.V(mesh), p.F, p.UV, topology=p.topology) for p in scaled]


def _require_sound(method: str, pieces: list[Piece], distortions: list[Distortion]) -> None:
    from skinfab.errors import RefusedError
    from skinfab.tolerances import OVERLAP_FRACTION, WILD_DISTORTION

    for piece, d in zip(pieces, distortions, strict=True):
        if d.flipped:
            raise RefusedError(f"{method} turned {d.flipped} of {len(piece.F)} triangles of {piece.id} over; use --method auto")
        if d.mean > WILD_DISTORTION:
            raise RefusedError(f"{method} stretched {piece.id} beyond use (mean d {d.mean:.3g}, 4 is perfect); use --method auto")
        if not d.overlap_mm2 <= OVERLAP_FRACTION * piece.area:
            raise RefusedError(
                f"laid flat by {method}, {piece.id} covers {d.overlap_mm2:.3g} mm^2 twice; use --method bijective, or auto, which also cuts"
            )
