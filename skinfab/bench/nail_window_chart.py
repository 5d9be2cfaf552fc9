"""The chart of window lengths: accuracy over the window, accuracy over the latency, and the errors of direction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import ring, save

#: Told apart without red and green, and in print.
_STYLES = {
    "improved": ("#0b6e4f", "o-"),
    "published, one window": ("#b5451b", "s-"),
    "published, mode of ten": ("#b5451b", "^--"),
}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG; what `skinfab nail run` does is ringed."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.2, 4.2), dpi=_DPI, layout="constrained")
    figure.suptitle("Twelve edges: how long one must look (simulated participants)", fontsize=10)
    window, latency, angle = figure.subplots(1, 3)
    for method, (colour, style) in _STYLES.items():
        rows = [row for row in table if row["method"] == method]
        if not rows:
            continue
        own = [1000 * row["samples"] / 1400 for row in rows]
        for axes, x in ((window, own), (latency, [row["latency_ms"] for row in rows])):
            below = [row["percent"] - row["low"] for row in rows]
            above = [row["high"] - row["percent"] for row in rows]
            axes.errorbar(
                x, [row["percent"] for row in rows], [below, above], fmt=style, color=colour, ms=4, lw=1, elinewidth=0.6, label=method
            )
        angle.plot([row["latency_ms"] for row in rows], [row["angle_deg"] for row in rows], style, color=colour, ms=4, lw=1, label=method)
        if method == "improved":
            weighted = [row["weighted_angle_deg"] for row in rows]
            angle.plot(
                [row["latency_ms"] for row in rows], weighted, "o:", color=colour, mfc="white", ms=4, lw=1, label="weighted by probability"
            )
    default = next(row for row in table if row["default"])
    ring(window, 1000 * default["samples"] / 1400, default["percent"])
    ring(latency, default["latency_ms"], default["percent"])
    ring(angle, default["latency_ms"], default["angle_deg"])
    for axes, words in (
        (window, "one window, ms"),
        (latency, "all readings needed and computing, ms"),
        (angle, "all readings needed and computing, ms"),
    ):
        axes.set(xscale="log", xlabel=words)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    window.set_ylabel("right, % (95 % interval over participants)")
    angle.set(ylabel="mean error of the edge's direction, degrees", ylim=(0, None))
    named = {name: mark for axes in figure.axes for mark, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=len(named), fontsize=8)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    own = {row["samples"]: row for row in table if row["method"] == "improved"}
    default = next(row for row in own.values() if row["default"])
    beside = ", ".join(f"{own[n]['percent']:.1f} % in {own[n]['latency_ms']:.0f} ms" for n in (min(own), max(own)))
    theirs = max((row for row in table if row["method"] != "improved"), key=lambda row: row["percent"], default=None)
    published = f"; as published {theirs['percent']:.1f} % at best, in {theirs['latency_ms']:.0f} ms" if theirs else ""
    return (
        f"the improved method on {default['samples']} readings, where the curve bends: {default['percent']:.1f} % in "
        f"{default['latency_ms']:.0f} ms (the shortest and the longest {beside}){published}"
    )
