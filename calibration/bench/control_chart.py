"""The chart of the control laws: gain, delay and period against the mean error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from calibration.control.protocols import PAPER_DEG
from skinfab.bench.marked import png
from skinfab.files import atomic_write

_COLOURS = {"p": "#b5451b", "branches": "#2b5c9e", "full": "#0b6e4f"}
_LINES = {"uniform": "-", "random": "--"}
_NAMES = {"p": "p, as published", "branches": "branches", "full": "full, the default"}


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a colour a law, a line style a protocol, hollow where the gain is beyond the limit."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullFormatter

    figure = Figure(figsize=(12.0, 5.0), dpi=150)
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.055, right=0.99, top=0.88, bottom=0.2, wspace=0.15)
    figure.suptitle("A robot's joint follows a human's (simulated): mean error")
    panels = dict(zip(("gain", "delay", "period"), figure.subplots(1, 3, sharey=True), strict=True))
    for name, (key, label, ticks) in {
        "gain": ("gain", "gain, 1/s", (1, 2, 3, 5, 8, 12)),
        "delay": ("delay_s", "delay, s (gain: auto)", (0.03, 0.05, 0.1, 0.2)),
        "period": ("period_s", "period of uniform cycles, s", (1, 2, 4, 8)),
    }.items():
        axes = panels[name]
        for law, colour in _COLOURS.items():
            for protocol, style in _LINES.items():
                rows = [row for row in table if (row["experiment"], row["law"], row["protocol"]) == (name, law, protocol)]
                if not rows:
                    continue
                x, y = [row[key] for row in rows], [row["mean_error_deg"] for row in rows]
                axes.plot(x, y, style, color=colour, lw=1.2, label=f"{_NAMES[law]}, {protocol}")
                for row in rows:
                    face = colour if row["margin"] > 1 else "white"
                    axes.plot(row[key], row["mean_error_deg"], "o", color=colour, mfc=face, ms=4, zorder=3)
        axes.set(xscale="log", yscale="log", xlabel=label)
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    for row in table:
        if row["experiment"] == "default" and row["law"] == "full":
            panels["gain"].plot(row["gain"], row["mean_error_deg"], "o", ms=13, mfc="none", color=_COLOURS["full"], mew=1.6, zorder=4)
    for protocol, paper in PAPER_DEG.items():
        panels["gain"].axhline(paper, color="#777777", lw=1, ls=_LINES[protocol])
        panels["gain"].axhline(paper / 2, color="#777777", lw=0.6, ls=":")
    panels["gain"].set_ylabel("mean error, degrees")
    panels["gain"].set_yticks((2, 3, 5, 10, 20, 30), ["2", "3", "5", "10", "20", "30"])
    panels["gain"].yaxis.set_minor_formatter(NullFormatter())
    handles, labels = panels["gain"].get_legend_handles_labels()
    panels["period"].legend(handles, labels, fontsize=7, loc="upper right")
    marks = "ring: the default · hollow: beyond the gain that the loop takes · grey: the paper's errors, dotted: half of them"
    figure.text(0.5, 0.02, marks, ha="center", va="bottom", fontsize=8)
    atomic_write(path, png(figure))
