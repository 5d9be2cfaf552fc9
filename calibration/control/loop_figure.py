"""The figure of a loop in real time: what was followed, and a histogram of how long each command took."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from calibration.control.loop import Loop
from calibration.strain.figure import FALLING, RISING, TRUE
from skinfab.files import atomic_write


def draw_loop(loop: Loop, path: str | Path, *, title: str, latency_s: np.ndarray | None = None) -> None:
    """Write the figure, PNG or PDF by its name.

    Parameters
    ----------
    loop : Loop
    path : path
    title : str
    latency_s : (n,) float, optional
        Of the commands; without it from each frame's arrival.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 2.8), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1))
    left.plot(loop.time, [command.target for command in loop.commands], color=TRUE, linewidth=1.6, label="target")
    left.plot(loop.time, [command.angle for command in loop.commands], color=RISING, linewidth=0.9, label="robot, as read")
    idle = np.array([command.state != "run" for command in loop.commands])
    if idle.any():
        left.fill_between(
            loop.time, 0, 1, where=idle, transform=left.get_xaxis_transform(), color=FALLING, alpha=0.3, label="held or stopped"
        )
    left.set_xlabel("time (s)", fontsize=8)
    left.set_ylabel("PIP angle (deg)", fontsize=8)
    left.legend(fontsize=6, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, borderaxespad=0.1)
    taken = 1e3 * (loop.latency_s if latency_s is None else latency_s)
    taken = taken[np.isfinite(taken)]
    if len(taken):
        right.hist(taken, bins=50, color=RISING, log=True)
        right.set_title(f"median {np.median(taken):.2f}, 99 % {np.quantile(taken, 0.99):.2f}, worst {taken.max():.2f} ms", fontsize=7)
    right.set_xlabel("from frame to command (ms)", fontsize=8)
    right.set_ylabel("commands", fontsize=8)
    for axes in (left, right):
        axes.tick_params(labelsize=7)
    figure.suptitle(title, fontsize=9, parse_math=False)
    stream = io.BytesIO()
    figure.savefig(stream, format=Path(path).suffix.lstrip("."), metadata={"Software": None} if Path(path).suffix == ".png" else None)
    atomic_write(path, stream.getvalue())
