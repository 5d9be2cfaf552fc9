"""The figure of what was replayed or measured: curves over time, a panel for each quantity."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.files import atomic_write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

#: Told apart by people who see no red or no green, and in print; the first is the truth, where there is one.
COLOURS = ("#999999", "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000")
#: Panels that are drawn at most: both multiplexers of the paper's board. And points of each curve.
PANELS, POINTS = 32, 20_000
#: Up to so many panels stand in so many columns, each so high, inches.
_GRIDS = ((1, 1, 2.4), (2, 1, 1.6), (6, 1, 1.0), (16, 2, 0.85), (PANELS, 4, 0.8))
_WIDTH = 7.2


@dataclass(frozen=True, eq=False)
class Panel:
    """Curves of one quantity.

    Parameters
    ----------
    quantity : str
        And its unit, of the upright axis.
    curves : mapping of (n,) float
        By what they are called; NaN leaves a gap. One alone needs no name where the quantity says all.
    flagged : (n,) bool, optional
        Where the last curve lies outside what its sensor knows; shaded.
    """

    quantity: str
    curves: Mapping[str, FloatArray]
    flagged: NDArray[np.bool_] | None = None


def draw_over_time(time: FloatArray, panels: Sequence[Panel], path: str | Path, *, title: str, simulated: bool) -> None:
    """Write the figure, PNG or PDF by its name.

    Parameters
    ----------
    time : (n,) float, s
    panels : sequence of Panel
        At least one; beyond `PANELS` they are left out, and the title says so.
    path : path
    title : str
    simulated : bool
        Said in the figure.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    shown = panels[:PANELS]
    columns, height = next((columns, height) for most, columns, height in _GRIDS if len(shown) <= most)
    rows = -(-len(shown) // columns)
    figure = Figure(figsize=(_WIDTH, rows * height + 0.7), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    # Channels are read down each column, as the inputs of a multiplexer are.
    grid = figure.subplots(rows, columns, sharex=True, squeeze=False).T.ravel()
    for axes, panel in zip(grid, shown, strict=False):
        _draw(axes, time, panel, small=columns > 1)
    for axes in grid[len(shown) :]:
        axes.remove()
    for k, axes in enumerate(grid[: len(shown)]):
        if k % rows == rows - 1 or k == len(shown) - 1:
            axes.set_xlabel("time (s)", fontsize=8 if columns == 1 else 6)
            axes.tick_params(labelbottom=True)
    if len(panels) > PANELS:
        title += f", the first {PANELS} of {len(panels)}"
    figure.suptitle(title + (" (simulated)" if simulated else ""), fontsize=9, parse_math=False)
    stream = io.BytesIO()
    kind = Path(path).suffix.lstrip(".")
    figure.savefig(stream, format=kind, metadata={"Software": None} if kind == "png" else None)
    atomic_write(path, stream.getvalue())


def _draw(axes: Axes, time: FloatArray, panel: Panel, *, small: bool) -> None:
    step = max(len(time) // POINTS, 1)
    colours = COLOURS if len(panel.curves) > 1 else COLOURS[1:]
    for (name, values), colour in zip(panel.curves.items(), colours, strict=False):
        axes.plot(time[::step], values[::step], color=colour, linewidth=1.6 if colour == COLOURS[0] else 0.7 if small else 0.9, label=name)
    if not any(np.isfinite(values).any() for values in panel.curves.values()):
        axes.text(0.5, 0.5, "no reading", transform=axes.transAxes, ha="center", va="center", fontsize=6, color=COLOURS[0])
        axes.set_yticks([])
    elif panel.flagged is not None and panel.flagged.any():
        axes.fill_between(
            time,
            0,
            1,
            where=panel.flagged.tolist(),
            transform=axes.get_xaxis_transform(),
            color=COLOURS[2],
            alpha=0.2,
            linewidth=0,
            label="outside the calibration",
        )
    if len(axes.get_legend_handles_labels()[0]) > 1:
        legend = axes.legend(fontsize=6, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=5, borderaxespad=0.1)
        for text in legend.get_texts():
            text.set_parse_math(False)
        axes.set_ylabel(panel.quantity, fontsize=8, parse_math=False)
    elif small:
        axes.set_title(panel.quantity, fontsize=6, pad=2, loc="left", parse_math=False)
    else:
        axes.set_ylabel(panel.quantity, fontsize=7, parse_math=False)
    axes.tick_params(labelsize=5 if small else 7)
    axes.margins(x=0.01)
    axes.yaxis.get_offset_text().set_fontsize(5)
    axes.locator_params(axis="y", nbins=4)
