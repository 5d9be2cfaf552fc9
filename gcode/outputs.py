"""Everything that is made from a skin: G-code, tool paths, moulds, drawings, wiring, the document itself, the report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gcode.estimate import primed
from gcode.used import Used
from gcode.write import PieceGcode, write_previews, write_skin
from skinfab.document import save_skin
from skinfab.drawings.dxf import write_dxf
from skinfab.drawings.labels import skin_labels
from skinfab.drawings.obj import write_flat_obj
from skinfab.drawings.pdf import write_pdf
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.svg import write_svg
from skinfab.errors import InputError
from skinfab.flatten.distortion import Distortion, measure
from skinfab.mould import CastingMould, can_be_cast, skin_moulds, write_mould
from skinfab.progress import Progress, Stopwatch, peak_rss_mb, silent
from skinfab.recipe import recipe
from skinfab.report.build import build_report, write_report
from skinfab.report.html import write_html
from skinfab.report.preview import draw_preview
from skinfab.report.strain_picture import write_strain_picture
from skinfab.report.strains import SensorStrains, sensor_strains
from skinfab.skin import Skin
from skinfab.wiring import wiring, write_wiring
from skinfab.work_order import PrintJob, work_steps


def write_all(
    skin: Skin,
    folder: Path,
    used: Used,
    *,
    distortions: Sequence[Distortion] | None = None,
    notes: Sequence[str] = (),
    progress: Progress = silent,
    watch: Stopwatch | None = None,
) -> dict[str, Any]:
    """Write all that `skinfab make` writes of a skin whose sensors are placed.

    Parameters
    ----------
    skin : Skin
        Naming what is `used`, so that the document saved says so too.
    folder : Path
        There, and empty: `staging.staged_folder` gives one and puts it in place when all went well.
    used : Used
    distortions : sequence of Distortion, optional
        Of the pieces in their order, where at hand; else they are measured.
    notes : sequence of str
        What was said of the skin on the way here: the first of the report's warnings.
    progress : Progress, optional
    watch : Stopwatch, optional
        Whose times go into the report; default one that starts now.

    Returns
    -------
    dict
        The report, as in ``report.json``.

    Raises
    ------
    RefusedError
        A sensor, a mould or a program fails its check.
    InputError
        No piece is large enough to be cast, or a file cannot be written.
    """
    watch = watch or Stopwatch()
    if distortions is None:
        with watch.phase("flatten"):
            distortions = [measure(p.V(skin.mesh), p.F, p.UV, topology=p.topology) for p in skin.pieces]
    progress(0.0, "writing G-code")
    with watch.phase("gcode"):
        printed = write_skin(skin, folder / "gcode", printer=used.printer) if skin.sensors else ()
        (folder / "toolpath").mkdir()
        tool_paths = write_previews(skin, printed, folder / "toolpath", printer=used.printer)
        remarks = [remark for w in printed for remark in w.plan.warnings]
    progress(0.2, "making moulds")
    with watch.phase("mould"):
        moulds = _write_moulds(skin, folder / "mould", used)
    uncast = [
        f"piece {piece.id} is too small to be cast ({piece.area:.2g} mm^2), so it has no mould: leave it bare"
        for piece in skin.pieces
        if not can_be_cast(piece, used.material)
    ]
    progress(0.6, "drawing")
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
        warnings=[*notes, *remarks, *(flaw for m in moulds for flaw in m.warnings), *uncast],
        strains=strains,
    )
    with watch.phase("draw"):
        _write_pictures(skin, distortions, strains, report, folder, tool_paths)
    # The pictures take a while, and the report says how long all of it took.
    report |= {"timing_s": watch.timing_s(), "peak_rss_mb": peak_rss_mb()}
    write_report(report, folder / "report.json")
    progress(1.0, "done")
    return report


def _gcode_facts(written: PieceGcode) -> dict[str, Any]:
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


def _write_moulds(skin: Skin, folder: Path, used: Used) -> list[CastingMould]:
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
    labels = skin_labels(skin)
    write_svg(skin, folder / "flat.svg", labels=labels)
    write_pdf(skin, folder / "flat.pdf", moulds=moulds, labels=labels)
    write_dxf(skin, folder / "flat.dxf", labels=labels)
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


def _recipe(moulds: list[CastingMould], printed: Sequence[PieceGcode], used: Used) -> dict[str, Any]:
    """What to weigh, and what to do in which order."""
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
    skin: Skin, distortions: Sequence[Distortion], strains: SensorStrains, report: dict[str, Any], folder: Path, tool_paths: Sequence[Path]
) -> None:
    draw_preview(skin, distortions, report, folder / "preview.png")
    write_strain_picture(skin, strains, folder / "wrap_strain.svg")
    pictures = {
        "The skin at a glance": folder / "preview.png",
        "The flat pieces, to scale": folder / "flat.svg",
        "What wearing stretches (red) and squeezes (blue)": folder / "wrap_strain.svg",
        **{f"How {file.stem} is printed, to scale": file for file in tool_paths},
    }
    write_html(report, folder / "report.html", pictures=pictures)
