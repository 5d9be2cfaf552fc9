"""The figure of what was replayed or measured: curves over time."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.files import atomic_write

FloatArray = NDArray[np.float64]

#: Told apart by people who see no red or no green, and in print; the first is the truth, where there is one.
COLOURS = ("#999999", "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000")
#: Curves that are drawn at most, and points of each.
CURVES, POINTS = 8, 20_000


def draw_over_time(
    time: FloatArray,
    curves: Mapping[str, FloatArray],
    path: str | Path,
    *,
    title: str,
    quantity: str,
    simulated: bool,
    flagged: NDArray[np.bool_] | None = None,
) -> None:
    """Write the figure, PNG or PDF by its name.

    Parameters
    ----------
    time : (n,) float, s
    curves : mapping of (n,) float
        By what they are called; NaN leaves a gap.
    path : path
    title, quantity : str
        The figure's, and that of the upright axis.
    simulated : bool
        Said in the figure.
    flagged : (n,) bool, optional
        Where the last curve lies outside what its sensor knows; shaded.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 3.0), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    step = max(len(time) // POINTS, 1)
    shown = list(curves.items())[:CURVES]
    colours = COLOURS if len(shown) > 1 else COLOURS[1:]
    for (name, values), colour in zip(shown, colours, strict=False):
        axes.plot(time[::step], values[::step], color=colour, linewidth=1.6 if colour == COLOURS[0] else 0.9, label=name)
    if flagged is not None and flagged.any():
        low, high = axes.get_ylim()
        axes.fill_between(time, low, high, where=flagged, color=COLOURS[2], alpha=0.2, linewidth=0, label="outside the calibration")
        axes.set_ylim(low, high)
    axes.set_xlabel("time (s)", fontsize=8)
    axes.set_ylabel(quantity, fontsize=8)
    axes.tick_params(labelsize=7)
    legend = figure.legend(fontsize=6, frameon=False, loc="outside lower center", ncols=5)
    for text in legend.get_texts():
        text.set_parse_math(False)
    if len(curves) > CURVES:
        title += f", the first {CURVES} of {len(curves)}"
    figure.suptitle(title + (" (simulated)" if simulated else ""), fontsize=9, parse_math=False)
    stream = io.BytesIO()
    kind = Path(path).suffix.lstrip(".")
    figure.savefig(stream, format=kind, metadata={"Software": None} if kind == "png" else None)
    atomic_write(path, stream.getvalue())
