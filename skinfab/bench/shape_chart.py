"""The chart of shapes: right against answered for each kind of features, right against the object's turn, and sizes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import ring, save
from skinfab.fingertip.force.shape import CONFIDENCE

_COLOURS = {"published": "#D55E00", "pose-free": "#009E73", "misfits": "#0072B2"}
_LABELS = {"published": "published: 24 numbers, 24-50-3", "pose-free": "17 pose-free numbers", "misfits": "misfits of three fits"}
_DEFAULT = "misfits"
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], sizes: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG; the default is ringed."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.2), dpi=_DPI, layout="constrained")
    figure.suptitle("Shapes from four contacts, objects that were not learned from (simulated)", fontsize=10)
    curve, turns, solids = figure.subplots(1, 3)
    free = max(row["yaw_deg"] for row in table)
    for name, colour in _COLOURS.items():
        rows = [row for row in table if row["features"] == name and row["yaw_deg"] == free and row["right"] is not None]
        answered = [row["answered"] for row in rows]
        curve.plot(answered, [row["right"] for row in rows], "o-", color=colour, ms=4, lw=1, label=_LABELS[name])
        curve.fill_between(answered, [row["low"] for row in rows], [row["high"] for row in rows], color=colour, alpha=0.12, lw=0)
        all_answered = sorted((row for row in table if row["features"] == name and row["confidence"] == 0), key=lambda row: row["yaw_deg"])
        turns.plot([row["yaw_deg"] for row in all_answered], [row["right"] for row in all_answered], "o-", color=colour, ms=4, lw=1)
    own = {row["confidence"]: row for row in table if row["features"] == _DEFAULT and row["yaw_deg"] == free}
    ring(curve, own[CONFIDENCE]["answered"], own[CONFIDENCE]["right"])
    ring(turns, free, own[0]["right"])
    curve.set(xlabel="answered, part of the grasps (confidence from 0 to 0.99)", ylabel="right, part of the answers", ylim=(None, 1.02))
    turns.set(xlabel="objects turned by up to, deg", ylabel="right, all answered", xscale="log", ylim=(0.3, 1.02))
    ticks = sorted({row["yaw_deg"] for row in table})
    turns.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    turns.minorticks_off()
    curve.legend(fontsize=7)
    for axes in (curve, turns):
        axes.grid(True, lw=0.3, alpha=0.6)
    names = [f"{row['solid'].split()[0]}\n{row['true_mm']:g}" for row in sizes if row["way"] == "fit"]
    for k, (way, colour) in enumerate((("published", "#D55E00"), ("fit", "#0072B2"))):
        rows = [row for row in sizes if row["way"] == way]
        place = [j + 0.36 * k - 0.18 for j in range(len(rows))]
        errors = [row["error_median_mm"] for row in rows]
        solids.bar(place, errors, 0.34, color=colour, label=f"{way}{', the default' if way == 'fit' else ''}: median, and 90 %")
        solids.vlines(place, errors, [row["error_p90_mm"] for row in rows], color=colour, lw=1)
    paper = [abs(row["paper_mm"] - row["true_mm"]) for row in sizes if row["way"] == "fit"]
    solids.plot(range(len(paper)), paper, "k_", ms=18, label="the paper's one example (real hand)")
    solids.set_xticks(range(len(names)), names, fontsize=8)
    solids.set_ylabel("error of a radius or side, mm")
    # Room above the longest whisker, which the key would hide.
    solids.set_ylim(0, 1.35 * max(row["error_p90_mm"] for row in sizes))
    solids.legend(fontsize=7, loc="upper left")
    solids.grid(True, axis="y", lw=0.3, alpha=0.6)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why, by objects at any turn."""
    free = max(row["yaw_deg"] for row in table)
    by = {(row["features"], row["confidence"]): row for row in table if row["yaw_deg"] == free}
    others = ", ".join(f"{_LABELS[name]} {by[name, 0]['right']:.0%}" for name in _COLOURS if name != _DEFAULT)
    gated, surest = by[_DEFAULT, CONFIDENCE], by[_DEFAULT, max(confidence for _, confidence in by)]
    return (
        f"{_LABELS[_DEFAULT]}, answered from a confidence of {CONFIDENCE:g} on: of all grasps {by[_DEFAULT, 0]['right']:.0%} are right "
        f"({others}), of the {gated['answered']:.0%} answered {gated['right']:.1%}; a confidence of {surest['confidence']:g} answers "
        f"{surest['answered']:.0%} for {surest['right']:.1%}"
    )
