"""report.html: one file with everything one takes to the lab; it needs no network and runs no script."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.report.words import count, percent

_MEDIA_TYPES = {".png": "image/png", ".svg": "image/svg+xml"}

#: What may differ between two warnings of one kind: P3, C1, S2; 1.5, -3; and lists of them.
_NAMES_AND_NUMBERS = re.compile(r"(?:\b[A-Z]\d+\b|[-+]?\d+(?:\.\d+)?)(?:(?:, | and )(?:\b[A-Z]\d+\b|[-+]?\d+(?:\.\d+)?))*")

#: Of every page.
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; max-width: 68rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } caption { text-align: left; color: #555; padding-bottom: .3rem; }
th, td { padding: .2rem .7rem .2rem 0; text-align: left; vertical-align: top; } th { border-bottom: 1px solid #999; font-weight: 600; }
td.n, th.n { text-align: right; } td.n { white-space: nowrap; } td { overflow-wrap: anywhere; }
tr:nth-child(even) td { background: #f6f6f6; }
figure { margin: 1rem 0; } img { max-width: 100%; } figcaption { color: #555; }
.warning { background: #fff4d6; border-left: 4px solid #d99a00; padding: .1rem .8rem; margin: .4rem 0; }
.warning p, .warning ul { margin: .3rem 0; } .warning ul { padding-left: 1.2rem; }
li { margin: .25rem 0; } code { overflow-wrap: anywhere; } .table { overflow-x: auto; }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } tr, figure { break-inside: avoid; } }
"""


def write_html(report: Mapping[str, Any], path: str | Path, *, pictures: Mapping[str, Path] | None = None) -> None:
    """Write the report for people.

    Parameters
    ----------
    report : mapping
        As `build_report` gives it.
    path : path
    pictures : mapping of caption to path, optional
        PNG or SVG files; they go into the page itself.

    Raises
    ------
    InputError
        A picture is neither PNG nor SVG, or cannot be read; the page cannot be written.
    """
    name = report["mesh"]["file"]
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">',
        f"<title>Skin for {escape(name)}</title><style>{STYLE}</style></head><body>",
        f"<h1>Skin for {escape(name)}</h1>",
        _summary(report),
        *_warnings(report["warnings"]),
        *(_figure(caption, Path(picture)) for caption, picture in (pictures or {}).items()),
        _section("Made for", _made_for(report)),
        _section("Pieces", _pieces(report)),
        _section("Sensors", _sensors(report)),
        _section("Worn", _worn(report)),
        _section("Wires", _wires(report)),
        _section("G-code", _gcode(report)),
        _section("Moulds", _moulds(report)),
        _section("Recipe: what to weigh", _recipe(report["recipe"])),
        _section("Order of work", _steps(report["recipe"].get("steps", ()))),
        "</body></html>",
    ]
    atomic_write(path, "\n".join(part for part in parts if part) + "\n")


def _summary(report: Mapping[str, Any]) -> str:
    d, mesh = report["distortion"], report["mesh"]
    size = " x ".join(f"{high - low:.1f}" for low, high in zip(*mesh["bbox_mm"], strict=True))
    return (
        f"<p>{mesh['n_faces']:,} faces, {size} mm; {count(report['pieces'], 'flat piece')}, {report['seam_mm']:.0f} mm of seams, "
        f"{count(report['sensors'], 'sensor')}. Distortion d: mean {d['mean']:.4f}, 99 % of the area under {d['p99']:.4f}, "
        f"largest {d['max']:.4f} (4 is perfect).</p>"
    )


def _warnings(warnings: Sequence[str]) -> list[str]:
    """A box for each kind of warning: those that differ only in names and numbers stand together."""
    kinds: dict[str, list[str]] = {}
    for warning in warnings:
        kinds.setdefault(_NAMES_AND_NUMBERS.sub("#", warning), []).append(warning)
    boxes = []
    for same in kinds.values():
        text = f"<p>{escape(same[0])}</p>" if len(same) == 1 else "<ul>" + "".join(f"<li>{escape(each)}</li>" for each in same) + "</ul>"
        boxes.append(f'<div class="warning">{text}</div>')
    return boxes


def _made_for(report: Mapping[str, Any]) -> str:
    """What the result depends on: whoever prints it checks these first."""
    made, mesh = report["made_for"], report["mesh"]
    rows = [
        ["printer profile", made["printer"]],
        ["material profile", f"{made['material']} ({made['material_name']})"],
        ["ink", made["ink"]],
        ["bead", f"{made['bead_width_mm']:g} mm wide, cross-section {made['bead_area_mm2']:g} mm²"],
        ["skin", f"{made['skin_thickness_mm']:g} mm thick"],
        ["flattened", _flattened_at(made["flattened_at_mm"])],
        ["object", f"{mesh['file']}, read in {mesh['units']}" + (f", times {made['scale']:g} to mm" if made["scale"] != 1 else "")],
        ["SHA-256 of the object's file", mesh["sha256"]],
        ["bound on each piece's mean d", f"{made['max_distortion']:g}"],
        ["seed", str(made["seed"])],
        ["software", made["software"]],
    ]
    return _table(["setting", "value"], rows)


