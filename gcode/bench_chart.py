"""The chart of arcs and chords: file size, lines and time to write against the deviation from the path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from gcode.printer import load_printer
from skinfab.bench.marked import png
from skinfab.files import atomic_write

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
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    default = load_printer().process.chord_tolerance
    figure = Figure(figsize=(10.4, 8.0), dpi=_DPI)
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.93, bottom=0.115, wspace=0.22, hspace=0.27)
    figure.suptitle("Arcs or chords: what a file costs against how far it leaves the path")
    for axes, (key, label) in zip(figure.subplots(2, 2).flat, _AXES, strict=True):
        for k, name in enumerate(dict.fromkeys(row["program"] for row in table)):
            rows = [row for row in table if row["program"] == name]
            chords = [row for row in rows if row["arcs"] == "lines"]
            native = next(row for row in rows if row["arcs"] == "native")
            axes.plot([r["deviation_mm"] for r in chords], [r[key] for r in chords], "o-", color=_COLOURS[k], ms=5, lw=1, label=name)
            axes.plot(native["deviation_mm"], native[key], "s", color=_COLOURS[k], ms=7)
            axes.plot(native["deviation_mm"], native[key], "o", ms=17, mfc="none", color=_COLOURS[k], mew=1.6)
            for row in chords:
                if row["chord_tolerance"] == default:
                    axes.plot(row["deviation_mm"], row[key], "o", ms=12, mfc="none", color=_COLOURS[k], mew=1.2)
        axes.set(xscale="log", yscale="log", xlabel="farthest from the path, mm", ylabel=label)
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
        axes.legend(fontsize=8)
    marks = f"squares in large rings: native arcs, the default · dots: chords · small rings: the default of --arcs lines, {default:g} mm"
    figure.text(0.5, 0.02, marks, ha="center", va="bottom", fontsize=8)
    atomic_write(path, png(figure))
