"""`skinfab make MESH -o DIR`: the walk through all of it, from a mesh to what one takes to the lab."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from skinfab.cli import steps
from skinfab.cli.advice import many_pieces
from skinfab.cli.alike import alike
from skinfab.cli.nozzle_room import with_room_for_nozzle

if TYPE_CHECKING:
    from gcode.write import PieceGcode
    from skinfab.flatten.distortion import Distortion
    from skinfab.mould import CastingMould
    from skinfab.progress import Progress, Stopwatch
    from skinfab.report.strains import SensorStrains
    from skinfab.skin import Skin

Started: TypeAlias = "tuple[Skin, list[Distortion], steps.Profiles, tuple[str, ...]]"

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
    from gcode.write import write_previews, write_skin
    from skinfab.document import save_skin
    from skinfab.mould import can_be_cast
    from skinfab.progress import peak_rss_mb
    from skinfab.report.build import build_report, write_report
    from skinfab.report.strains import sensor_strains
    from skinfab.wiring import wiring, write_wiring

    start = _document if args.mesh.suffix.lower() == ".skin" else _cut_mesh
    skin, distortions, used, notes = start(args, watch, progress)
    progress(0.6, "placing sensors")
    warnings: list[str] = []
    with watch.phase("place"):
        if args.sensors is not None or not skin.sensors:
            roomy, wider = with_room_for_nozzle(used.material, used.printer)
            sensors, warnings = steps.place_sensors(skin, roomy, args.sensors)
            skin, warnings = replace(skin, sensors=sensors), [*wider, *warnings]
    progress(0.75, "writing G-code")
    with watch.phase("gcode"):
        printed = write_skin(skin, folder / "gcode", printer=used.printer) if skin.sensors else ()
        (folder / "toolpath").mkdir()
        tool_paths = write_previews(skin, printed, folder / "toolpath", printer=used.printer)
        remarks = [remark for w in printed for remark in w.plan.warnings]
    progress(0.8, "making moulds")
    with watch.phase("mould"):
        moulds = _write_moulds(skin, folder / "mould", used)
    uncast = [
        f"piece {piece.id} is too small to be cast ({piece.area:.2g} mm^2), so it has no mould: leave it bare"
        for piece in skin.pieces
        if not can_be_cast(piece, used.material)
    ]
    progress(0.9, "drawing")
    with watch.phase("draw"):
        save_skin(skin, folder / "skin.skin")
        _write_drawings(skin, folder, moulds)
        write_wiring(wiring(skin, used.material), folder / "wiring.csv")
    strains = sensor_strains(skin, used.material, conductor_mm=used.printer.heights.print)
    report = build_report(
        skin,
        distortions,
        material=used.material,
        gcode=[_gcode_facts(w) for w in printed],
        moulds=[_mould_facts(m) for m in moulds],
        recipe=_recipe(moulds, printed, used),
        timing_s=watch.timing_s(),
        peak_rss_mb=peak_rss_mb(),
        warnings=[*notes, *warnings, *remarks, *(flaw for m in moulds for flaw in m.warnings), *uncast],
        strains=strains,
    )
    with watch.phase("draw"):
        _write_pictures(skin, distortions, strains, report, folder, tool_paths)
    # The pictures take a while, and the report says how long all of it took.
    report |= {"timing_s": watch.timing_s(), "peak_rss_mb": peak_rss_mb()}
    write_report(report, folder / "report.json")
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
        seams = steps.cut(args, loaded, flattened.mesh, used, part_of(progress, 0.05, 0.6))
    with watch.phase("flatten"):
        skin, distortions = steps.to_skin(loaded, flattened, seams, used=used, max_distortion=args.max_distortion, seed=args.seed)
    remarks = (*flattened.remarks, *many_pieces(skin, wrapped=args.wrap is not None))
    steps.say(remarks[len(flattened.remarks) :])
    return skin, distortions, used, (*loaded.notes, *remarks)


def _document(args: argparse.Namespace, watch: Stopwatch, progress: Progress) -> Started:
    """Read a skin document, for the printer it names or another."""
    from skinfab.document import load_skin
    from skinfab.flatten.distortion import measure

    progress(0.0, "reading")
    with watch.phase("load"):
        skin = load_skin(args.mesh)
        used = steps.profiles(args.printer or skin.printer, args.material or skin.material)
        skin = replace(skin, printer=used.printer_name, material=used.material_name)
    with watch.phase("flatten"):
        distortions = [measure(p.V(skin.mesh), p.F, p.UV, topology=p.topology) for p in skin.pieces]
    return skin, distortions, used, ()


def _gcode_facts(written: PieceGcode) -> dict[str, Any]:
    from gcode.estimate import primed

    s = written.summary
    return {
        "file": f"gcode/{written.file.name}",
        "lines": s.lines,
        "time_s": s.time_s,
        "ink_mm3": s.ink_mm3,
        "bbox_mm": s.bbox_mm,
        "arcs": s.arcs,
        "primed_mm3": primed(written.plan.program),
    }


def _write_moulds(skin: Skin, folder: Path, used: steps.Profiles) -> list[CastingMould]:
    from skinfab.errors import InputError
    from skinfab.mould import skin_moulds, write_mould

    folder.mkdir()
    moulds = skin_moulds(skin, material=used.material)
    if not moulds:
        size = max(skin.object.bbox[1] - skin.object.bbox[0])
        raise InputError(
            f"every piece is too small to be cast: the object is {size:.3g} mm long; check --units, or scale it up with --scale"
        )
    for mould in moulds:
        write_mould(mould, folder / f"{mould.piece}.stl")
    return moulds


def _write_drawings(skin: Skin, folder: Path, moulds: list[CastingMould]) -> None:
    from skinfab.drawings.dxf import write_dxf
    from skinfab.drawings.obj import write_flat_obj
    from skinfab.drawings.pdf import write_pdf
    from skinfab.drawings.sheet import sheet_offsets
    from skinfab.drawings.svg import write_svg

    write_svg(skin, folder / "flat.svg")
    write_pdf(skin, folder / "flat.pdf", moulds=moulds)
    write_dxf(skin, folder / "flat.dxf")
    write_flat_obj(skin.mesh, skin.pieces, sheet_offsets(skin.pieces), folder / "flat.obj")


def _mould_facts(mould: CastingMould) -> dict[str, Any]:
    return {
        "file": f"mould/{mould.piece}.stl",
        "watertight": mould.watertight,
        "cavity_ml": mould.cavity_ml,
        "lip_ml": mould.lip_ml,
        "size_mm": mould.size_mm,
        "wire_slots": [{"sensor": s.sensor, "terminal": s.terminal, "at_mm": s.at, "shared": s.shared} for s in mould.wire_slots],
    }


def _recipe(moulds: list[CastingMould], printed: Sequence[PieceGcode], used: steps.Profiles) -> dict[str, Any]:
    """What to weigh, and what to do in which order."""
    from skinfab.recipe import recipe
    from skinfab.work_order import PrintJob, work_steps

    by_piece = {mould.piece: mould for mould in moulds}
    weighed = recipe({m.piece: m.cavity_ml for m in moulds}, used.material, lips_ml={m.piece: m.lip_ml for m in moulds})
    jobs = [
        PrintJob(w.piece, f"gcode/{w.file.name}", mould.wire_slots, mould.marks + w.plan.offset, w.summary.time_s)
        for w in printed
        for mould in (by_piece[w.piece],)
    ]
    printer = used.printer
    corner = printer.bed.origin if printer.spindle else None  # GRBL: homed and told its places by hand
    return weighed.as_dict() | {"steps": work_steps(weighed, used.material, jobs=jobs, home=printer.home, bed_corner=corner)}


def _write_pictures(
    skin: Skin, distortions: list[Distortion], strains: SensorStrains, report: dict[str, Any], folder: Path, tool_paths: Sequence[Path]
) -> None:
    from skinfab.report.html import write_html
    from skinfab.report.preview import draw_preview
    from skinfab.report.strain_picture import write_strain_picture

    draw_preview(skin, distortions, report, folder / "preview.png")
    write_strain_picture(skin, strains, folder / "wrap_strain.svg")
    pictures = {
        "The skin at a glance": folder / "preview.png",
        "The flat pieces, to scale": folder / "flat.svg",
        "What wearing stretches (red) and squeezes (blue)": folder / "wrap_strain.svg",
        **{f"How {file.stem} is printed, to scale": file for file in tool_paths},
    }
    write_html(report, folder / "report.html", pictures=pictures)
