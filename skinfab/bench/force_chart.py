"""The chart of contacts: error against the gate and against what it rejects, and events against how well friction is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.force import AVERAGES, DEFAULT
from skinfab.bench.marked import png
from skinfab.files import atomic_write
from skinfab.fingertip.force.contact import LEAST_FORCE_N

_RULES = {"here": "#0072B2", "published": "#D55E00"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], events: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG; the default is ringed."""
    from matplotlib import colormaps
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.0), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Six-axis fingertip: averaging and the least force against error and rejection; events (simulated)", fontsize=10)
    panels = figure.subplots(1, 3)
    for k, average in enumerate(AVERAGES):
        rows = [row for row in table if row["average"] == average]
        colour = colormaps["viridis"](0.9 * k / (len(AVERAGES) - 1))
        label = f"{average} sample{'s' if average > 1 else ''}"
        for axes, key in zip(panels[:2], ("gate_n", "rejected"), strict=True):
            axes.plot([row[key] for row in rows], [row["error_p95_mm"] for row in rows], "o-", color=colour, ms=3.5, lw=1, label=label)
    default = next((row for row in table if (row["average"], row["gate_n"]) == (DEFAULT, LEAST_FORCE_N)), None)
    for axes, key, words in zip(panels[:2], ("gate_n", "rejected"), ("least force, N", "rejected, part of contacts"), strict=True):
        if default:
            axes.plot(default[key], default["error_p95_mm"], "o", ms=14, mfc="none", mec="#555555", mew=1.4, label="the default")
        axes.set(xlabel=words, ylabel="error of the contact, 95 % quantile, mm", yscale="log")
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    panels[0].legend(fontsize=7, title="mean of", title_fontsize=7)
    for rule, shade in _RULES.items():
        rows = [row for row in events if row["rule"] == rule and row["kind"] == "all"]
        spread = [100 * row["friction_spread"] for row in rows]
        for key, style in (("precision", "o-"), ("recall", "s--")):
            panels[2].plot(spread, [row[key] for row in rows], style, color=shade, ms=4, lw=1, label=f"{rule}: {key}")
            panels[2].fill_between(spread, [r[f"{key}_low"] for r in rows], [r[f"{key}_high"] for r in rows], color=shade, alpha=0.1, lw=0)
    panels[2].set(xlabel="friction angle differs by up to, %", ylabel="events: precision, recall", ylim=(0, 1.02))
    panels[2].grid(True, lw=0.3, alpha=0.6)
    panels[2].legend(fontsize=7)
    atomic_write(path, png(figure))
