"""Steps that several commands share: options, reading the mesh, cutting it, writing the document."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.tolerances import BOUNDS

if TYPE_CHECKING:
    from gcode.used import Used
    from skinfab.flatten.distortion import Distortion
    from skinfab.mesh.io import Loaded
    from skinfab.mesh.model import Mesh
    from skinfab.mesh.surface import Surface
    from skinfab.pieces import Piece
    from skinfab.progress import Progress
    from skinfab.seams.auto import Seams
    from skinfab.seams.judge import Limits
    from skinfab.skin import Skin


def positive(text: str) -> float:
    """A finite number above zero, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def seed(text: str) -> int:
    """A whole number from zero up, for argparse."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 up")
    return int(text)


def counting(text: str) -> int:
    """A whole number from one up, for argparse."""
    if not (text.isascii() and text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 up")
    return int(text)


def not_negative(text: str) -> float:
    """A finite number from zero up, for argparse."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 0 up")
    return value


def share(text: str) -> float:
    """A number from 0 to 1, for argparse."""
    value = not_negative(text)
    if value > 1:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 (the inner side) and 1 (the outer side)")
    return value


def mean_bound(text: str) -> float:
    """A bound on the mean d, for argparse: one of `BOUNDS` by name, or as `bound`."""
    if text in BOUNDS:
        return BOUNDS[text]
    try:
        return bound(text)
    except argparse.ArgumentTypeError as fault:
        if text[:1].isalpha():
            raise argparse.ArgumentTypeError(f"{text!r} is neither a number above 4 nor one of {', '.join(BOUNDS)}") from fault
        raise


def bound(text: str) -> float:
    """A bound on d, for argparse: above the perfect 4."""
    value = positive(text)
    if not value > 4:
        raise argparse.ArgumentTypeError(f"{text} is not above 4, which is a perfect flattening")
    return value


def named(suffix: str) -> Callable[[str], Path]:
    """A path whose name must end in `suffix`, for argparse: a file is what its name says."""

    def check(text: str) -> Path:
        if Path(text).suffix.lower() != suffix:
            raise argparse.ArgumentTypeError(f"{text!r} does not end in {suffix}")
        return Path(text)

    return check


def profile(text: str) -> str:
    """A printer or a material by its name or file, for argparse: one that is empty, of a variable that is not set, is not the usual one."""
    if not text:
        raise argparse.ArgumentTypeError("it is empty; give a name or a file, or leave it out")
    return text


def add_mesh_options(p: argparse.ArgumentParser) -> None:
    """MESH and how to read it."""
    p.add_argument("mesh", metavar="MESH", type=Path, help="OBJ, STL, PLY, OFF or GLB file")
    p.add_argument("--units", choices=("mm", "cm", "m", "in"), help="unit of the file (default: guessed from its size, and said)")
    p.add_argument("--scale", type=positive, default=1.0, metavar="S", help="multiply all coordinates by S")
    p.add_argument("--repair", action="store_true", help="mend faults that change the surface: holes, non-manifold edges, specks")


def add_cut_options(p: argparse.ArgumentParser) -> None:
    """What to cut and where, and what pieces have to keep to."""
    p.add_argument(
        "--wrap",
        type=positive,
        metavar="D",
        help="skin the outside alone: bridge holes and gaps that a ball D mm across cannot enter (8 is a fingertip; see docs/wrapping.md)",
    )
    p.add_argument("--cuts", metavar="FILE", type=Path, help="seams by hand: a text file of vertex paths (see docs/cuts.md); just these")
    p.add_argument("--complete", action="store_true", help="with --cuts: add automatic seams where those do not give good pieces")
    p.add_argument(
        "--pieces",
        choices=("fewest", "usual", "simplest"),
        default="usual",
        help="of automatic seams: as few pieces, with as little seam, as the bound allows; simple ones well within it; or compact ones "
        "without darts (default: usual)",
    )
    p.add_argument(
        "--max-distortion",
        type=mean_bound,
        metavar="D|NAME",
        help="mean d of a piece at most (default 4.05; 4 is perfect), or a name for it: "
        + ", ".join(f"{name} ({value:g})" for name, value in BOUNDS.items())
        + "; more is less seam",
    )
    p.add_argument("--max-p99", type=bound, metavar="D", help="d that 99 %% of a piece's area keep to (default: not asked for)")
    p.add_argument("--printer", type=profile, metavar="NAME|FILE", help="printer profile, whose bed the pieces must fit")
    p.add_argument("--material", type=profile, metavar="NAME|FILE.toml", help="material profile: ink, silicone, mould (see skinfab strips)")
    p.add_argument("--seed", type=seed, default=0, help="kept in the document; the same seed gives the same result")


