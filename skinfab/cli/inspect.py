"""``skinfab inspect``: what a mesh is, what is wrong with it, and what repair would do."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.mesh.inspect import Inspection
    from skinfab.mesh.io import Loaded
    from skinfab.seams.expect import Expected


_COUNTS = (
    *("faces", "vertices", "components", "genus", "open_edges", "boundary_loops", "nonmanifold_edges", "nonmanifold_vertices"),
    *("degenerate_faces", "duplicate_faces", "unreferenced_vertices", "inconsistent_edges", "one_sided_faces", "slivers"),
)


def add_parser(subparsers: Any) -> None:
    """Declare the command."""
    p = subparsers.add_parser("inspect", help="say what a mesh is, what is wrong with it and what repair would do")
    p.add_argument("mesh", type=Path, metavar="MESH", help="OBJ, STL, PLY, OFF or GLB file")
    p.add_argument("--units", choices=("mm", "cm", "m", "in"), help="unit of the file (default: guessed from its size)")
    p.add_argument("--scale", type=steps.positive, default=1.0, metavar="S", help="multiply all coordinates by S")
    p.add_argument("--json", action="store_true", help="print one JSON object")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Inspect, print, and refuse a mesh that `skinfab make` could not use without --repair."""
    from skinfab.mesh.inspect import inspect
    from skinfab.mesh.io import load_mesh
    from skinfab.mesh.repair import clean, repair, require_usable
    from skinfab.seams.expect import expected_pieces

    loaded = load_mesh(args.mesh, units=args.units, scale=args.scale)
    found = inspect(loaded.mesh.V, loaded.mesh.F)
    cleaned, done = clean(loaded.mesh)
    after = inspect(cleaned.V, cleaned.F) if done else found
    would_do = repair(cleaned)[1] if after.open_edges or not after.usable else []
    expected = expected_pieces(cleaned) if after.usable and after.faces else None
    if args.json:
        _print_json(loaded, found, after, done, would_do, expected)
    else:
        _print_table(loaded, found, after, done, would_do, expected)
    require_usable(cleaned)
    return 0


def _print_json(
    loaded: Loaded, found: Inspection, after: Inspection, done: list[str], would_do: list[str], expected: Expected | None
) -> None:
    import json
    from dataclasses import asdict

    report = {"file": loaded.file, "sha256": loaded.sha256, "units": loaded.units, "scale": loaded.scale, "notes": list(loaded.notes)}
    report |= asdict(found) | {"closed": found.closed, "usable": after.usable}
    report["after_cleaning"] = asdict(after) | {"closed": after.closed}
    report |= {"cleaning_does": done, "repair_would_do": would_do, "expected": None if expected is None else asdict(expected)}
    print(json.dumps(report))


def _print_table(
    loaded: Loaded, found: Inspection, after: Inspection, done: list[str], would_do: list[str], expected: Expected | None
) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(highlight=False)
    table = Table("", "file", "cleaned", title=Text(loaded.file), title_justify="left")
    for row in _COUNTS:
        table.add_row(row.replace("_", " ").replace("nonm", "non-m"), _shown(getattr(found, row)), _shown(getattr(after, row)))
    for row, unit, digits in (("size_mm", "mm", 1), ("area_mm2", "mm2", 0)):
        name = row.split("_")[0] + f" ({unit})"
        table.add_row(name, *(_shown(getattr(which, row), digits) for which in (found, after)))
    table.add_row("usable", "yes" if found.usable else "no", "yes" if after.usable else "no")
    console.print(table)
    for heading, lines in (
        ("Note", loaded.notes),
        ("Found", [fault.sentence for fault in found.faults]),
        ("Cleaning (always done)", done),
        ("With --repair", would_do),
        ("Expect", [] if expected is None else [_expectation(expected)]),
    ):
        for line in lines:
            console.print(Text(f"{heading}: {line}"), soft_wrap=True)


def _expectation(expected: Expected) -> str:
    least, few = steps.counted(expected.pieces, "piece"), steps.counted(expected.components, "piece")
    return (
        f"at least {least} without darts at a mean d of 4.05, about {expected.compact} where they are compact (estimates, by "
        f"{expected.curvature_sr:.1f} sr of smooth curvature; machined parts need more); with darts, {few} may do"
    )


def _shown(value: object, digits: int | None = None) -> str:
    """A count, a size, or the genus of each component (the first ten)."""
    if not isinstance(value, tuple):
        return f"{value:.{digits}f}" if isinstance(value, float) else str(value)
    if digits is not None:
        return " x ".join(f"{v:.{digits}f}" for v in value)
    parts = ["undefined" if v is None else str(v) for v in value[:10]]
    return ", ".join(parts) + (f", ... ({len(value)})" if len(value) > 10 else "")
