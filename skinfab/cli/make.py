"""`skinfab make MESH -o DIR`: the walk through all of it, from a mesh to what one takes to the lab."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from skinfab.cli import steps
from skinfab.cli.advice import many_pieces
from skinfab.cli.alike import alike

if TYPE_CHECKING:
    from gcode.used import Used
    from skinfab.flatten.distortion import Distortion
    from skinfab.progress import Progress, Stopwatch
    from skinfab.skin import Skin

Started: TypeAlias = "tuple[Skin, list[Distortion], Used, tuple[str, ...]]"

#: Kinds of warnings shown on the terminal; the report has all.
_SHOWN = 8


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "make",
        help="mesh in, everything out: seams, flat pieces, sensors, G-code, moulds, report",
        description="From a mesh to a skin ready to be cast and printed. DIR gets skin.skin, report.json, report.html, preview.png, "
        "flat.svg, flat.pdf, flat.dxf, flat.obj, wrap_strain.svg, wiring.csv, gcode/PIECE.gcode, toolpath/PIECE.svg "
        "and mould/PIECE.stl. In place of a mesh, a skin document may be given: its seams, "
        "and its sensors where it has any, are taken as they are.",
    )
    steps.add_mesh_options(p)
    p.add_argument("-o", "--output", metavar="DIR", type=Path, required=True, help="folder for the results, made if missing")
    p.add_argument("--sensors", metavar="FILE.toml", type=Path, help="which sensors, and where (see docs/sensors.md; default: automatic)")
    steps.add_cut_options(p)
    steps.add_thickness_options(p, default="what the material profile pours")
    p.add_argument("--json", action="store_true", help="print the report as one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Make everything in a hidden folder, then move it into place."""
    from skinfab.progress import Stopwatch, terminal_progress
    from skinfab.staging import staged_folder

    steps.require_fitting_options(args)
    watch = Stopwatch()
    with staged_folder(args.output) as folder, terminal_progress(quiet=args.json) as progress:
        report, said = _make(args, folder, watch, progress)
    if args.json:
        print(json.dumps(report, allow_nan=False))
        return 0
    # What was said on reading is not said again.
    warnings = alike(report["warnings"][said:])
    steps.say(warnings[:_SHOWN], kind="warning")
    d, ink = report["distortion"], sum(g["ink_mm3"] for g in report["gcode"])
    pieces, sensors = steps.counted(len(report["pieces"]), "piece"), steps.counted(len(report["sensors"]), "sensor")
    print(
        f"{args.output}: {pieces}, d mean {d['mean']:.4f}; {sensors}, {ink:.0f} mm^3 of ink, "
        f"printed in {sum(g['time_s'] for g in report['gcode']) / 60:.0f} min; made in {report['timing_s']['total']:.1f} s"
    )
    # Last of all, so that warnings do not drown it.
    all_of_them = f", all {len(report['warnings'])} warnings" if len(report["warnings"]) > len(warnings[:_SHOWN]) + said else ""
    printed = ", G-code and moulds" if report["gcode"] else " and moulds"
    print(f"{args.output} has the report{printed}; next, open {args.output / 'report.html'}: what to print, weigh and pour{all_of_them}")
    return 0


def _make(args: argparse.Namespace, folder: Path, watch: Stopwatch, progress: Progress) -> tuple[dict[str, Any], int]:
    """The report, and how many of its warnings the user has read already."""
    from gcode.outputs import write_all
    from gcode.used import with_room_for_nozzle
    from skinfab.placement.bare import bare_pieces
    from skinfab.placement.place import place_sensors
    from skinfab.progress import part_of

    start = _document if args.mesh.suffix.lower() == ".skin" else _cut_mesh
    skin, distortions, used, notes = start(args, watch, progress)
    progress(0.6, "placing sensors")
    warnings: list[str] = []
    with watch.phase("place"):
        if args.sensors is not None or not skin.sensors:
            roomy, wider = with_room_for_nozzle(used.material, used.printer)
            sensors, warnings = place_sensors(skin, roomy, args.sensors)
            off = steps.counted(len(skin.lifted), "sensor")
            given_up = [f"all sensors are placed anew, also the {off} that were off"] if skin.lifted else []
            skin, warnings = replace(skin, sensors=sensors, lifted=()), [*wider, *warnings, *given_up]
        else:
            warnings = bare_pieces(skin, with_room_for_nozzle(used.material, used.printer)[0])
    rest = part_of(progress, 0.75, 1.0)
    report = write_all(skin, folder, used, distortions=distortions, notes=[*notes, *warnings], progress=rest, watch=watch)
    return report, len(notes)


def _cut_mesh(args: argparse.Namespace, watch: Stopwatch, progress: Progress) -> Started:
    """Read a mesh, cut and flatten it."""
    from skinfab.progress import part_of

    used = steps.profiles(args.printer, args.material)
    progress(0.0, "reading")
    with watch.phase("load"):
        loaded = steps.load_to_cut(args)
    with watch.phase("segment"):
        flattened = steps.surface(args, loaded.mesh, usual=used.material.depth)
        steps.say(flattened.remarks)
    # A cut is judged by flattening as far as it takes; "flatten" drives it to the end.
    with watch.phase("segment"):
        seams, notes = steps.cut(args, loaded, flattened.mesh, used, part_of(progress, 0.05, 0.6))
    with watch.phase("flatten"):
        bound = steps.bound_of(args)
        skin, distortions = steps.to_skin(loaded, flattened, seams, used=used, max_distortion=bound, max_p99=args.max_p99, seed=args.seed)
    remarks = (*flattened.remarks, *many_pieces(skin, wrapped=args.wrap is not None))
    steps.say(remarks[len(flattened.remarks) :])
    return skin, distortions, used, (*loaded.notes, *remarks, *notes)


def _document(args: argparse.Namespace, watch: Stopwatch, progress: Progress) -> Started:
    """Read a skin document, for the printer it names or another."""
    from skinfab.document import load_skin
    from skinfab.flatten.distortion import measure
    from skinfab.seams.enclosed import enclosed_words

    progress(0.0, "reading")
    with watch.phase("load"):
        skin = load_skin(args.mesh)
        used = steps.profiles(args.printer or skin.printer, args.material or skin.material)
        skin = replace(skin, printer=used.printer_name, material=used.material_name)
    with watch.phase("flatten"):
        distortions = [measure(p.V(skin.mesh), p.F, p.UV, topology=p.topology) for p in skin.pieces]
    warnings = enclosed_words(skin, used.material.neck)
    steps.say(warnings, kind="warning")
    return skin, distortions, used, tuple(warnings)
