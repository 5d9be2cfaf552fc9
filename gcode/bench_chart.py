"""The chart of arcs and chords: file size, lines and time to write against the deviation from the path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from gcode.printer import load_printer
from skinfab.bench.marked import ring, save

_COLOURS = ("#0b6e4f", "#b5451b", "#2b5c9e")
_DPI = 150
_AXES = (
    ("bytes", "bytes of the file"),
    ("lines", "lines of the file"),
    ("seconds", "processor time to emit and check, s"),
    ("print_s", "time of the print, s"),
)


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a line a program over the chord tolerances, a square for native arcs, the defaults ringed."""
    from matplotlib.figure import Figure

    default = load_printer().process.chord_tolerance
    figure = Figure(figsize=(10.4, 8.0), dpi=_DPI, layout="constrained")
    figure.suptitle("Arcs or chords: what a file costs against how far it leaves the path")
    for axes, (key, label) in zip(figure.subplots(2, 2).flat, _AXES, strict=True):
        for k, name in enumerate(dict.fromkeys(row["program"] for row in table)):
            rows = [row for row in table if row["program"] == name]
            chords = [row for row in rows if row["arcs"] == "lines"]
            native = next(row for row in rows if row["arcs"] == "native")
            axes.plot([r["deviation_mm"] for r in chords], [r[key] for r in chords], "o-", color=_COLOURS[k], ms=5, lw=1, label=name)
            axes.plot(native["deviation_mm"], native[key], "s", color=_COLOURS[k], ms=7)
            ring(axes, native["deviation_mm"], native[key], size=17, color=_COLOURS[k])
            for row in chords:
                if row["chord_tolerance"] == default:
                    ring(axes, row["deviation_mm"], row[key], size=12, color=_COLOURS[k])
        axes.set(xscale="log", yscale="log", xlabel="farthest from the path, mm", ylabel=label)
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
        axes.legend(fontsize=8)
    save(figure, path, default=why(table), notes=[f"squares: native arcs · dots: chords · small rings: --arcs lines, {default:g} mm"])


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    native = {row["program"]: row for row in table if row["arcs"] == "native"}
    chords = [row for row in table if row["arcs"] == "lines"]
    off = max(row["deviation_mm"] for row in native.values())
    least = min(row["bytes"] / native[row["program"]]["bytes"] for row in chords)
    return (
        f"native arcs, where the printer draws them: at most {off:.2g} mm off the path, and the coarsest chords take {least:.1f} times the "
        f"bytes or more; else chords of {load_printer().process.chord_tolerance:g} mm, half of what the best print head repeats"
    )
