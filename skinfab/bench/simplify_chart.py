"""The chart of simplification: triangles solved for against what is lost of d, and against time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import ring, save
from skinfab.flatten.simplified import SHARE
from skinfab.tolerances import SIMPLIFY_EFFECT

_COLOURS = ("#0b6e4f", "#b5451b", "#2b5c9e", "#7a4fa3", "#8a6d00", "#555555")
_DPI = 150
#: Where no loss at all is drawn on a logarithmic axis: rounding of the table's nine digits times a hundred.
_FLOOR = 1e-7


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: a line a size, the default ringed, hollow where the simplified mesh was not good enough."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    figure = Figure(figsize=(10.4, 5.6), dpi=_DPI, layout="constrained")
    figure.suptitle("Simplifying before flattening: triangles solved for against distortion and time")
    loss, time = figure.subplots(1, 2)
    for k, size in enumerate(sorted({row["triangles"] for row in table})):
        colour = _COLOURS[k % len(_COLOURS)]
        rows = [row for row in table if row["triangles"] == size]
        whole = next(row for row in rows if row["share"] == 1)
        fewer = [row for row in rows if row["share"] > 1]
        asked = [row["triangles"] // row["share"] for row in fewer]
        lost = [max(row["mean_d"] - whole["mean_d"], _FLOOR) for row in fewer]
        loss.plot(asked, lost, "-", color=colour, lw=1, label=f"{size} triangles")
        carried = [(n, max(row["effect"], _FLOOR)) for n, row in zip(asked, fewer, strict=True) if row["carried"]]
        loss.plot(*zip(*carried, strict=True) if carried else ([], []), ":", color=colour, lw=1)
        time.plot([size, *asked], [row["seconds"] for row in [whole, *fewer]], "-", color=colour, lw=1, label=f"{size} triangles")
        time.plot(size, whole["seconds"], "s", color=colour, ms=6)
        for n, above, row in zip(asked, lost, fewer, strict=True):
            face = colour if row["carried"] else "white"
            for axes, y in ((loss, above), (time, row["seconds"])):
                axes.plot(n, y, "o", color=colour, mfc=face, ms=5, zorder=3)
                if row["share"] == SHARE:
                    ring(axes, n, y, color=colour)
    loss.axhline(SIMPLIFY_EFFECT, color="#777777", lw=1, ls="--", label=f"{SIMPLIFY_EFFECT:g}: more is not carried")
    loss.set_ylabel("mean d above that of all triangles")
    time.set_ylabel("time, s")
    for axes, corner in ((loss, "upper right"), (time, "upper left")):
        axes.set(xscale="log", yscale="log", xlabel="triangles solved for")
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
        axes.legend(fontsize=8, loc=corner)
    time.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    time.yaxis.set_major_formatter("{x:g}")
    time.yaxis.set_minor_formatter(NullFormatter())
    marks = (
        "dotted: what the method says d could lose at most · square: all triangles · "
        f"no more than {_FLOOR:g}: drawn there · hollow: not good enough, refined on all triangles after all"
    )
    save(figure, path, default=why(table), notes=[marks])


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why, by the largest size."""
    size = max(row["triangles"] for row in table)
    seconds = {row["share"]: row["seconds"] for row in table if row["triangles"] == size}
    less = min(share for share in seconds if share > 1)
    fewer = min(seconds[share] for share in seconds if share > SHARE)
    return (
        f"one in {SHARE}, where the time stops falling: {seconds[SHARE] / seconds[1]:.2f} of that of all {size} triangles; one in {less} "
        f"takes {seconds[less] / seconds[1]:.2f}, and fewer {fewer / seconds[1]:.2f} at best"
    )
