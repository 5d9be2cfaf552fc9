"""The chart of framings: byte errors against frames lost, and against frames wrong in silence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinfab.bench.framings import DEFAULT
from skinfab.bench.marked import ring, save

_COLOURS = {"ASCII": "#b5451b", "ASCII + sum": "#8a6d00", "sync + length + CRC-16": "#2b5c9e", DEFAULT: "#0b6e4f"}
_MARKS = {"ASCII": "s", "ASCII + sum": "D", "sync + length + CRC-16": "^", DEFAULT: "o"}
_DPI = 150


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: solid lines for bits flipped, dotted for bytes lost, the default ringed."""
    from matplotlib.figure import Figure

    frames = table[0]["frames"]
    floor = 0.3 / frames  # where none at all is drawn on a logarithmic axis
    figure = Figure(figsize=(10.4, 5.4), dpi=_DPI, layout="constrained")
    figure.suptitle(f"{frames} frames over a wire that hurts them: what is lost, and what is wrong and does not show")
    panels = figure.subplots(1, 2)
    for axes, key, label in zip(panels, ("lost", "wrong"), ("frames lost", "frames wrong in silence"), strict=True):
        for name in dict.fromkeys(row["framing"] for row in table):
            for k, fault in enumerate(dict.fromkeys(row["fault"] for row in table)):
                rows = [row for row in table if row["framing"] == name and row["fault"] == fault]
                # Beside each other, so that what coincides is still seen.
                x = [row["rate"] * (0.96 if k else 1.04) for row in rows]
                y = [max(row[key] / frames, floor) for row in rows]
                words = f"{name}, {fault}" + (" (the default)" if name == DEFAULT else "")
                colour = _COLOURS[name]
                axes.plot(x, y, _MARKS[name] + (":" if k else "-"), color=colour, mfc="white" if k else colour, ms=6, lw=1, label=words)
                if name == DEFAULT:
                    for point in zip(x, y, strict=True):
                        ring(axes, *point, color=colour)
        axes.axhline(floor, color="#777777", lw=1, ls="--")
        axes.set(xscale="log", yscale="log", xlabel="chance of a byte to be hurt", ylabel=f"{label}, part of those sent")
        axes.grid(True, which="both", lw=0.3, alpha=0.6)
    # Nobody loses much less than others: below the lines of that panel there is room.
    panels[0].legend(fontsize=7.5, loc="lower right", bbox_to_anchor=(1.0, 0.07))
    marks = "filled, solid: one bit of a byte flipped · hollow, dotted: byte lost · dashed: none at all, drawn there"
    save(figure, path, default=why(table), notes=[marks])


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    wrong, sent = ({name: sum(row[key] for row in table if row["framing"] == name) for name in _COLOURS} for key in ("wrong", "frames"))
    others = ", ".join(f"{name} {wrong[name]}" for name in _COLOURS if name != DEFAULT)
    return (
        f"{DEFAULT}: {wrong[DEFAULT]} of {sent[DEFAULT]} frames wrong in silence ({others}), and no reader waits for bytes that a hurt "
        "length promised"
    )
