"""The chart of the control laws: gain, delay and period against the mean error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calibration.control.protocols import PAPER_DEG
from skinfab.bench.marked import ring, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOURS = {"p": "#b5451b", "branches": "#2b5c9e", "full": "#0b6e4f"}
_LINES = {"uniform": "-", "random": "--"}
_DEFAULT = "full"
_NAMES = {"p": "p, as published", "branches": "branches", _DEFAULT: "full, the default"}
#: What is varied, by experiment: the key of its column, what it is, and where the axis has numbers.
_SWEPT = {
    "gain": ("gain", "gain, 1/s", (1, 2, 3, 5, 8, 12)),
    "delay": ("delay_s", "delay, s (gain: auto)", (0.03, 0.05, 0.1, 0.2)),
    "period": ("period_s", "period of uniform cycles, s", (1, 2, 4, 8)),
}


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: error above, margin below; a colour a law, a line style a protocol, hollow where the gain is too high."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 7.6), dpi=150, layout="constrained")
    figure.suptitle("A robot's joint follows a human's (simulated): mean error, and how much more gain the loop would take")
    panels = figure.subplots(2, 3, sharex="col", sharey="row")
    for column, (experiment, (key, label, ticks)) in enumerate(_SWEPT.items()):
        for axes, what in zip(panels[:, column], ("mean_error_deg", "margin"), strict=True):
            _draw_sweep(axes, [row for row in table if row["experiment"] == experiment], key, what)
            for row in table:
                # The period is none where the motion is random.
                if (row["experiment"], row["law"]) == ("default", _DEFAULT) and row[key] is not None:
                    ring(axes, row[key], row[what], color=_COLOURS[_DEFAULT])
            axes.set(xscale="log", yscale="log")
            axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
            axes.grid(True, which="both", lw=0.3, alpha=0.6)
        panels[1, column].set_xlabel(label)
        panels[1, column].axhline(1, color="#777777", lw=1, ls="--")
    for protocol, paper in PAPER_DEG.items():
        panels[0, 0].axhline(paper, color="#777777", lw=1, ls=_LINES[protocol])
        panels[0, 0].axhline(paper / 2, color="#777777", lw=0.6, ls=":")
    for axes, label, ticks in zip(
        panels[:, 0], ("mean error, degrees", "gain margin"), ((2, 3, 5, 10, 20, 30), (0.5, 1, 2, 3, 5, 10)), strict=True
    ):
        axes.set_ylabel(label)
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    for axes in panels.flat:
        axes.minorticks_off()
    panels[0, 2].legend(*panels[0, 0].get_legend_handles_labels(), fontsize=7, loc="upper right")
    marks = (
        "above: hollow: beyond the gain that the loop takes · grey: the paper's errors, dotted: half of them\n"
        "below: by how much the gain could be raised until the joint swings; under the dashed line it does"
    )
    save(figure, path, default=why(table), notes=marks.splitlines())


def _draw_sweep(axes: Axes, swept: Sequence[Mapping[str, Any]], key: str, what: str) -> None:
    for law, colour in _COLOURS.items():
        for protocol, style in _LINES.items():
            rows = [row for row in swept if (row["law"], row["protocol"]) == (law, protocol)]
            if rows:
                axes.plot([r[key] for r in rows], [r[what] for r in rows], style, color=colour, lw=1.2, label=f"{_NAMES[law]}, {protocol}")
            for row in rows:
                face = colour if row["margin"] > 1 else "white"
                axes.plot(row[key], row[what], "o", color=colour, mfc=face, ms=4, zorder=3)


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    own = {row["protocol"]: row for row in table if (row["experiment"], row["law"]) == ("default", _DEFAULT)}
    paper = {row["protocol"]: row for row in table if row["experiment"] == "published"}
    swept = [row["mean_error_deg"] for row in table if (row["experiment"], row["law"], row["protocol"]) == ("gain", _DEFAULT, "random")]
    said = ", ".join(
        f"{protocol} {row['mean_error_deg']:.2f} degrees (as published {paper[protocol]['mean_error_deg']:.2f})"
        for protocol, row in own.items()
    )
    gain, margin = (next(iter(own.values()))[key] for key in ("gain", "margin"))
    return (
        f"full, its gain a third of what the loop takes: {said} at {gain:.2g} 1/s with a margin of {margin:.2g}; no gain brings "
        f"random motion below {min(swept):.2f}"
    )
