"""Charts of following edges: how often contours close by step and by noise, and the seed's shapes as they are reconstructed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.marked import png, ring, save
from skinfab.bench.optical_contour import FRAMES, IMPROVED, PUBLISHED, patience, ways
from skinfab.files import atomic_write
from skinfab.fingertip.optical.follower import Feel
from skinfab.fingertip.optical.rig import Rig
from skinfab.fingertip.optical.shapes import reconstruct, shapes
from skinfab.fingertip.optical.simulator import paper_fingertip

_COLOURS = {PUBLISHED: "#b5451b", FRAMES: "#777777", IMPROVED: "#0b6e4f"}
_DPI = 150


def draw_rates(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write closed contours against step and against noise as PNG, with 95 % intervals; the default is ringed."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    step, noise = table[0]["step_mm"], table[0]["noise_mm"]
    figure = Figure(figsize=(10.5, 4.4), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(f"Following a 60 mm circle: contours closed of {table[0]['seeds']} (simulated)", fontsize=11)
    left, right = figure.subplots(1, 2, sharey=True)
    for k, (name, colour) in enumerate(_COLOURS.items()):
        of = [row for row in table if row["method"] == name]
        panels = (
            (left, "step_mm", [r for r in of if r["noise_mm"] == noise]),
            (right, "noise_mm", [r for r in of if r["step_mm"] == step]),
        )
        for axes, key, rows in panels:
            rows = sorted(rows, key=lambda row: row[key])
            x = [row[key] * (1 + 0.02 * (k - 1)) for row in rows]  # side by side, or one would hide another
            y = [row["rate"] for row in rows]
            ends = [[max(row["rate"] - row["low"], 0) for row in rows], [max(row["high"] - row["rate"], 0) for row in rows]]
            axes.errorbar(x, y, yerr=ends, fmt="o-", color=colour, ms=4, lw=1, capsize=2, label=name)
            if name == IMPROVED:
                ring(axes, x[0], y[0])
    left.set(xlabel=f"step, mm (tips' noise {noise:g} mm)", ylabel="part of contours closed round the plate")
    right.set(xlabel=f"tips' noise, mm (steps of {step:g} mm)")
    left.legend(fontsize=8)
    for axes in (left, right):
        axes.grid(True, lw=0.3, alpha=0.6)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    step, noise, seeds = (table[0][key] for key in ("step_mm", "noise_mm", "seeds"))
    usual = {row["method"]: row for row in table if (row["step_mm"], row["noise_mm"]) == (step, noise)}
    worst = {name: min(row["right"] for row in table if row["method"] == name) for name in _COLOURS}
    said = "; ".join(f"{name} {usual[name]['right']} and {worst[name]}" for name in _COLOURS)
    return (
        f"{IMPROVED}, in steps of {step:g} mm, the seed's: contours closed of {seeds}, there and at the worst step and noise: {said}; a "
        f"trace every {step:g} mm is what the shape is made of"
    )


def draw_reconstruction(feel: Feel, path: Path, *, seed: int = 0) -> None:
    """Write each shape with one trace and its hull, by the seed's way and by the improved one, as PNG (figures 7 and 9 of the seed)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    tip = paper_fingertip()
    figure = Figure(figsize=(12.0, 7.6), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Shapes reconstructed by following their edges (simulated)", fontsize=11)
    panels = figure.subplots(2, 3)
    for line, name in zip(panels, (PUBLISHED, IMPROVED), strict=True):
        for axes, shape in zip(line, shapes(), strict=True):
            trace = ways(feel, most_frames=patience(shape, 1.0))[name](Rig(shape.plate, tip, shape.plate.start, seed=seed))
            C = shape.plate.outline()
            axes.fill(C[:, 0], C[:, 1], color="#dddddd", label="true plate")
            axes.plot(*trace.edge.T, ".-", color=_COLOURS[name], ms=2, lw=0.6, label="trace")
            title = f"{shape.name}, {name}: edge lost"
            if len(trace.path) >= max(len(shape.sides_mm), 3):
                made = reconstruct(trace, shape, lines=name != PUBLISHED)
                H = made.hull
                axes.fill(H[:, 0], H[:, 1], fill=False, ec="#2255aa", lw=1.0, label="hull")
                title = f"{shape.name}, {name}\n{'closed' if made.right else 'not closed'}, {made.off_mm:.2f} mm off on average"
            axes.set_title(title, fontsize=8)
            axes.set_aspect("equal")
            axes.tick_params(labelsize=7)
    panels[0, 0].legend(fontsize=7)
    atomic_write(path, png(figure))
