"""The chart of textures: errors of a peak and accuracy over the length of the spectrum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.bench.marked import ring, save
from skinfab.bench.texture_peaks import BANDS
from skinfab.fingertip.force.texture import N_FFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOURS = {"published": "#D55E00", "interpolated": "#0072B2"}
_LABELS = {"published": "published: bins, 3 peaks + angles", "interpolated": "Hann + parabola, bands"}
_PEAKS = {"published": "peaks on the grid, as published", "interpolated": "Hann + parabola"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], peaks: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: frequency, magnitude and accuracy over the length, and accuracy over the number of peaks."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14.0, 4.2), dpi=_DPI, layout="constrained")
    figure.suptitle("Textures: length of the spectrum and number of peaks against what comes of it (simulated)", fontsize=10)
    *panels, counted = figure.subplots(1, 4)
    wanted = (("frequency_rms_hz", "peak's frequency, rms error, Hz"), ("magnitude_max", "peak's magnitude, largest error, part"))
    for axes, (key, label) in zip(panels, (*wanted, ("accuracy", "right, specimens held out")), strict=True):
        for way, colour in _COLOURS.items():
            rows = [row for row in table if row["way"] == way]
            lengths = [row["n_fft"] for row in rows]
            axes.plot(lengths, [row[key] for row in rows], "o-", color=colour, ms=4, lw=1, label=_LABELS[way])
            if key == "accuracy":
                axes.fill_between(lengths, [row["low"] for row in rows], [row["high"] for row in rows], color=colour, alpha=0.15, lw=0)
        ring(axes, N_FFT, _of_default(table)[key])
        axes.set_xscale("log", base=2)
        if key != "accuracy":
            axes.set_yscale("log")
        ticks = sorted({row["n_fft"] for row in table})
        axes.set_xticks(ticks, [f"{n}\n{n / 200:.2f} s" for n in ticks], fontsize=8)
        axes.set_xlabel("samples of a spectrum (at 200 Hz)", fontsize=9)
        axes.set_ylabel(label, fontsize=9)
        axes.grid(True, lw=0.3, alpha=0.6)
    panels[1].legend(fontsize=7, loc="center right")
    _draw_peaks(counted, peaks)
    save(figure, path, default=why(table, peaks))


def _draw_peaks(axes: Axes, peaks: Sequence[Mapping[str, Any]]) -> None:
    """Accuracy over the number of peaks; bands, which are none, stand to the right of all."""
    for way, colour in _COLOURS.items():
        rows = [row for row in peaks if row["way"] == way]
        counts = [row["peaks"] for row in rows]
        axes.plot(counts, [row["accuracy"] for row in rows], "o-", color=colour, ms=4, lw=1, label=_PEAKS[way])
        axes.fill_between(counts, [row["low"] for row in rows], [row["high"] for row in rows], color=colour, alpha=0.15, lw=0)
    bands, ticks = _bands(peaks), sorted({row["peaks"] for row in peaks} - {0})
    right = max(ticks) + 1
    axes.errorbar(
        right,
        bands["accuracy"],
        [[bands["accuracy"] - bands["low"]], [bands["high"] - bands["accuracy"]]],
        fmt="o",
        color=_COLOURS["interpolated"],
        ms=4,
        lw=1,
    )
    ring(axes, right, bands["accuracy"])
    axes.set_xticks([*ticks, right], [*map(str, ticks), "bands"], fontsize=8)
    axes.set_xlabel(f"peaks, and three angles ({N_FFT} samples)", fontsize=9)
    axes.set_ylabel("right, specimens held out", fontsize=9)
    axes.grid(True, lw=0.3, alpha=0.6)
    axes.legend(fontsize=7, loc="lower left")


def _of_default(table: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    return next(row for row in table if row["way"] == "interpolated" and row["n_fft"] == N_FFT)


def _bands(peaks: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    return next(row for row in peaks if row["way"] == BANDS)


def why(table: Sequence[Mapping[str, Any]], peaks: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    own = _of_default(table)
    others = [row["accuracy"] for row in table if row["way"] == own["way"] and row["n_fft"] != N_FFT]
    best = max((row for row in peaks if row["way"] != BANDS), key=lambda row: row["accuracy"])
    return (
        f"bands of {N_FFT} samples, the paper's length: {own['accuracy']:.1%} are told right, by other lengths {min(others):.1%} to "
        f"{max(others):.1%}, and longer ones need longer slides; by peaks {best['accuracy']:.1%} at best ({best['peaks']} of them)"
    )
