"""The chart of contacts: error against the gate and against what it rejects, and events against how well friction is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.force import AVERAGES, DEFAULT
from skinfab.bench.marked import ring, save
from skinfab.fingertip.force.contact import LEAST_FORCE_N

_RULES = {"here": "#0072B2", "published": "#D55E00"}
_NAMES = {"here": "here, the default", "published": "published"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], events: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG; the default is ringed."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.0), dpi=_DPI, layout="constrained")
    figure.suptitle("Six-axis fingertip: averaging and the least force against error and rejection; events (simulated)", fontsize=10)
    panels = figure.subplots(1, 3)
    for k, average in enumerate(AVERAGES):
        rows = [row for row in table if row["average"] == average]
        colour = colormaps["viridis"](0.9 * k / (len(AVERAGES) - 1))
        label = f"{average} sample{'s' if average > 1 else ''}"
        for axes, key in zip(panels[:2], ("gate_n", "rejected"), strict=True):
            axes.plot([row[key] for row in rows], [row["error_p95_mm"] for row in rows], "o-", color=colour, ms=3.5, lw=1, label=label)
    default = next(row for row in table if (row["average"], row["gate_n"]) == (DEFAULT, LEAST_FORCE_N))
    for axes, key, words in zip(panels[:2], ("gate_n", "rejected"), ("least force, N", "rejected, part of contacts"), strict=True):
        ring(axes, default[key], default["error_p95_mm"])
        axes.set(xlabel=words, ylabel="error of the contact, 95 % quantile, mm", yscale="log")
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    panels[0].legend(fontsize=7, title="mean of", title_fontsize=7)
    for rule, shade in _RULES.items():
        rows = [row for row in events if row["rule"] == rule and row["kind"] == "all"]
        spread = [100 * row["friction_spread"] for row in rows]
        for key, style in (("precision", "o-"), ("recall", "s--")):
            panels[2].plot(spread, [row[key] for row in rows], style, color=shade, ms=4, lw=1, label=f"{_NAMES[rule]}: {key}")
            panels[2].fill_between(spread, [r[f"{key}_low"] for r in rows], [r[f"{key}_high"] for r in rows], color=shade, alpha=0.1, lw=0)
    panels[2].set(xlabel="friction angle differs by up to, %", ylabel="events: precision, recall", ylim=(0, 1.02))
    panels[2].grid(True, lw=0.3, alpha=0.6)
    panels[2].legend(fontsize=7)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    here = {row["average"]: row["error_p95_mm"] for row in table if row["gate_n"] == LEAST_FORCE_N}
    others = [error for average, error in here.items() if average != DEFAULT]
    own = next(row for row in table if (row["average"], row["gate_n"]) == (DEFAULT, LEAST_FORCE_N))
    more = min((row for row in table if row["average"] == DEFAULT and row["gate_n"] > LEAST_FORCE_N), key=lambda row: row["gate_n"])
    return (
        f"the mean of {DEFAULT} samples, from {LEAST_FORCE_N:g} N on: at that force it errs by {own['error_p95_mm']:.2f} mm, others "
        f"by {min(others):.2f} to {max(others):.2f}; from {more['gate_n']:g} N on {more['rejected']:.0%} are rejected instead of "
        f"{own['rejected']:.0%}, for {more['error_p95_mm']:.2f} mm"
    )
