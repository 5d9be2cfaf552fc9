"""The chart of what a frame costs and how well it is read, by way and number of images learned from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import ring, save
from skinfab.bench.optical_frame import DEFAULT, LINEAR, PUBLISHED, WHOLE

#: Told apart without red and green, and in print.
_COLOURS = {PUBLISHED: "#000000", LINEAR: "#0072B2", WHOLE: "#E69F00", DEFAULT: "#D55E00"}
_PANELS = {"offset_mm": "offset, mm", "depth_mm": "depth, mm", "angle_deg": "angle, degrees"}
_DPI = 150
#: Where a decade has numbers.
_TICKS = (1.0, 2.0, 5.0)


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a panel a quantity, larger dots for more images; the default is ringed."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    figure = Figure(figsize=(11.4, 4.2), dpi=_DPI, layout="constrained")
    figure.suptitle("Optical fingertip: mean error against time a frame (simulated)", fontsize=11)
    most = max(row["learned"] for row in table)
    for axes, (key, label) in zip(figure.subplots(1, len(_PANELS)), _PANELS.items(), strict=True):
        for name, colour in _COLOURS.items():
            rows = [row for row in table if row["method"] == name and row[key] is not None and math.isfinite(row[key])]
            axes.plot([row["ms"] for row in rows], [row[key] for row in rows], "-", color=colour, lw=0.8)
            for row in rows:
                size = 8 if row["learned"] == most or not row["learned"] else 4
                axes.plot(row["ms"], row[key], "o", color=colour, ms=size)
                if name == DEFAULT and row["learned"] == most:
                    ring(axes, row["ms"], row[key], size=15)
            axes.plot([], [], "o-", color=colour, label=name)
        axes.set(xscale="log", yscale="log", xlabel="processor time a frame, ms", ylabel=f"mean error of the {label}")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=_TICKS))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    handles, labels = figure.axes[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, title=f"large dots: {most} images learned from")
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    most = max(row["learned"] for row in table)
    own, image, line = (next(r for r in table if (r["method"], r["learned"]) == (name, most)) for name in (DEFAULT, WHOLE, LINEAR))
    return (
        f"{DEFAULT}, from {most} images: {own['offset_mm']:.2f} mm and {own['angle_deg']:.1f} degrees off in {own['ms']:.2f} ms, by "
        f"{LINEAR} {line['offset_mm']:.2f} and {line['angle_deg']:.1f} in {line['ms']:.2f}; {WHOLE} has {image['offset_mm']:.2f} and "
        f"{image['angle_deg']:.1f}, and is twice as far off on real images"
    )
