"""`skinfab flatten MESH -o OUT.obj`: flatten a mesh and say how good it is."""

from __future__ import annotations

import argparse
import json
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

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

#: The names of `flatten.methods.METHODS`, and the two that also cut; repeated here because --help imports nothing heavy.
NAMES = ("auto", "bff", "bff-cones", "isometric", "lscm", "arap", "slim", "harmonic")


def cones(text: str) -> str | int | list[int]:
    """``auto``, how many, or a comma-separated list of vertices (one vertex: ``12,``)."""
    if text == "auto":
        return text
    try:
        if "," in text:
            return [int(word) for word in text.split(",") if word.strip()]
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither auto, nor a number, nor a list of vertices such as 0,5,17") from None
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} cones cannot be placed; give at least 1")
    return number


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "flatten",
        help="flatten a mesh and say how good it is",
        description="Flatten a mesh; OUT.obj is the mesh (v, mm) with the flat pieces as texture coordinates (vt, mm). auto minimises the "
        "distortion d, and first cuts what is no disk, with holes or without; bff-cones cuts through cone points; the others need a disk.",
    )
    steps.add_mesh_options(p)
    p.add_argument("-o", "--output", metavar="OUT.obj", type=steps.named(".obj"), required=True, help="the file to write")
    p.add_argument("--method", choices=NAMES, default="auto", help="default: auto")
    p.add_argument("--cones", type=cones, metavar="N|auto|LIST", help="for bff-cones: how many cones, auto, or vertices such as 0,5,17")
    p.add_argument(
        "--max-distortion", type=steps.bound, default=4.05, metavar="D", help="for auto where it cuts: mean d of a piece at most"
    )
    p.add_argument(
        "--simplify",
        choices=("auto", "off"),
        default="off",
        help="auto (for auto and isometric): flatten fewer triangles where the mean d is within 0.002 of that of all (default: off)",
    )
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
    from skinfab.drawings.obj import write_flat_obj
    from skinfab.drawings.sheet import sheet_offsets
    from skinfab.files import atomic_write

    loaded = steps.load(args)
    began = time.perf_counter()
    simplified: list[Simplified] = []
    pieces, distortions = _flatten(args, loaded.mesh, simplified)
    seconds = time.perf_counter() - began
    steps.say([found.sentence for found in simplified])
    _require_sound(args.method, pieces, distortions)
    write_flat_obj(loaded.mesh, pieces, sheet_offsets(pieces), args.output)
    if args.json:
        figures = _figures(args.method, loaded.mesh, pieces, distortions, seconds)
        figures |= (
            {"simplified": [{"n_faces": s.n_faces, "n_coarse": s.n_coarse, "effect": s.effect} for s in simplified]} if simplified else {}
        )
        atomic_write(args.json, json.dumps(figures, indent=1, allow_nan=False) + "\n")
    for line in steps.piece_lines(pieces, distortions):
        print(line)
    mean, most = _overall(loaded.mesh, pieces, distortions)
    print(f"{args.output}: {steps.counted(len(pieces), 'piece')} by {args.method} in {seconds:.2f} s, d mean {mean:.4f}, max {most:.3f}")
    if mean > args.max_distortion:
        steps.say(
            [f"mean d {mean:.3f} is more than a skin stands ({args.max_distortion:g}); skinfab segment finds darts that bring it down"]
        )
    return 0


def _flatten(args: argparse.Namespace, mesh: Mesh, simplified: list[Simplified]) -> tuple[list[Piece], list[Distortion]]:
    """Pieces and how good they are; what `--simplify` did to each goes into `simplified`."""
    from skinfab.seams.cut import open_pieces

    if args.method == "bff-cones":
        from skinfab.seams.cones import flatten_with_cones

        wanted = args.cones or "auto"
        listed = _vertices(wanted) if isinstance(wanted, list) else None
        count = wanted if isinstance(wanted, int) else None
        _, piece, uv, _ = flatten_with_cones(mesh, cones=listed, count=count)
        return _as_pieces(mesh, [piece], [uv])
    opened = open_pieces(mesh, mesh.topology.is_boundary)
    flatten = _method(args, simplified)
    if args.method == "auto":
        if all(_has_border_and_no_handle(piece) for piece in opened):
            pieces, distortions = _as_pieces(mesh, opened, [flatten(mesh.V[p.vertices], p.F, topology=p.topology) for p in opened])
            # A tube, open at both ends, is a disk with a hole too: where it would stretch too far it is cut.
            lie = [p.is_disk or d.mean <= args.max_distortion for p, d in zip(opened, distortions, strict=True)]
            if all(lie) and not any(d.overlap_mm2 > 0 or d.flipped for d in distortions):
                return pieces, distortions
        if args.simplify != "off":
            simplified.clear()
            steps.say(["--simplify has no part in an automatic cut, whose pieces are flattened on all their triangles"])
        return _cut(mesh, args.max_distortion)
    return _as_pieces(mesh, opened, [flatten(mesh.V[p.vertices], p.F, topology=p.topology) for p in opened])


