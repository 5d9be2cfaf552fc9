"""The figure of a controlled joint: the human's angle and the robot's over time, as the paper's fig. 5."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from calibration.control.protocols import Run
from calibration.strain.figure import FALLING, RISING, TRUE
from skinfab.files import atomic_write


def draw_runs(runs: Sequence[Run], path: str | Path, *, title: str) -> None:
    """Write the figure, PNG or PDF by its name: a panel a run. The robot is simulated, and that is said.

    Parameters
    ----------
    runs : sequence of Run
    path : path
    title : str
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 2.3 * len(runs) + 0.3), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    for k, (axes, run) in enumerate(zip(figure.subplots(len(runs), 1, squeeze=False)[:, 0], runs, strict=True)):
        time = run.motion.time
        axes.plot(time, run.motion.angle, color=TRUE, linewidth=1.8, label="human")
        axes.plot(time, run.robot, color=RISING, linewidth=1.0, label="robot (simulated)")
        idle = np.array([command.state != "run" for command in run.commands])
        if idle.any():
            axes.fill_between(
                time, 0, 1, where=idle, transform=axes.get_xaxis_transform(), color=FALLING, alpha=0.3, label="held or stopped"
            )
        axes.set_title(f"{chr(ord('A') + k)}  {run.motion.name}: mean error {run.error_deg:.2f} deg", fontsize=8, loc="left")
        axes.set_ylabel("PIP angle (deg)", fontsize=8)
        axes.tick_params(labelsize=7)
        axes.legend(fontsize=6, frameon=False, loc="upper right", ncols=3)
        axes.margins(x=0.01)
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.18 * (high - low))  # room for the legend
    axes.set_xlabel("time (s)", fontsize=8)
    figure.suptitle(title, fontsize=9, parse_math=False)
    stream = io.BytesIO()
    figure.savefig(stream, format=Path(path).suffix.lstrip("."), metadata={"Software": None} if Path(path).suffix == ".png" else None)
    atomic_write(path, stream.getvalue())
