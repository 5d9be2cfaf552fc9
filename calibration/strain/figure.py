"""The figure of a calibration: reading over angle with the curve, as in the paper's fig. 4, and the angle over time."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calibration.strain.calibrate import Calibration
from calibration.strain.models import MODELS, Samples
from calibration.strain.prepare import Prepared
from skinfab.files import atomic_write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

#: Points that are drawn at most: more are not seen.
_POINTS = 4000
#: Told apart by people who see no red or no green, and in print.
RISING, FALLING, CURVE, TRUE = "#0072B2", "#E69F00", "#000000", "#999999"


def draw_calibration(log: Prepared, found: Calibration, path: str | Path, *, title: str, names: tuple[str, str], simulated: bool) -> None:
    """Write the figure, PNG or PDF by its name.

    Parameters
    ----------
    log : Prepared
    found : Calibration
        Of this log.
    path : path
    title : str
    names : (signal, angle)
    simulated : bool
        Said in the figure.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 3.9), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.25))
    angle, signal, rises = (np.concatenate(each) for each in zip(*(_drawn(run) for run in log.runs), strict=True))
    step = max(len(angle) // _POINTS, 1)
    for way, colour, label in ((rises, RISING, "flexion"), (~rises, FALLING, "extension")):
        left.plot(angle[way][::step], 100 * signal[way][::step], ".", color=colour, markersize=1.5, label=label)
    at, low, high = found.band.T
    left.fill_between(at, 100 * low, 100 * high, color=CURVE, alpha=0.15, linewidth=0, label="95 % confidence band of the curve")
    left.plot(at, 100 * found.plain.signal(at), color=CURVE, linewidth=1.2, label=_fit_label(found))
    if not found.plain.monotone:
        left.plot(at, 100 * found.model.curve.signal(at), color=CURVE, linewidth=0.8, linestyle="--", label="the same, made not to turn")
    left.set_xlabel("angle (deg)")
    left.set_ylabel(r"$\Delta U / U_0$ (%)")
    _draw_over_time(right, log, found, names[1])
    # Below the curves, never over them.
    for axes in (left, right):
        legend = axes.legend(fontsize=6, frameon=False, markerscale=4, loc="upper left", bbox_to_anchor=(0.0, -0.18), borderaxespad=0.0)
        for text in legend.get_texts():
            text.set_parse_math(text.get_text() == _fit_label(found))
    for axes in (left, right):
        axes.tick_params(labelsize=7)
        axes.xaxis.label.set_size(8)
        axes.yaxis.label.set_size(8)
    figure.suptitle(title + (" (simulated)" if simulated else ""), fontsize=9, parse_math=False)
    stream = io.BytesIO()
    figure.savefig(stream, format=Path(path).suffix.lstrip("."), metadata={"Software": None} if Path(path).suffix == ".png" else None)
    atomic_write(path, stream.getvalue())


def _fit_label(found: Calibration) -> str:
    return f"degree {found.plain.degree}, $R^2$ = {found.r2:.3f}"


def _draw_over_time(axes: Axes, log: Prepared, found: Calibration, truth: str) -> None:
    """The true angle, that of the model handed out, and on the half held out that of the same model fitted to the other half."""
    name, score = found.model.name, found.scores[found.model.name]
    first, second = log.halves
    halfway = MODELS[name].fit(log.only(first), degree=score.degree)
    curves = (
        (found.model, log.runs, RISING, f"{name}, fitted to all of it: {found.rms_deg:.2f} deg rms"),
        (halfway, log.only(second), FALLING, f"fitted to the first half, on the second: {score.held_out_rms_deg:.2f} deg"),
    )
    for k, run in enumerate(log.runs):
        axes.plot(run.time, run.angle, color=TRUE, linewidth=1.6, label=truth if k == 0 else None)
    for model, runs, colour, label in curves:
        for k, run in enumerate(runs):
            estimated, _ = model.estimate(run.time, run.signal)
            axes.plot(run.time, np.where(run.fit, estimated, np.nan), color=colour, linewidth=0.8, label=label if k == 0 else None)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("angle (deg)")


def _drawn(run: Samples) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
    """Angle, signal and the way it goes, of what counts."""
    rises = np.gradient(run.angle) >= 0
    return run.angle[run.fit], run.signal[run.fit], rises[run.fit]