def _pieces(report: Mapping[str, Any]) -> str:
    rows = [
        [
            p["id"],
            " x ".join(f"{side:.1f}" for side in p["size_mm"]),
            f"{p['n_faces']:,}",
            f"{p['area_mm2']:.1f}",
            f"{p['boundary_mm']:.1f}",
            *(f"{p['distortion'][key]:.4f}" for key in ("mean", "p95", "p99", "max")),
            str(p["flipped"]),
            f"{p['overlap_mm2']:.3g}",
        ]
        for p in report["pieces"]
    ]
    head = [
        "piece",
        "#size, mm",
        "#faces",
        "#area, mm²",
        "#outline, mm",
        "#d mean",
        "#d 95 %",
        "#d 99 %",
        "#d max",
        "#flipped",
        "#overlap, mm²",
    ]
    return _table(head, rows, "Areas and outlines are those of the flat pieces.")


def _sensors(report: Mapping[str, Any]) -> str:
    alike = _alike([s["params"] for s in report["sensors"]])
    rows = [
        [
            str(s["channel"]),
            s["id"],
            s["kind"],
            s["piece"],
            _parameters({key: value for key, value in s["params"].items() if key not in alike}),
            f"{s['length_mm']:.1f}",
            f"{s['ink_mm3']:.1f}",
            f"{s['resistance_kohm']['median']:.0f} ({s['resistance_kohm']['low']:.0f} to {s['resistance_kohm']['high']:.0f})",
            " / ".join(f"{percent(s['wrap_strain'][key]):.2f}" for key in ("mean", "max")),
        ]
        for s in report["sensors"]
    ]
    head = ["#channel", "sensor", "kind", "piece", "parameters, mm", "#length, mm", "#ink, mm³", "#resistance, kΩ", "#wrap strain, %"]
    note = "Resistance: median, and the interval of nine prints in ten. Wrap strain: mean / largest, from flat to worn."
    return _table(head, rows, f"{note} All sensors: {_parameters(alike)}." if alike else note)


def _alike(params: Sequence[Mapping[str, float | bool]]) -> dict[str, float | bool]:
    """The parameters that all of several sensors have with the same value: they are said once."""
    return {key: value for key, value in params[0].items() if all(p.get(key) == value for p in params)} if len(params) > 1 else {}


def _parameters(values: Mapping[str, float | bool]) -> str:
    return ", ".join(f"{key} = {('no', 'yes')[v] if isinstance(v, bool) else f'{v:g}'}" for key, v in values.items())


def _flattened_at(distance: float) -> str:
    return f"the surface {distance:g} mm outside the object, amid the skin" if distance else "the object's own surface"


def _worn(report: Mapping[str, Any]) -> str:
    """What wearing does to each conductor, part by part."""
    made = report["made_for"]
    rows = [
        [
            s["id"],
            f"{s['length_mm']:.1f}",
            f"{w['worn_length_mm']:.1f}",
            *(f"{percent(part['mean']):.2f} / {percent(part['max']):.2f}" for part in (w["membrane"], w["bending"], w)),
            f"{s['resistance_kohm']['median']:.0f}",
            f"{w['worn_resistance_kohm']:.0f}",
            f"{percent(w['resistance_factor'] - 1):+.1f}",
        ]
        for s in report["sensors"]
        for w in (s["wrap_strain"],)
    ]
    head = [
        "sensor",
        "#printed, mm",
        "#worn, mm",
        "#membrane, %",
        "#bending, %",
        "#together, %",
        "#R0 flat, kΩ",
        "#R0 worn, kΩ",
        "#shift of the line, %",
    ]
    note = (
        "From lying flat to being worn, mean / largest over a skin's thickness of path; + is stretched. Membrane: of the skin's neutral "
        f"surface, {made['neutral_mm']:g} mm from its inner side; bending: of the conductor beyond it, printed {made['conductor_mm']:g} mm "
        "from the inner side, which lies on the floor of the mould and then on the object. Resistances are medians of prints."
    )
    return _table(head, rows, note)


def _wires(report: Mapping[str, Any]) -> str:
    """Which wire comes from where, leaves the mould where, and goes where."""
    slots = {
        (slot["sensor"], slot["terminal"]): ", ".join(f"{each:.1f}" for each in slot["at_mm"]) + (" (shared)" if slot["shared"] else "")
        for mould in report["moulds"]
        for slot in mould.get("wire_slots", [])
    }
    rows = [
        [
            f"{s['id']}-{k}",
            s["id"],
            str(k),
            s["piece"],
            f"{x:.1f}, {y:.1f}",
            slots.get((s["id"], k), "not known"),
            str(s["channel"]),
            _input(s),
        ]
        for s in report["sensors"]
        for k, (x, y) in enumerate(s["terminals_mm"], start=1)
    ]
    head = ["wire", "sensor", "#terminal", "piece", "#pad at x, y, mm", "#slot at x, y, mm", "#channel", "board, input"]
    return _table(head, rows, "Label each wire as you pierce it into its pad. x and y count from the piece's origin, the + in the picture.")


