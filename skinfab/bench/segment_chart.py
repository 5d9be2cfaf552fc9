"""The chart of automatic seams: pieces and length of seam against the bound, and against time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.marked import ring, save
from skinfab.bench.segment_words import at_default
from skinfab.seams.judge import Limits

_COLOURS = {"usual": "#0b6e4f", "fewest": "#2b5c9e"}
_PEER = "#b5451b"
_DEFAULT = "usual"
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path, *, notes: Sequence[str] = ()) -> None:
    """Write the chart as PNG: thin lines are objects, thick ones their mean; the default is ringed."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.4, 8.2), dpi=_DPI, layout="constrained")
    figure.suptitle("Automatic seams: pieces and length of seam against the bound and against time")
    panels = figure.subplots(2, 2, sharey="row", sharex="col")
    for (by_bound, by_time), what, label in zip(
        panels, ("pieces", "seam"), ("pieces of an object", "seam over root of area of an object"), strict=True
    ):
        for method in dict.fromkeys(row["method"] for row in table):
            rows = [row for row in table if row["method"] == method]
            _against_bound(by_bound, rows, method, what)
            _against_time(by_time, rows, method, what)
        by_bound.set(yscale="log", ylabel=label)
        for axes in (by_bound, by_time):
            axes.yaxis.set_major_formatter("{x:g}")
            axes.yaxis.set_minor_formatter("")
            axes.yaxis.set_major_locator(_ticks())
            axes.grid(True, which="both", lw=0.3, alpha=0.6)
            axes.legend(fontsize=8)
    bounds = sorted({row["bound"] for row in table if row["bound"] is not None})
    panels[1][0].set(xlabel="bound on the mean d", xticks=bounds)
    panels[1][1].set(xscale="log", xlabel=f"processor time, s (ours: bound {Limits.mean:g})")
    marks = "thin: one object; thick: mean over the objects that were not refused at any bound · squares: xatlas, which knows no bound"
    save(figure, path, default=why(table), notes=[marks, *notes])


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why, by the objects that every method has."""
    rows = {method: of for method, of in at_default(table).items() if method in _COLOURS}
    d = {method: f"{min(row['mean_d'] for row in of):.3f} to {max(row['mean_d'] for row in of):.3f}" for method, of in rows.items()}
    seam = {method: np.mean([row["seam"] for row in of]) for method, of in rows.items()}
    return (
        f"{_DEFAULT} at {Limits.mean:g}, which is for printing: simple pieces that keep well within the bound (mean d {d['usual']}); "
        f"fewest, which uses the bound up ({d['fewest']}), has {seam['usual'] - seam['fewest']:.2f} less of seam"
    )


def _ticks() -> Any:
    from matplotlib.ticker import LogLocator

    return LogLocator(subs=(1, 2, 5))


def _against_bound(axes: Any, rows: Sequence[Mapping[str, Any]], method: str, what: str) -> None:
    """A line an object and their mean; for the peer, which knows no bound, its mean alone."""
    if method not in _COLOURS:
        axes.axhline(np.mean([row[what] for row in rows]), color=_PEER, lw=2, ls="--", label=f"{method}, mean")
        return
    colour, bounds = _COLOURS[method], sorted({row["bound"] for row in rows})
    lines = {name: {row["bound"]: row[what] for row in rows if row["object"] == name} for name in dict.fromkeys(r["object"] for r in rows)}
    whole = [line for line in lines.values() if len(line) == len(bounds)]
    for line in lines.values():
        axes.plot(sorted(line), [line[b] for b in sorted(line)], "-", color=colour, lw=0.6, alpha=0.5)
    if whole:
        mean = {b: float(np.mean([line[b] for line in whole])) for b in bounds}
        axes.plot(bounds, [mean[b] for b in bounds], "o-", color=colour, lw=2, ms=5, label=f"{method}, mean")
        if method == _DEFAULT and Limits.mean in mean:
            ring(axes, Limits.mean, mean[Limits.mean], color=colour)


def _against_time(axes: Any, rows: Sequence[Mapping[str, Any]], method: str, what: str) -> None:
    """A point an object, at the default bound."""
    rows = [row for row in rows if row["bound"] is None or row["bound"] == Limits.mean]
    colour, mark = (_COLOURS[method], "o") if method in _COLOURS else (_PEER, "s")
    axes.plot([row["seconds"] for row in rows], [row[what] for row in rows], mark, color=colour, ms=5, label=method)
    if method == _DEFAULT:
        for row in rows:
            ring(axes, row["seconds"], row[what], size=11, color=colour)
