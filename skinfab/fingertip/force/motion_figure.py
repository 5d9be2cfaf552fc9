"""The figure of one log: force, inclination and the contact's way over time with what happened, and the contact on the dome."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.force.contact import Contacts
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.motion import KINDS, ROLLING, SEPARATION, SLIDING, Motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Told apart by people who see no red or no green.
COLOURS = {SLIDING: "#D55E00", SEPARATION: "#0072B2", ROLLING: "#009E73"}
#: Of a contact's coordinates: none of the events' colours.
_AXES = {"x": ("#000000", "-"), "y": ("#CC79A7", "-"), "z": ("#777777", "--")}
_POINTS = 4000
_DPI = 150


def draw_motions(
    log: WrenchLog, contacts: Contacts, found: Sequence[Motion], truth: Sequence[Motion], friction_deg: float, path: Path, *, logs: int = 1
) -> None:
    """Write it as PNG; the true events, where they are known, are bars below. `logs`: so many there are, of which this is the first."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    figure = Figure(figsize=(11.0, 5.2), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(3, 2, width_ratios=(3, 1.1))
    rows = [figure.add_subplot(grid[k, 0]) for k in range(3)]
    first = f" (the first of {logs} logs)" if logs > 1 else ""
    figure.suptitle(f"{log.name}{' (simulated)' if log.simulated else ''}: contact and motion{first}", fontsize=10, parse_math=False)
    step = max(len(log) // _POINTS, 1)
    shown = contacts.touching & ~contacts.missed
    angle = np.where(shown, np.degrees(contacts.inclination_rad), np.nan)
    points = np.where(shown[:, None], contacts.point, np.nan)
    for axes, value, label in (
        (rows[0], contacts.force_n, "force, N"),
        (rows[1], angle, "inclination, deg"),
        (rows[2], points, "contact x y z, mm"),
    ):
        if value.ndim == 1:
            axes.plot(log.time[::step], value[::step], lw=0.7, color="#000000")
        else:
            for k, (part, (colour, dashes)) in enumerate(_AXES.items()):
                axes.plot(log.time[::step], value[::step, k], lw=0.8, color=colour, ls=dashes, label=part)
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=7, frameon=False)
        axes.set_ylabel(label, fontsize=8)
        axes.tick_params(labelsize=7)
        axes.set_xlim(log.time[0], log.time[-1])
        _shade(axes, found, truth, float(log.time[-1]))
    rows[1].axhline(friction_deg, color="#777777", lw=0.8, ls="--")
    rows[2].set_xlabel("time, s", fontsize=8)
    legend = [Patch(color=COLOURS[kind], alpha=0.35, label=kind) for kind in KINDS]
    if truth:
        legend.append(Patch(color="#000000", label="bars: what was so"))
    figure.legend(handles=legend, loc="outside lower left", ncols=4, fontsize=7, frameon=False)
    _top_view(figure.add_subplot(grid[:, 1]), log, points[::step], step)
    with atomic_path(path) as partial:
        figure.savefig(partial, metadata={"Software": None})


def _shade(axes: Axes, found: Sequence[Motion], truth: Sequence[Motion], end: float) -> None:
    for each in found:
        axes.axvspan(each.start, end if each.lasting else each.end, color=COLOURS[each.kind], alpha=0.3, lw=0)
    for each in truth:
        axes.axvspan(each.start, each.end, ymax=0.04, color=COLOURS[each.kind], lw=0)


def _top_view(axes: Axes, log: WrenchLog, points: np.ndarray, step: int) -> None:
    axes.scatter(points[:, 0], points[:, 1], c=log.time[::step], s=3, cmap="cividis")
    reach = float(np.nanmax(np.abs(points[:, :2]))) if np.isfinite(points).any() else math.nan
    if math.isfinite(reach):
        axes.set(xlim=(-1.2 * reach - 1, 1.2 * reach + 1), ylim=(-1.2 * reach - 1, 1.2 * reach + 1))
    axes.set_aspect("equal")
    axes.set_title("contact from above\n(dark to light: time)", fontsize=8)
    axes.set_xlabel("x, mm", fontsize=8)
    axes.set_ylabel("y, mm", fontsize=8)
    axes.tick_params(labelsize=7)
