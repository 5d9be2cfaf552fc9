"""What a slide felt like: friction along the way, and its spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.texture import N_FFT, TOP_HZ, Slide, interpolated_peaks
from skinfab.fingertip.force.texture_model import Decision

_DPI, _SHOWN = 130, 6


def draw_slides(logs: Sequence[WrenchLog], slides: Sequence[Slide], decisions: Sequence[Decision], path: Path, *, simulated: bool) -> None:
    """Write the figure as PNG: a row a slide (six at most, of as many textures as there are), friction and spectrum with its peaks."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    names = [d.name for d in decisions]
    order = sorted(range(len(names)), key=lambda k: names[:k].count(names[k]))[:_SHOWN]
    shown = len(order)
    figure = Figure(figsize=(9.0, 0.7 + 1.7 * shown), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    more = f", {shown} of {len(slides)}" if len(slides) > shown else ""
    figure.suptitle(f"Slides{' (simulated)' if simulated else ''}{more}", fontsize=10)
    for axes, k in zip(figure.subplots(shown, 2, squeeze=False), sorted(order), strict=True):
        log, each, d = logs[k], slides[k], decisions[k]
        axes[0].plot(np.arange(len(each.ratio)) / each.rate_hz, each.ratio, lw=0.7, color="#0072B2")
        sure = f", {d.probability:.2f}" if d.known else f" (nearest {d.nearest})"
        axes[0].set_title(f"{log.name}: {d.name}{sure}", fontsize=8, loc="left")
        axes[0].set_ylabel("friction", fontsize=8)
        n_fft = min(N_FFT, len(each.ratio))
        window = np.hanning(n_fft + 1)[:-1]
        piece = each.ratio[:n_fft]
        size = np.abs(np.fft.rfft((piece - piece.mean()) * window)) / window.sum()
        frequency = np.fft.rfftfreq(n_fft, 1 / each.rate_hz)
        axes[1].plot(frequency, size, lw=0.8, color="#555555")
        peaks = interpolated_peaks(each.ratio, each.rate_hz, n_fft=n_fft)
        axes[1].plot(peaks.frequency, peaks.magnitude, "o", ms=4, color="#D55E00")
        axes[1].set_ylabel("|X| / N of friction", fontsize=8)
        axes[1].set_xlim(0, TOP_HZ)
        axes[1].set_title("  ".join(f"{f:.2f} Hz" for f in peaks.frequency), fontsize=8, loc="left")
        for each_axes in axes:
            each_axes.tick_params(labelsize=7)
            each_axes.grid(True, lw=0.3, alpha=0.6)
        if axes[0].get_subplotspec().is_last_row():
            axes[0].set_xlabel("time since sliding began, s", fontsize=8)
            axes[1].set_xlabel("Hz", fontsize=8)
    with atomic_path(path) as partial:
        figure.savefig(partial)
