"""The chart of textures: errors of a peak and accuracy over the length of the spectrum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import png
from skinfab.files import atomic_write
from skinfab.fingertip.force.texture import N_FFT

_COLOURS = {"published": "#D55E00", "interpolated": "#0072B2"}
_LABELS = {"published": "published: bins, 3 peaks + angles", "interpolated": "Hann + parabola, bands"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: frequency, magnitude and accuracy; the default is ringed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 3.8), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Textures: length of the spectrum against what comes of it (simulated)", fontsize=10)
    panels = figure.subplots(1, 3)
    wanted = (("frequency_rms_hz", "peak's frequency, rms error, Hz"), ("magnitude_max", "peak's magnitude, largest error, part"))
    for axes, (key, label) in zip(panels, (*wanted, ("accuracy", "right, specimens held out")), strict=True):
        for way, colour in _COLOURS.items():
            rows = [row for row in table if row["way"] == way]
            lengths = [row["n_fft"] for row in rows]
            axes.plot(lengths, [row[key] for row in rows], "o-", color=colour, ms=4, lw=1, label=_LABELS[way])
            if key == "accuracy":
                axes.fill_between(lengths, [row["low"] for row in rows], [row["high"] for row in rows], color=colour, alpha=0.15, lw=0)
        default = next((row for row in table if row["way"] == "interpolated" and row["n_fft"] == N_FFT), None)
        if default is not None:
            axes.plot(N_FFT, default[key], "o", ms=14, mfc="none", mec="#555555", mew=1.4, label="the default: the paper's length")
        axes.set_xscale("log", base=2)
        if key != "accuracy":
            axes.set_yscale("log")
        ticks = sorted({row["n_fft"] for row in table})
        axes.set_xticks(ticks, [f"{n}\n{n / 200:.2f} s" for n in ticks], fontsize=8)
        axes.set_ylabel(label, fontsize=9)
        axes.grid(True, lw=0.3, alpha=0.6)
    panels[1].legend(fontsize=7, loc="center right")
    panels[1].set_xlabel("samples of a spectrum (at 200 Hz)", fontsize=9)
    atomic_write(path, png(figure))