def _input(sensor: Mapping[str, Any]) -> str:
    """Which input of which multiplexer board, as the boards' print counts them."""
    return f"{sensor['board']}, C{sensor['board_input']}" if "board" in sensor else "not known"


def _gcode(report: Mapping[str, Any]) -> str:
    rows = []
    for g in report["gcode"]:
        low, high = g["bbox_mm"]
        box = ", ".join(f"{axis} {a:.1f} … {b:.1f}" for axis, a, b in zip("XYZ", low, high, strict=False))
        primed = f"{g['primed_mm3']:.1f}" if "primed_mm3" in g else "not known"
        rows.append([g["file"], f"{g['lines']:,}", str(g["arcs"]), f"{g['time_s'] / 60:.1f}", f"{g['ink_mm3']:.1f}", primed, box])
    head = ["file", "#lines", "#arcs", "#time, min", "#ink laid, mm³", "#in the nozzle, mm³", "extent on the bed, mm"]
    # What one file draws back, the next one pushes again.
    load = sum(g["ink_mm3"] for g in report["gcode"]) + max((g.get("primed_mm3", 0.0) for g in report["gcode"]), default=0.0)
    note = f"Load {load:.0f} mm³ of ink and what your needle and hose hold: that dead volume is in no profile."
    return _table(head, rows, note)


def _moulds(report: Mapping[str, Any]) -> str:
    rows = [
        [
            m["file"],
            " x ".join(f"{side:.1f}" for side in m["size_mm"]) if "size_mm" in m else "not known",
            "yes" if m["watertight"] else "NO",
            f"{m['cavity_ml']:.2f}",
            f"{m.get('lip_ml', 0.0):.2f}",
        ]
        for m in report["moulds"]
    ]
    return _table(["file", "#outer size, mm", "watertight", "#piece, ml", "#lips, ml"], rows)


def _recipe(recipe: Mapping[str, Any]) -> str:
    """What to weigh for each piece and for all; whatever else the recipe holds by its name."""
    tables = []
    for batch in recipe.get("batches", []):
        names = list(batch["weigh_g"])
        mixes = [(piece, portion, batch["pour_g"][piece]) for piece, portion in batch["portions"].items()]
        mixes += [("all together", batch, sum(batch["pour_g"].values()))]
        rows = [
            [who, *(f"{mix['weigh_g'][name]:.2f}" for name in names), f"{mix['mass_g']:.2f}", f"{poured:.2f}"] for who, mix, poured in mixes
        ]
        caption = f"The {batch['layer']} layer, {batch['depth']:g} mm, in g: weigh from left to right."
        tables.append(_table(["piece", *(f"#{name}" for name in names), "#mixed", "#of it poured"], rows, caption))
    rest = {key: value for key, value in recipe.items() if key not in ("batches", "steps")}
    words = ", ".join(f"{escape(key.replace('_', ' '))}: {escape(str(value))}" for key, value in rest.items())
    return "\n".join([*tables, f"<p>{words}</p>"] if words else tables)


def _section(title: str, body: str) -> str:
    return f"<h2>{escape(title)}</h2>\n{body}" if body else ""


def _steps(steps: Sequence[str]) -> str:
    return "<ol>" + "".join(f"<li>{escape(step)}</li>" for step in steps) + "</ol>" if steps else ""


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], caption: str = "") -> str:
    """A table; a heading that begins with # is of a column of numbers."""
    if not rows:
        return ""
    marks = [' class="n"' if title.startswith("#") else "" for title in head]
    top = "".join(f"<th{mark}>{escape(title.removeprefix('#'))}</th>" for mark, title in zip(marks, head, strict=True))
    body = "\n".join("<tr>" + "".join(f"<td{m}>{escape(cell)}</td>" for m, cell in zip(marks, row, strict=True)) + "</tr>" for row in rows)
    note = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f'<div class="table"><table>{note}<thead><tr>{top}</tr></thead><tbody>\n{body}\n</tbody></table></div>'


def _figure(caption: str, picture: Path) -> str:
    media_type = _MEDIA_TYPES.get(picture.suffix.lower())
    if media_type is None:
        raise InputError(f"{picture}: a page shows PNG and SVG, not {picture.suffix!r}")
    try:
        data = base64.b64encode(picture.read_bytes()).decode("ascii")
    except OSError as fault:
        raise InputError(f"{picture}: {fault.strerror}") from fault
    # As an image, an SVG runs no script and fetches nothing.
    return f'<figure><img alt="{escape(caption)}" src="data:{media_type};base64,{data}"><figcaption>{escape(caption)}</figcaption></figure>'
