"""The chart of models and degrees: held-out error over the degree, and over what a sample costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import png
from skinfab.files import atomic_write

#: Told apart without red and green, and in print.
_COLOURS = {"poly": "#000000", "branches": "#0072B2", "lag": "#009E73", "play": "#D55E00"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a row of panels a finger; what `skinfab calibrate` chooses most often is ringed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    fingers = list(dict.fromkeys(row["finger"] for row in table))
    figure = Figure(figsize=(9.6, 3.6 * len(fingers)), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Calibration: what a degree and a model are worth on the half that was held out (simulated fingers)", fontsize=10)
    for finger, panels in zip(fingers, figure.subplots(len(fingers), 2, squeeze=False), strict=True):
        rows = [row for row in table if row["finger"] == finger]
        default = max(rows, key=lambda row: row["chosen"])
        for axes, key, label in zip(panels, ("degree", "us_per_sample"), ("degree of the curve", "us a sample"), strict=True):
            for name, colour in _COLOURS.items():
                of = [row for row in rows if row["model"] == name]
                style = "o-" if key == "degree" else "o"
                axes.plot([r[key] for r in of], [r["held_out_rms_deg"] for r in of], style, color=colour, ms=4, lw=1, label=name)
            axes.plot(default[key], default["held_out_rms_deg"], "o", ms=14, mfc="none", mec="#555555", mew=1.4, label="chosen")
            axes.set(xlabel=label, ylabel=f"{finger} finger: held-out rms, deg", ylim=(0, None))
            axes.grid(True, lw=0.3, alpha=0.6)
        panels[0].legend(fontsize=7)
    atomic_write(path, png(figure))
