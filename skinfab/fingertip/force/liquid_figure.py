"""Where the line of a stirred cup goes, seen along it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.force.liquid import Stirred

_DPI, _MOST, _COLUMNS = 130, 12, 4


def draw_paths(cups: Sequence[tuple[str, Stirred]], path: Path, *, simulated: bool) -> None:
    """Write the figure as PNG: a panel a cup (twelve at most), all at one scale, time as colour."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    shown = cups[:_MOST]
    columns = min(len(shown), _COLUMNS)
    rows = -(-len(shown) // columns)
    figure = Figure(figsize=(max(2.7 * columns, 5.0) + 0.6, 3.1 * rows + 0.5), dpi=_DPI, layout=ConstrainedLayoutEngine(hspace=0.08))
    FigureCanvasAgg(figure)
    more = f", the first {_MOST} of {len(cups)}" if len(cups) > _MOST else ""
    figure.suptitle(f"Stirred cups: where the line of the weight goes{' (simulated)' if simulated else ''}{more}", fontsize=9)
    across = [_across(each) for _, each in shown]
    begin, end = min(float(each.time[0]) for _, each in shown), max(float(each.time[-1]) for _, each in shown)
    reach = 1.1 * max(float(np.abs(each).max()) for each in across)
    for axes, (name, each), flat in zip(np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).ravel(), shown, across, strict=False):
        axes.plot(*flat.T, color="#999999", lw=0.5)
        last = axes.scatter(*flat.T, c=each.time, s=6, cmap="viridis", zorder=3, vmin=begin, vmax=end)
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        axes.set_title(f"{name}\n{each.answer}, {each.wander_mm:.2f} mm", fontsize=7)
        axes.tick_params(labelsize=6)
        axes.grid(True, lw=0.3, alpha=0.6)
    for axes in figure.axes[len(shown) :]:
        axes.remove()
    bar = figure.colorbar(last, ax=figure.axes[: len(shown)], label="time, s", shrink=min(1.0, 1.5 / rows))
    bar.ax.tick_params(labelsize=6)
    figure.supxlabel("mm across the line of the weight", fontsize=8)
    with atomic_path(path) as partial:
        figure.savefig(partial)


def _across(each: Stirred) -> np.ndarray:
    """The path in the plane in which it lies, about its middle, (k, 2) mm."""
    apart = each.path - each.path.mean(axis=0)
    out: np.ndarray = apart @ np.linalg.svd(apart, full_matrices=False)[2][:2].T
    return out
