"""The picture of a run: what was touched when, how sure that is, and how it is turned and where it lies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.nail.live import Told

_DPI = 150


def draw_run(told: Sequence[Told], names: Sequence[str], path: Path, *, title: str, simulated: bool) -> None:
    """Write it as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    known = [each for each in told if each.decision is not None]
    figure = Figure(figsize=(9.6, 7.2), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(f"{title}{' (simulated)' if simulated else ''}", fontsize=10)
    top, *rest = figure.subplots(4, 1, sharex=True, height_ratios=[2.4, 1, 1, 1])
    time = np.array([each.time_s for each in known])
    decisions = [each.decision for each in known if each.decision is not None]
    top.plot(time, [names.index(each.label) for each in decisions], ".", ms=3, color="#0b6e4f")
    strange = [k for k, each in enumerate(decisions) if each.strange]
    top.plot(time[strange], [names.index(decisions[k].label) for k in strange], "x", ms=4, color="#b5451b", label="like nothing learned")
    top.set_yticks(range(len(names)), names, fontsize=7)
    top.set_ylim(-0.5, len(names) - 0.5)
    if strange:
        top.legend(fontsize=7, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2)
    rest[0].plot(time, [each.confidence for each in decisions], lw=0.8, color="#555555")
    rest[0].set(ylabel="confidence", ylim=(0, 1.05))
    rest[1].plot(time, [each.continuous.angle_deg for each in decisions], ".", ms=2, color="#0b6e4f")
    rest[1].set(ylabel="direction, deg", ylim=(0, 180), yticks=(0, 45, 90, 135, 180))
    for key, colour in (("x_mm", "#0b6e4f"), ("y_mm", "#b5451b")):
        rest[2].plot(time, [getattr(each.continuous, key) for each in decisions], ".", ms=2, color=colour, label=f"{key[0]}, mm")
    if any(not math.isnan(each.continuous.x_mm) for each in decisions):
        rest[2].legend(fontsize=7, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2, ncols=2)
    rest[2].set(ylabel="foot or pin, mm", xlabel="time, s")
    for axes in (top, *rest):
        axes.grid(True, lw=0.3, alpha=0.6)
    with atomic_path(path) as partial:
        figure.savefig(partial)
