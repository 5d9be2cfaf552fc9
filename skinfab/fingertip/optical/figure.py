"""Figures of a trained model and of what it felt."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.files import atomic_path
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.judge import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
_DPI = 150
_SURE, _UNSURE = "#0072B2", "#D55E00"


def draw_training(off: FloatArray, truth: FloatArray, path: Path, *, simulated: bool) -> None:
    """Write the errors of what was held out over where the edge was, as PNG.

    Parameters
    ----------
    off : (n, 3) float
        Of `judge.off_by`.
    truth : (n, 3) or (n, 4) float
        Of `Examples.truth`.
    path : path
    simulated : bool
    """
    figure = _figure(9.6, 3.4, "Errors on images that were held out" + (" (simulated)" if simulated else ""))
    for axes, (k, (quantity, unit)) in zip(figure.subplots(1, 3), enumerate(QUANTITIES.items()), strict=True):
        axes.axhline(0, color="#777777", lw=0.6)
        axes.plot(truth[:, 0], off[:, k], ".", ms=2.5, color=_SURE, rasterized=True)
        axes.set(xlabel="offset of the edge, mm", ylabel=f"error of the {quantity}, {unit}")
        if not np.isfinite(off[:, k]).any():
            axes.set_title("not learned", fontsize=8)
        axes.grid(True, lw=0.3, alpha=0.6)
    _write(figure, path)


def draw_run(times: Sequence[float], edges: Sequence[Edge], path: Path, *, title: str, simulated: bool) -> None:
    """Write what was felt over time as PNG; what is no more than half sure is marked.

    Parameters
    ----------
    times : sequence of n float, s
    edges : sequence of n Edge
    path : path
    title : str
    simulated : bool
    """
    figure = _figure(9.6, 6.4, title + (" (simulated)" if simulated else ""))
    t = np.asarray(times) - times[0]
    rows = {
        "offset, mm": [e.offset_mm for e in edges],
        "depth, mm": [e.depth_mm for e in edges],
        "angle, deg": [math.degrees(e.angle_rad) for e in edges],
        "confidence": [e.confidence for e in edges],
    }
    sure = np.array(rows["confidence"]) > 0.5
    panels = figure.subplots(len(rows), 1, sharex=True)
    for axes, (label, values) in zip(panels, rows.items(), strict=True):
        axes.plot(t[sure], np.array(values)[sure], ".", color=_SURE, ms=3)
        axes.plot(t[~sure], np.array(values)[~sure], "x", color=_UNSURE, ms=3)
        axes.set_ylabel(label)
        axes.grid(True, lw=0.3, alpha=0.6)
    panels[-1].set(xlabel="s (crosses: no more than half sure)", ylim=(-0.05, 1.05))
    _write(figure, path)


def _figure(width: float, height: float, title: str) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(title, fontsize=10)
    return figure


def _write(figure: Figure, path: Path) -> None:
    with atomic_path(path) as partial:
        figure.savefig(partial)
