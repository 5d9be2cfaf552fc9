"""The picture of a run: what was touched when, how sure that is, and as far as they were learned its direction, place and force."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.nail.live import Told

_DPI = 150
#: What a panel shows, and which numbers of a decision: one of which none is known is left out.
_PANELS = {"direction, deg": ("angle_deg",), "foot or pin, mm": ("x_mm", "y_mm"), "force, N": ("force_n",)}
_COLOURS = ("#0b6e4f", "#b5451b")


def draw_run(told: Sequence[Told], names: Sequence[str], path: Path, *, title: str, simulated: bool) -> None:
    """Write it as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    known = [each for each in told if each.decision is not None]
    time = np.array([each.time_s for each in known])
    decisions = [each.decision for each in known if each.decision is not None]
    found = {key: np.array([getattr(each.continuous, key) for each in decisions]) for keys in _PANELS.values() for key in keys}
    sure = np.array([each.confidence for each in decisions])
    panels = {label: keys for label, keys in _PANELS.items() if any(np.isfinite(found[key]).any() for key in keys)}
    below = len(panels) + bool(np.isfinite(sure).any())
    figure = Figure(figsize=(9.6, 3.6 + 1.2 * below), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(f"{title}{' (simulated)' if simulated else ''}", fontsize=10)
    top, *rest = figure.subplots(1 + below, 1, sharex=True, height_ratios=[2.4] + [1] * below, squeeze=False)[:, 0]
    top.plot(time, [names.index(each.label) for each in decisions], ".", ms=3, color=_COLOURS[0])
    strange = [k for k, each in enumerate(decisions) if each.strange]
    top.plot(time[strange], [names.index(decisions[k].label) for k in strange], "x", ms=4, color=_COLOURS[1], label="like nothing learned")
    top.set_yticks(range(len(names)), names, fontsize=7)
    top.set_ylim(-0.5, len(names) - 0.5)
    if strange:
        top.legend(fontsize=7, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2)
    if below > len(panels):
        rest[0].plot(time, sure, lw=0.8, color="#555555")
        rest[0].set(ylabel="confidence", ylim=(0, 1.05))
    for axes, (label, keys) in zip(rest[below - len(panels) :], panels.items(), strict=True):
        for key, colour in zip(keys, _COLOURS, strict=False):
            axes.plot(time, found[key], ".", ms=2, color=colour, label=f"{key[0]}, mm")
        axes.set_ylabel(label)
        if keys == ("angle_deg",):
            axes.set(ylim=(0, 180), yticks=(0, 45, 90, 135, 180))
        elif keys == ("force_n",):
            axes.set_ylim(bottom=0)
        else:
            axes.legend(fontsize=7, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2, ncols=2)
    (rest[-1] if rest else top).set_xlabel("time, s")
    for axes in (top, *rest):
        axes.grid(True, lw=0.3, alpha=0.6)
    with atomic_path(path) as partial:
        figure.savefig(partial)
