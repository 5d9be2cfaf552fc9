"""Charts of the tactel array: error over time by way and density, and the seed's figures 4, 5 and 11 with both ways."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.marked import png, ring, save
from skinfab.files import atomic_write

#: Told apart without red and green, and in print.
_COLOURS = {
    "sinc": "#000000",
    "bspline": "#0072B2",
    "gaussian": "#56B4E9",
    "log-parabola": "#E69F00",
    "matched": "#D55E00",
    "span": "#000000",
}
_MARKS = ("o", "s", "D", "^", "v")
_DPI = 150
_PANELS = {"along": "along the finger, mm", "around": "around it, degrees", "line": "direction of a rod, degrees"}


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a panel an experiment, a mark a density; the default is ringed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    densities = list(dict.fromkeys(row["density"] for row in table))
    figure = Figure(figsize=(12.6, 5.2), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Tactel array: worst error against time a frame (simulated)", fontsize=11)
    for axes, (experiment, label) in zip(figure.subplots(1, len(_PANELS)), _PANELS.items(), strict=True):
        rows = [row for row in table if row["experiment"] == experiment and row["method"] in _COLOURS]
        for name in dict.fromkeys(row["method"] for row in rows):
            of = [row for row in rows if row["method"] == name]
            x, y = [row["us"] for row in of], [row["worst"] for row in of]
            axes.plot(x, y, "-", color=_COLOURS[name], lw=0.8)
            for row in of:
                mark = _MARKS[densities.index(row["density"]) % len(_MARKS)]
                axes.plot(row["us"], row["worst"], mark, color=_COLOURS[name], ms=6)
            axes.plot([], [], "-", color=_COLOURS[name], label=f"{name} (published)" if name in ("sinc", "span") else name)
            if name == "matched":
                ring(axes, x[0], y[0])
        for mark, density in zip(_MARKS, densities, strict=False):
            axes.plot([], [], mark, color="#777777", label=f"{density} tactels")
        axes.set(xscale="log", yscale="log", xlabel="processor time a frame, us", ylabel=f"worst error {label}")
        for side in (axes.xaxis, axes.yaxis):
            side.set_major_locator(LogLocator(subs=(1, 2, 5)))
            side.set_major_formatter("{x:g}")
            side.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    # One legend for all: the panels are full.
    handles = {label: handle for axes in figure.axes for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=5, fontsize=8)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why, by the first density, which is the seed's."""
    first = table[0]["density"]
    by = {(row["experiment"], row["method"]): row for row in table if row["density"] == first}
    said = []
    for experiment, words in (("along", "mm along the finger"), ("around", "degrees around it"), ("line", "degrees of direction")):
        old = by[experiment, "span" if experiment == "line" else "sinc"]
        others = [
            row["worst"] for (of, name), row in by.items() if of == experiment and name in _COLOURS and name != "matched" and row != old
        ]
        best = f", the best of the others {min(others):.2g}" if others else ""
        own = by[experiment, "matched"]
        said.append(f"{own['worst']:.2g} {words} at worst in {own['us']:.0f} us (published {old['worst']:.2g} in {old['us']:.0f}{best})")
    return f"matched, on {first} tactels: {'; '.join(said)}; aliasing, not noise, is what the others err by"


def draw_seed(path: Path, *, rods: int = 12) -> None:
    """Write the seed's figures 4, 5 and 11 as PNG: published beside improved on one simulated array."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from skinfab.fingertip.array.simulator import Device
    from skinfab.fingertip.array.study import IMPROVED, PUBLISHED, locators, rods_on, scan, turners

    device = Device(seed=1)
    figure = Figure(figsize=(12.6, 4.6), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("The seed's figures 4, 5 and 11 on one simulated 8 x 8 array: as published, and matched", fontsize=11)
    panels = figure.subplots(1, 3)
    ways = locators(device.geometry)
    for axes, axis, unit, seed in zip(panels, ("along", "around"), ("mm", "degrees"), (0.5, 10.0), strict=False):
        one = scan(device, axis, seed=1)
        for name, style in ((PUBLISHED, "o-"), (IMPROVED, "s-")):
            errors = one.errors(ways[name])
            label = f"{name}: worst {np.abs(errors).max():.2g} {unit}"
            axes.plot(one.true, errors, style, ms=3, lw=0.8, color=_COLOURS[name], label=label)
        for side in (-seed, seed):
            axes.axhline(side, color="#777777", lw=0.8, ls=":")
        axes.set(xlabel=f"place {axis} the finger, {unit}", ylabel=f"found less true, {unit}")
        axes.legend(fontsize=7, title="dotted: what the seed measured", title_fontsize=7, loc="upper center")
        axes.set_ylim(-1.4 * np.abs(axes.get_ylim()).max(), 1.8 * np.abs(axes.get_ylim()).max())
    laid = rods_on(device, rods, seed=1, between=True)
    axes = panels[2]
    for k, (name, turn) in enumerate(turners(device.geometry).items()):
        errors = laid.errors(turn)
        label = f"{name}: worst {np.abs(errors).max():.2g} degrees"
        axes.plot(laid.line_deg + k - 0.5, laid.line_deg + errors, "os"[k], ms=3, color=_COLOURS[name], label=label)
    axes.plot([0, 90], [0, 90], color="#777777", lw=0.8, ls=":")
    axes.set(xlabel="direction of the rod, degrees", ylabel="found, degrees")
    axes.legend(fontsize=7, title="between two stripes", title_fontsize=7, loc="upper left")
    for axes in panels:
        axes.grid(True, lw=0.3, alpha=0.6)
    atomic_write(path, png(figure))
