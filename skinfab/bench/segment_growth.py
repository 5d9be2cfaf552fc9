"""How the time and memory for automatic seams grow with the triangles: one surface at several resolutions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.balls import bumpy_ball
from skinfab.bench.contestants import Contestant
from skinfab.bench.flatten import read_csv, write_csv
from skinfab.bench.marked import png
from skinfab.bench.segment import AIMS, Row, measure_objects
from skinfab.bench.words import exponents, growth_exponent
from skinfab.files import atomic_write
from skinfab.mesh.model import Mesh
from skinfab.progress import Progress, part_of, silent
from skinfab.seams.judge import Limits

#: A method that would take longer on a size, s, by its growth so far, is left out from there on: a table is made while one waits.
LONGEST_S = 300.0

_COLOURS = ("#0b6e4f", "#2b5c9e", "#b5451b")
_DPI = 150


def follow(
    folder: Path, sizes: Sequence[int], peer: Contestant | None, *, longest_s: float = LONGEST_S, progress: Progress = silent
) -> tuple[list[dict[str, Any]], list[str]]:
    """Measure every method once on a ball of each size at the default bound, and write growth.csv and growth.png into `folder`.

    Parameters
    ----------
    folder : Path
        There already.
    sizes : sequence of int
        Triangles, see `bumpy_ball`.
    peer : Contestant, optional
    longest_s : float, s
        Of processor time. A method that is expected to take longer on a size is not run on that and on larger ones.
    progress : Progress

    Returns
    -------
    rows : list of dict
        As growth.csv has them.
    notes : list of str
        What was refused or left out, and where.
    """
    rows: list[Row] = []
    notes: list[str] = []
    aims = list(AIMS)
    for k, size in enumerate(sorted(sizes)):
        for method in (*aims, *([] if peer is None else [peer.name])):
            seconds = expected([row for row in rows if row.method == method], size)
            if seconds > longest_s:
                notes.append(f"{method} was left out from {size} triangles on: by its growth it would have taken {seconds:.0f} s there")
                aims = [aim for aim in aims if aim != method]
                peer = None if peer is not None and peer.name == method else peer
        ball = (f"ball {size}", Mesh(*bumpy_ball(size), f"ball {size}"))
        part = part_of(progress, k / len(sizes), (k + 1) / len(sizes))
        found, refused = measure_objects([ball], peer, aims=aims, bounds=(Limits.mean,), repeats=1, progress=part)
        rows, notes = [*rows, *found], [*notes, *refused]
    write_csv(rows, folder / "growth.csv")
    table = read_csv(folder / "growth.csv")
    draw_growth(table, folder / "growth.png", notes=notes)
    return table, notes


def expected(rows: Sequence[Row], triangles: int) -> float:
    """Seconds that a method will take, by its growth between the last two sizes; in proportion after one, 0 after none."""
    if not rows:
        return 0.0
    p = growth_exponent([row.triangles for row in rows[-2:]], [row.seconds for row in rows[-2:]])
    return rows[-1].seconds * float(triangles / rows[-1].triangles) ** (1.0 if p is None else p)


def growth_sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What every method took on the largest ball that it was run on, and the power its time grows with."""
    powers, said = exponents(table), []
    for method in dict.fromkeys(row["method"] for row in table):
        row = max((row for row in table if row["method"] == method), key=lambda row: row["triangles"])
        memory = "" if row["peak_mb"] is None else f" and {row['peak_mb']:.0f} MB"
        power = f", growing with the triangles to the power of {powers[method]:.2f}" if method in powers else ""
        said.append(f"{method} takes {row['seconds']:.3g} s{memory} for {row['triangles']} triangles{power}")
    return f"On a ball with bumps, at mean d {Limits.mean:g}, " + "; ".join(said) + "."


def draw_growth(table: Sequence[Mapping[str, Any]], path: Path, *, notes: Sequence[str] = ()) -> None:
    """Write the chart as PNG: processor time and memory against triangles, a line for each method."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.4, 4.9), dpi=_DPI)
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.07, right=0.985, top=0.89, bottom=0.12 + 0.035 * len(notes), wspace=0.16)
    figure.suptitle(f"Automatic seams at mean d {Limits.mean:g}, from coarse balls to fine")
    powers = exponents(table)
    for axes, what, along in zip(figure.subplots(1, 2), ("seconds", "peak_mb"), ("processor time, s", "rise of memory, MB"), strict=True):
        for k, method in enumerate(dict.fromkeys(row["method"] for row in table)):
            rows = [row for row in table if row["method"] == method and row[what] is not None]
            said = f": {_pieces(rows)}" + (f", power of {powers[method]:.2f}" if method in powers else "")
            label = method + (said if what == "seconds" else "")
            axes.plot([row["triangles"] for row in rows], [row[what] for row in rows], "o-", color=_COLOURS[k], label=label)
        axes.set(xscale="log", yscale="log", xlabel="triangles", ylabel=along)
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
        axes.legend(fontsize=8)
    figure.text(0.5, 0.012, "\n".join(notes), ha="center", va="bottom", fontsize=8)
    atomic_write(path, png(figure))


def _pieces(rows: Sequence[Mapping[str, Any]]) -> str:
    few, many = min(row["pieces"] for row in rows), max(row["pieces"] for row in rows)
    return f"{many} piece" + "s" * (many != 1) if few == many else f"{few} to {many} pieces"
