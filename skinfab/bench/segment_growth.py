"""How the time for automatic seams grows with the triangles: one surface at several resolutions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.balls import bumpy_ball
from skinfab.bench.charts import png
from skinfab.bench.contestants import Contestant
from skinfab.bench.flatten import read_csv, write_csv
from skinfab.bench.segment import measure_objects
from skinfab.files import atomic_write
from skinfab.mesh.model import Mesh
from skinfab.progress import Progress, silent
from skinfab.seams.judge import Limits

_DPI = 150


def follow(
    folder: Path, sizes: Sequence[int], peer: Contestant | None, *, progress: Progress = silent
) -> tuple[list[dict[str, Any]], list[str]]:
    """Measure every method once on a ball of each size at the default bound, and write growth.csv and growth.png into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    sizes : sequence of int
        Triangles, see `bumpy_ball`.
    peer : Contestant, optional
    progress : Progress

    Returns
    -------
    rows : list of dict
        As growth.csv has them.
    refused : list of str
    """
    balls = [(f"ball {size}", Mesh(*bumpy_ball(size), f"ball {size}")) for size in sizes]
    rows, refused = measure_objects(balls, peer, bounds=(Limits.mean,), repeats=1, progress=progress)
    write_csv(rows, folder / "growth.csv")
    table = read_csv(folder / "growth.csv")
    draw_growth(table, folder / "growth.png")
    return table, refused


def draw_growth(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: processor time against triangles, a line for each method, its pieces beside each point."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.6), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for method in dict.fromkeys(row["method"] for row in table):
        rows = [row for row in table if row["method"] == method]
        axes.plot([row["triangles"] for row in rows], [row["seconds"] for row in rows], "o-", label=method)
        for row in rows:
            axes.annotate(f"{row['pieces']}", (row["triangles"], row["seconds"]), (4, 4), textcoords="offset points", fontsize=7)
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="triangles",
        ylabel="processor time, s",
        title=f"Automatic seams at mean d {Limits.mean:g}; beside each point its pieces",
    )
    axes.grid(True, which="both", lw=0.3, alpha=0.6)
    axes.legend(fontsize=8)
    atomic_write(path, png(figure))
