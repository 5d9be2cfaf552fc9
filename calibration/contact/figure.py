"""The figure of contacts: each channel from 0 to 1 over time, its contacts behind it, as in the paper's fig. 6."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calibration.contact.clock import longest_hole, on_one_clock, rate_of
from calibration.contact.detector import Contact, Detection
from calibration.contact.table import normalised, unwatched
from skinfab.files import atomic_write
from skinfab.readout.frame import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: More are not told apart on a page.
MOST_PANELS = 3
#: Points of a channel that are drawn at most.
_POINTS = 4000
#: Told apart by people who see no red or no green, and in print.
RISE, FALL, LINE, TRUE = "#56B4E9", "#E69F00", "#000000", "#009E73"
#: Where no contact could be seen: hatched, so that it is no contact's colour.
UNWATCHED: dict[str, Any] = {"facecolor": "#EEEEEE", "edgecolor": "#AAAAAA", "hatch": "////", "linewidth": 0.0}


@dataclass(frozen=True, eq=False)
class Panel:
    """One log in the figure; the true contacts where they are known."""

    title: str
    recording: Recording
    found: Detection
    truth: Sequence[Contact] = ()


def draw_contacts(panels: Sequence[Panel], path: str | Path) -> None:
    """Write the figure, PNG or PDF by its name: the first `MOST_PANELS` of the panels side by side."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    shown = panels[:MOST_PANELS]
    rows = max(len(panel.found.channels) for panel in shown)
    figure = Figure(figsize=(2.4 + 2.6 * len(shown), 1.3 + 0.42 * rows), dpi=200, layout="constrained")
    FigureCanvasAgg(figure)
    for axes, panel in zip(figure.subplots(1, len(shown), squeeze=False)[0], shown, strict=True):
        _draw(axes, panel)
    legend = [
        Line2D([], [], color=LINE, linewidth=0.7, label="change, 0 to 1"),
        Patch(color=RISE, alpha=0.6, label="contact, reading rises"),
        Patch(color=FALL, alpha=0.6, label="contact, reading falls"),
        Patch(**UNWATCHED, label="not watched"),
    ]
    if any(panel.truth for panel in shown):
        legend.append(Line2D([], [], color=TRUE, linewidth=2, label="true contact"))
    figure.legend(handles=legend, loc="outside lower center", ncols=min(len(legend), 1 + 2 * len(shown)), fontsize=6, frameon=False)
    stream = io.BytesIO()
    figure.savefig(stream, format=Path(path).suffix.lstrip("."), metadata={"Software": None} if Path(path).suffix == ".png" else None)
    atomic_write(path, stream.getvalue())


def _draw(axes: Axes, panel: Panel) -> None:
    time, _ = on_one_clock(panel.recording)
    begin, end = float(np.nanmin(time)), float(np.nanmax(time))
    step = max(len(time) // _POINTS, 1)
    drawn, levels = time[::step] - begin, normalised(panel.recording, panel.found)[::step]
    rate = rate_of(panel.recording)
    levels[:-1][np.diff(drawn) > longest_hole(rate) + step / rate] = np.nan  # no line across a hole
    names = [health.channel for health in panel.found.channels]
    for k, name in enumerate(names):
        base = len(names) - 1 - k
        for start, last in unwatched(panel.recording, panel.found, name):
            axes.fill_between([start - begin, last - begin], base, base + 0.92, **UNWATCHED)
        for each in panel.found.of(name):
            last = end if each.lasting else each.end
            axes.fill_between(
                [each.start - begin, last - begin], base, base + 0.92, color=RISE if each.sign > 0 else FALL, alpha=0.6, linewidth=0
            )
        axes.plot(drawn, base + 0.85 * levels[:, k], color=LINE, linewidth=0.5)
        for each in (each for each in panel.truth if each.channel == name):
            axes.plot([each.start - begin, each.end - begin], [base - 0.03] * 2, color=TRUE, linewidth=1.2, solid_capstyle="butt")
    labels = [f"{health.channel}\n({health.state})" if health.state else health.channel for health in panel.found.channels]
    axes.set_yticks([len(names) - 1 - k + 0.4 for k in range(len(names))], labels)
    axes.set_ylim(-0.15, len(names))
    axes.set_xlim(0, end - begin)
    axes.set_xlabel("time (s)", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.set_title(panel.title + (" (simulated)" if panel.recording.stream.simulated else ""), fontsize=8, parse_math=False)
