"""The charts: time against what is left of the distortion, d - 4, both logarithmic."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.bench.contestants import DEFAULT
from skinfab.bench.marked import ring, save
from skinfab.bench.refinement import NEWTON
from skinfab.bench.words import SAME_D, Table, pareto_front, why_isometric, why_newton

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_OURS, _PEER, _FRONT = "#0b6e4f", "#b5451b", "#777777"
_DPI = 150
_CLEAR = 9.0  # pixels around a point that no name covers
#: Where the least d is drawn on the refinement's logarithmic axis.
_FLOOR = 1e-4
_HEIGHT, _WIDTH = 5.6, 5.2  # inches a panel


def draw_methods(table: Table, path: Path, *, notes: Sequence[str] = ()) -> None:
    """Write time against d - 4 as PNG: a panel for each size, the Pareto front of the usable results, the default named."""
    sizes = sorted({row["triangles"] for row in table})
    figure, panels = _panels(len(sizes), "Flattening a disk: time against distortion")
    for axes, size in zip(panels, sizes, strict=True):
        rows = [row for row in table if row["triangles"] == size and row["mean_d"] is not None]
        for row in rows:
            colour = _OURS if row["kind"] == "ours" else _PEER
            face = colour if row["usable"] else "white"
            axes.plot(row["seconds"], row["mean_d"] - 4, "o" if row["kind"] == "ours" else "s", color=colour, mfc=face, ms=6, zorder=3)
        usable = [row for row in rows if row["usable"]]
        front = [usable[k] for k in pareto_front([(row["seconds"], row["mean_d"]) for row in usable])]
        axes.step([r["seconds"] for r in front], [r["mean_d"] - 4 for r in front], where="post", color=_FRONT, lw=1, zorder=1)
        chosen = next(row for row in rows if row["method"] == DEFAULT)
        ring(axes, chosen["seconds"], chosen["mean_d"] - 4, color=_OURS)
        axes.set_title(f"{size} triangles")
        _name(axes, rows)
    marks = "dots ours · squares peers · hollow: cut into pieces, flipped or overlapping · line: Pareto front"
    save(figure, path, default=why_isometric(table), notes=[marks, *notes])


def draw_refinement(refinement: Table, path: Path) -> None:
    """Write time against the d that is left to gain, after every iteration, as PNG: a panel for each size."""
    sizes = sorted({row["triangles"] for row in refinement})
    figure, panels = _panels(len(sizes), "Refinement from the same BFF start: a point an iteration")
    for axes, size in zip(panels, sizes, strict=True):
        table = [row for row in refinement if row["triangles"] == size]
        least = min(row["mean_d"] for row in table)
        for method in dict.fromkeys(row["method"] for row in table):
            rows = [row for row in table if row["method"] == method]
            above = [max((row["mean_d"] - least) / (least - 4), _FLOOR) for row in rows]
            name = (
                f"{method}, the default: d {rows[-1]['mean_d']:.5f}" if method == NEWTON else f"libigl {method}: d {rows[-1]['mean_d']:.5f}"
            )
            colour, mark = (_OURS, "o-") if method == NEWTON else (_PEER, "s-")
            # The start is at no time at all, for which a logarithmic axis has no room: it is a line.
            axes.plot([row["seconds"] for row in rows[1:]], above[1:], mark, color=colour, ms=4, lw=1, label=name)
            if method == NEWTON:
                ring(axes, rows[-1]["seconds"], above[-1], color=_OURS)
                axes.axhline(above[0], color=_FRONT, lw=1, ls=":", label=f"BFF, the start: d {rows[0]['mean_d']:.5f}")
        axes.axhline(SAME_D - 1, color=_FRONT, lw=1, ls="--", label=f"within {SAME_D - 1:.1%}: compared here")
        axes.set_title(f"{size} triangles")
        axes.legend(fontsize=8, loc="upper right", bbox_to_anchor=(1, 0.93))
    panels[0].set_ylabel("(mean d - least d) / (least d - 4)")
    marks = f"the least d is drawn at {_FLOOR:g}; processor time since the start, setting up included"
    save(figure, path, default=why_newton(refinement), notes=[marks])


def _panels(count: int, title: str) -> tuple[Figure, list[Axes]]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    figure = Figure(figsize=(_WIDTH * count, _HEIGHT), dpi=_DPI)
    FigureCanvasAgg(figure)  # names are placed by their extent, which only a canvas that draws knows
    figure.subplots_adjust(left=0.16 / count + 0.015, right=0.985, top=0.88, bottom=0.2, wspace=0.05)
    figure.suptitle(title)
    panels = list(figure.subplots(1, count, squeeze=False, sharey=True)[0])
    for axes in panels:
        axes.set(xscale="log", yscale="log", xlabel="processor time, s")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    panels[0].set_ylabel("mean d - 4 (0 is perfect)")
    return figure, panels


def _name(axes: Axes, rows: Table) -> None:
    """Names beside the points, or as near as one may stand clear of all points and other names, with a line to its point."""
    from matplotlib.text import Text
    from matplotlib.transforms import Bbox

    axes.margins(x=0.2, y=0.15)
    axes.autoscale_view()
    renderer = axes.figure.canvas.get_renderer()  # type: ignore[attr-defined]
    points = axes.transData.transform([(row["seconds"], row["mean_d"] - 4) for row in rows])
    taken = [Bbox.from_extents(x - _CLEAR, y - _CLEAR, x + _CLEAR, y + _CLEAR) for x, y in points]
    for row in sorted(rows, key=lambda r: (r["method"] != DEFAULT, r["seconds"])):
        words = f"{row['method']} (the default)" if row["method"] == DEFAULT else row["method"]
        words += f" ({row['pieces']} pieces)" if row["pieces"] > 1 else ""
        note = axes.annotate(
            words,
            (row["seconds"], row["mean_d"] - 4),
            xytext=_SPOTS[0],
            textcoords="offset points",
            fontsize=7,
            va="center",
            weight="bold" if row["method"] == DEFAULT else "normal",
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": _FRONT, "shrinkA": 0, "shrinkB": 3},
        )
        for spot in _SPOTS:
            note.set(position=spot, ha="left" if spot[0] > 0 else "right")
            note.update_positions(renderer)
            box = Text.get_window_extent(note, renderer)  # the text alone, without the line to its point
            inside = axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1 and axes.bbox.y0 <= box.y0 and box.y1 <= axes.bbox.y1
            if inside and not any(box.overlaps(other) for other in taken):
                break
        taken.append(box)


#: Where a name may stand from its point, in points: beside it, then farther and farther below and above.
_SPOTS = [(dx, sign * dy) for dy in range(0, 200, 9) for sign in (-1, 1) for dx in (9, -9)]
