"""The chart of the centre of gravity: its error over the span of the poses and over their number, beside the paper's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.gravity import USUAL, paper_errors
from skinfab.bench.marked import ring, save

_COLOURS = {"published": "#D55E00", "offset fitted": "#0072B2", "hand weighed": "#009E73"}
_DEFAULT = "offset fitted"
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: error over span and over poses, and what part of the errors the stated 95 % hold."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    figure = Figure(figsize=(11.0, 3.9), dpi=_DPI, layout="constrained")
    figure.suptitle("Centre of gravity: how the hand is turned against the error (simulated)", fontsize=10)
    panels = figure.subplots(1, 3)
    asked = ((panels[0], "span_deg", "median_mm"), (panels[1], "poses", "median_mm"), (panels[2], "span_deg", "covered"))
    for axes, over, key in asked:
        for way, colour in _COLOURS.items():
            fixed, value = ("poses", USUAL[1]) if over == "span_deg" else ("span_deg", USUAL[0])
            rows = sorted((row for row in table if row["way"] == way and row[fixed] == value), key=lambda row: row[over])
            axes.plot([r[over] for r in rows], [r[key] for r in rows], "o-", color=colour, ms=4, lw=1, label=way)
            if key == "median_mm":
                axes.plot([r[over] for r in rows], [r["p95_mm"] for r in rows], ":", color=colour, lw=1, label=f"{way}, 95 %")
            for r in rows:
                if (way, r["span_deg"], r["poses"]) == (_DEFAULT, *USUAL):
                    ring(axes, r[over], r[key])
        axes.set_xscale("log")
        ticks = sorted({row[over] for row in table})
        axes.set_xticks(ticks, [f"{each:g}" for each in ticks], fontsize=8)
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel({"span_deg": f"turned by up to, degrees ({USUAL[1]} poses)", "poses": f"poses (within {USUAL[0]:g} degrees)"}[over])
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    for axes in panels[:2]:
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 4.0, 6.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_ylabel("error, mm")
        axes.axhspan(min(paper_errors()), max(paper_errors()), color="#999999", alpha=0.25, lw=0, label="the paper's table 3")
    panels[2].axhline(0.95, color="#555555", lw=1, ls="--")
    panels[2].set(ylabel="errors within the stated 95 %", ylim=(0, 1.02))
    # The third panel is empty where the first two are full.
    panels[2].legend(*panels[0].get_legend_handles_labels(), fontsize=7, markerscale=0.6, loc="center right")
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why: its own poses, the next fewer and narrower and the next more and wider."""
    own = {(row["span_deg"], row["poses"]): row["median_mm"] for row in table if row["way"] == _DEFAULT}
    span, poses = USUAL
    beside = [f"{n} poses {own[span, n]:.2f}" for n in _next_to(poses, [n for s, n in own if s == span])]
    beside += [f"within {s:g} degrees {own[s, poses]:.2f}" for s in _next_to(span, [s for s, n in own if n == poses])]
    return (
        f"{_DEFAULT}, from {poses} poses within {span:g} degrees, as simulate makes them: a median error of {own[USUAL]:.2f} mm "
        f"({', '.join(beside)}), and no hand need be weighed before"
    )


def _next_to(value: float, values: Sequence[float]) -> list[float]:
    """The next smaller and the next larger one."""
    ends = max((v for v in values if v < value), default=None), min((v for v in values if v > value), default=None)
    return [end for end in ends if end is not None]