def add_thickness_options(p: argparse.ArgumentParser, *, default: str = "0, the object's own surface") -> None:
    """How thick the skin is, so that it closes without being stretched on."""
    p.add_argument(
        "--thickness",
        type=not_negative,
        metavar="T",
        help=f"flatten the surface NEUTRAL x T mm outside the object, on which a skin T mm thick keeps its lengths (default: {default})",
    )
    p.add_argument(
        "--neutral",
        type=share,
        default=0.5,
        help="how far through the skin, from 0 (inner side) to 1, bending stretches nothing (default 0.5)",
    )


def require_fitting_options(args: argparse.Namespace) -> None:
    """Options that do not go together are wrong usage."""
    if args.complete and args.cuts is None:
        args.wrong_usage("--complete goes with --cuts FILE")
    if args.pieces != "usual" and args.cuts is not None and not args.complete:
        args.wrong_usage("--pieces is for automatic seams, and --cuts gives them by hand; give one of them, or add --complete")
    if args.wrap is not None and args.cuts is not None:
        args.wrong_usage("--cuts names vertices of the mesh file, and --wrap makes a surface of its own; give one of them")
    if args.mesh.suffix.lower() != ".skin":
        return
    if args.cuts or args.units or args.repair or args.wrap or args.scale != 1.0:
        args.wrong_usage("a skin document is cut and scaled already: --cuts, --units, --scale, --repair and --wrap go with a mesh")
    if args.thickness is not None or args.neutral != 0.5:
        args.wrong_usage("a skin document is flattened already: --thickness and --neutral go with a mesh")


def load(args: argparse.Namespace) -> Loaded:
    """The mesh that the arguments name, fit for use; what was done to it is said on standard error."""
    from skinfab.mesh.door import load_usable

    loaded = load_usable(args.mesh, units=args.units, scale=args.scale, mend=args.repair)
    say(loaded.notes)
    return loaded


def load_to_cut(args: argparse.Namespace) -> Loaded:
    """As `load`; with ``--wrap`` only the outside of it."""
    loaded = load(args)
    if args.wrap is None:
        return loaded
    from skinfab.mesh.wrap import WRAP_OFFSET, wrap

    mesh = wrap(loaded.mesh, args.wrap)
    note = (
        f"only the outside is skinned: the object has {loaded.mesh.area:.0f} mm^2 of surface, what a ball of {args.wrap:g} mm can roll on "
        f"{mesh.area:.0f}; the skin lies {args.wrap * WRAP_OFFSET:.2g} mm off the object"
    )
    say([note])
    return replace(loaded, mesh=mesh, notes=(*loaded.notes, note))


def counted(number: int, what: str) -> str:
    """A number and its noun: 1 piece, 2 pieces."""
    return f"{number} {what}" + ("" if number == 1 else "s")


def say(notes: Sequence[str], *, kind: str = "note") -> None:
    """Sentences for the user, one a line, on standard error: standard output is for results."""
    for note in notes:
        print(f"{kind}: {note}", file=sys.stderr)


def profiles(printer: str | None = None, material: str | None = None) -> Used:
    """Printer and material by the names given, or the bundled ones."""
    from gcode.used import load_used

    return load_used(printer, material)


