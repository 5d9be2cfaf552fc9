"""The chart of models and degrees: held-out error over the degree, and over what a sample costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from calibration.strain.calibrate import SAME, WITHIN
from skinfab.bench.marked import ring, save

#: Told apart without red and green, and in print.
_COLOURS = {"poly": "#000000", "branches": "#0072B2", "lag": "#009E73", "play": "#D55E00"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a row of panels a finger; what `skinfab calibrate` chooses most often is ringed."""
    from matplotlib.figure import Figure

    fingers = list(dict.fromkeys(row["finger"] for row in table))
    figure = Figure(figsize=(9.6, 3.6 * len(fingers)), dpi=_DPI, layout="constrained")
    figure.suptitle("Calibration: what a degree and a model are worth on the half that was held out (simulated fingers)", fontsize=10)
    for finger, panels in zip(fingers, figure.subplots(len(fingers), 2, squeeze=False), strict=True):
        rows = [row for row in table if row["finger"] == finger]
        default = max(rows, key=lambda row: row["chosen"])
        for axes, key, label in zip(panels, ("degree", "us_per_sample"), ("degree of the curve", "us a sample"), strict=True):
            for name, colour in _COLOURS.items():
                of = [row for row in rows if row["model"] == name]
                style = "o-" if key == "degree" else "o"
                axes.plot([r[key] for r in of], [r["held_out_rms_deg"] for r in of], style, color=colour, ms=4, lw=1, label=name)
            ring(axes, default[key], default["held_out_rms_deg"], label="chosen most often")
            axes.set(xlabel=label, ylabel=f"{finger} finger: held-out rms, deg", ylim=(0, None))
            axes.grid(True, lw=0.3, alpha=0.6)
        panels[0].legend(fontsize=7)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What is chosen, and why."""
    said = []
    for finger in dict.fromkeys(row["finger"] for row in table):
        rows = [row for row in table if row["finger"] == finger]
        default, plain = max(rows, key=lambda row: row["chosen"]), min(row["held_out_rms_deg"] for row in rows if row["model"] == "poly")
        best = min(row["held_out_rms_deg"] for row in rows)
        said.append(
            f"{finger} finger: {default['held_out_rms_deg']:.2f} degrees, the best curve alone {plain:.2f}, the best of all {best:.2f}"
        )
    return (
        f"chosen anew for every log, here what most get: of its first half, the lowest degree within {WITHIN - 1:.0%} of the least error "
        f"and the simplest model within {1 - SAME:.0%}, because hysteresis must be in it and little else pays ({'; '.join(said)})"
    )