def _has_border_and_no_handle(piece: OpenPiece) -> bool:
    """A disk, with holes or without."""
    loops = len(piece.topology.boundary_loops)
    return loops > 0 and piece.topology.euler == 2 - loops


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


def _cut(mesh: Mesh, max_distortion: float) -> tuple[list[Piece], list[Distortion]]:
    from skinfab.progress import terminal_progress
    from skinfab.seams.auto import find_seams
    from skinfab.seams.finish import finish
    from skinfab.seams.judge import Limits
    from skinfab.seams.pieces import to_pieces

    steps.say(["the surface cannot lie flat in one go, so it is cut automatically"])
    with terminal_progress() as progress:
        limits = Limits(mean=max_distortion)
        seams = find_seams(mesh, limits, progress=lambda done: progress(done, "cutting and flattening"))
        seams = finish(mesh, seams, limits)
    named = to_pieces(mesh, seams.pieces)
    by_first_face = {int(p.faces[0]): v.distortion for p, v in seams.pieces}
    return list(named), [by_first_face[int(p.faces[0])] for p in named]


def _vertices(numbers: list[int]) -> NDArray[np.int64]:
    import numpy as np

    return np.array(numbers, dtype=np.int64)


def _as_pieces(mesh: Mesh, opened: list[OpenPiece], layouts: list[NDArray[np.float64]]) -> tuple[list[Piece], list[Distortion]]:
    from skinfab.flatten.distortion import measure
    from skinfab.flatten.orient import orient
    from skinfab.pieces import Piece

    together = enumerate(zip(opened, layouts, strict=True), start=1)
    pieces = [Piece(f"P{k}", p.faces, p.vertices, p.F, orient(uv), p.topology) for k, (p, uv) in together]
    return pieces, [measure(p.V(mesh), p.F, p.UV, topology=p.topology) for p in pieces]


def _require_sound(method: str, pieces: list[Piece], distortions: list[Distortion]) -> None:
    from skinfab.errors import RefusedError
    from skinfab.tolerances import OVERLAP_FRACTION

    for piece, d in zip(pieces, distortions, strict=True):
        if d.flipped:
            raise RefusedError(f"{method} turned {d.flipped} of {len(piece.F)} triangles of {piece.id} over; use --method auto")
        if not d.overlap_mm2 <= OVERLAP_FRACTION * piece.area:
            raise RefusedError(f"laid flat by {method}, {piece.id} covers {d.overlap_mm2:.3g} mm^2 twice; use --method auto, which cuts it")


def _overall(mesh: Mesh, pieces: list[Piece], distortions: list[Distortion]) -> tuple[float, float]:
    """Mean d over the object's area, and the largest."""
    import numpy as np

    if len(pieces) == 1:
        return distortions[0].mean, distortions[0].max
    areas = [mesh.face_areas[p.faces].sum() for p in pieces]
    return float(np.average([d.mean for d in distortions], weights=areas)), max(d.max for d in distortions)


def _figures(method: str, mesh: Mesh, pieces: list[Piece], distortions: list[Distortion], seconds: float) -> dict[str, Any]:
    import numpy as np

    from skinfab.flatten.distortion import distortion_of, singular_values

    areas = np.array([mesh.face_areas[p.faces].sum() for p in pieces])
    kept = []
    for piece, area in zip(pieces, areas, strict=True):
        # The same shape at the scale that keeps the object's area: the other common choice.
        s = singular_values(piece.V(mesh), piece.F, piece.UV) * np.sqrt(area / piece.area)
        real = mesh.face_areas[piece.faces] > 0
        kept.append(float(np.average(distortion_of(s)[real], weights=mesh.face_areas[piece.faces][real])))
    mean, most = _overall(mesh, pieces, distortions)
    return {
        "method": method,
        "n_faces": len(mesh.F),
        "pieces": [
            {
                "id": p.id,
                "n_faces": len(p.F),
                "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max},
                "mean_at_kept_area": k,
                "flipped": d.flipped,
                "overlap_mm2": d.overlap_mm2,
            }
            for p, d, k in zip(pieces, distortions, kept, strict=True)
        ],
        "distortion": {
            "mean": mean,
            "mean_at_kept_area": float(np.average(kept, weights=areas)),
            "max": most,
        },
        "flatten_s": seconds,
    }