def bound_of(args: argparse.Namespace, skin: Skin | None = None) -> float:
    """The bound that ``--max-distortion`` gives; without it that of the document, or the usual one."""
    from skinfab.skin import Skin as Document

    if args.max_distortion is not None:
        return float(args.max_distortion)
    return Document.max_distortion if skin is None else skin.max_distortion


def limits(max_distortion: float, used: Used, max_p99: float | None = None) -> Limits:
    """Pieces within the distortion bounds whose moulds fit the bed."""
    from gcode.used import limits_for

    within = limits_for(used, max_distortion)
    return within if max_p99 is None else replace(within, p99=max_p99)


def surface(args: argparse.Namespace, mesh: Mesh, *, usual: float = 0.0) -> Surface:
    """The surface that ``--thickness`` asks for; without it, for the usual thickness (mm)."""
    from skinfab.mesh import surface as library

    return library.surface(mesh, thickness=args.thickness, neutral=args.neutral, usual=usual)


def to_skin(
    loaded: Loaded, flattened: Surface, found: Seams, *, used: Used, max_distortion: float, seed: int, max_p99: float | None = None
) -> tuple[Skin, list[Distortion]]:
    """The document of a cut mesh without sensors, and each piece's distortion in its order."""
    from skinfab.seams import document
    from skinfab.skin import Source

    source = Source(loaded.file, loaded.sha256, loaded.units, loaded.scale)
    within = limits(max_distortion, used, max_p99)
    return document.to_skin(
        loaded.mesh, source, flattened, found, within, printer=used.printer_name, material=used.material_name, seed=seed
    )


def cut(args: argparse.Namespace, loaded: Loaded, mesh: Mesh, used: Used, progress: Progress) -> tuple[Seams, list[str]]:
    """Automatic seams of the surface that is flattened, or those that ``--cuts`` gives; what was said of them on standard error."""
    from skinfab.seams.auto import find_seams
    from skinfab.seams.parted import parted_text

    within, neck = limits(bound_of(args), used, args.max_p99), used.material.neck

    def report(done: float) -> None:
        progress(done, "cutting and flattening")

    if args.cuts is not None:
        found, notes = _by_hand(args, loaded, mesh, within, neck, report)
    else:
        found, notes = find_seams(mesh, within, neck=neck, aim=args.pieces, progress=report), []
    notes += parted_text(found.pieces, within)
    say(notes)
    return found, notes


def _by_hand(
    args: argparse.Namespace, loaded: Loaded, mesh: Mesh, within: Limits, neck: float, progress: Callable[[float], None]
) -> tuple[Seams, list[str]]:
    from skinfab.mesh.io import load_mesh
    from skinfab.seams.manual import completed, cut_along, numbers_in, read_cuts, seams_by_hand

    # Numbers in the file count the mesh file's vertices, before any cleaning.
    raw = load_mesh(args.mesh, units=args.units, scale=args.scale).mesh
    paths = [raw.V[path] for path in read_cuts(args.cuts, len(raw.V))]
    numbers = numbers_in(raw, loaded.mesh)
    # The surface that is flattened has the same vertices and edges, elsewhere.
    by_hand = cut_along(loaded.mesh, paths, numbers=numbers)
    if not args.complete:
        return seams_by_hand(mesh, by_hand, within, numbers=numbers), []
    seams = completed(mesh, by_hand, within, neck=neck, aim=args.pieces, progress=progress)
    added = int((seams.cut & ~by_hand).sum())
    return seams, [f"{counted(added, 'edge')} {'was' if added == 1 else 'were'} cut beyond those given by hand"] if added else []


def piece_lines(pieces: Sequence[Piece], distortions: Sequence[Distortion]) -> list[str]:
    """One line a piece, for a person to read."""
    return [
        f"{piece.id}: {piece.size[0]:.1f} x {piece.size[1]:.1f} mm, {counted(len(piece.F), 'triangle')}, "
        f"d mean {d.mean:.4f} p99 {d.p99:.3f} max {d.max:.3f}"
        for piece, d in zip(pieces, distortions, strict=True)
    ]
