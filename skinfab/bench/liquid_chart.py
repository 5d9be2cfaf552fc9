"""The chart of liquids: what is found over the water there is, and false alarms under each condition."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import fill
from typing import Any

from skinfab.bench.marked import ring, save
from skinfab.fingertip.force.liquid import FALSE_ALARM

_COLOURS = {"wander": "#D55E00", "spectrum": "#0072B2", "learned": "#009E73"}
_LABELS = {"wander": "how far lines wander", "spectrum": "line in the spectrum (default)", "learned": "the same, limit learned"}
_DEFAULT = "spectrum"
_DPI = 150
#: Where no false alarm at all is drawn on a logarithmic axis.
_FLOOR = 1e-3


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: found over grams in a still and in a trembling hand, and false alarms."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.5, 4.8), dpi=_DPI, layout="constrained")
    figure.suptitle("Is there a liquid in the cup? Water that swings, found and made up (simulated)", fontsize=10)
    *panels, alarms = figure.subplots(1, 3)
    conditions = list(dict.fromkeys(row["condition"] for row in table))
    for axes, condition in zip(panels, (conditions[0], conditions[-1]), strict=True):
        for rule, colour in _COLOURS.items():
            for angle, line in zip(sorted({row["angle_deg"] for row in table} - {0.0}), ("--", "-"), strict=False):
                rows = [r for r in table if (r["condition"], r["rule"], r["angle_deg"]) == (condition, rule, angle)]
                label = f"{_LABELS[rule]}, {angle:g}°"
                axes.plot([r["grams"] for r in rows], [r["found"] for r in rows], line, marker="o", ms=4, lw=1, color=colour, label=label)
        ticks = sorted({row["grams"] for row in table} - {0})
        axes.set_xscale("log")
        axes.set_xticks(ticks, [f"{each:g}" for each in ticks])
        axes.minorticks_off()
        tremble = next(row["tremble_mm_s2"] for row in table if row["condition"] == condition) / 1000
        axes.set(xlabel="g of water", ylim=(-0.02, 1.02), title=condition + (f" ({tremble:g} m/s² rms)" if tremble else ""))
        axes.title.set_size(9)
    panels[0].set_ylabel("cups found")
    # Below the panels: within them every corner holds points.
    figure.legend(*panels[0].get_legend_handles_labels(), fontsize=8, ncols=3, loc="outside lower center")
    for k, (rule, colour) in enumerate(_COLOURS.items()):
        rows = [next(r for r in table if (r["condition"], r["rule"], r["grams"]) == (condition, rule, 0)) for condition in conditions]
        place = [j + 0.2 * (k - 1) for j in range(len(rows))]
        found, low, high = ([max(r[key], _FLOOR) for r in rows] for key in ("found", "low", "high"))
        alarms.plot(place, found, "o", color=colour, ms=5)
        alarms.vlines(place, low, high, color=colour, lw=1)
        if rule == _DEFAULT:
            ring(alarms, place[0], found[0])
    alarms.axhline(FALSE_ALARM, color="#555555", lw=1, ls="--")
    alarms.set_yscale("log")
    alarms.set_xticks(range(len(conditions)), [fill(each, 9) for each in conditions], fontsize=8)
    alarms.set(
        ylabel="empty cups taken for full ones",
        ylim=(0.8 * _FLOOR, 1.3),
        title=f"false alarms, 95 % (dashed: wanted; none: at {_FLOOR:g})",
    )
    alarms.title.set_size(9)
    for axes in figure.axes:
        axes.grid(True, lw=0.3, alpha=0.6)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why, by the first condition; and what it is not for, by the last."""
    still, shaky = (table[k]["condition"] for k in (0, -1))
    by = {(row["condition"], row["rule"], row["grams"], row["angle_deg"]): row["found"] for row in table}
    least = min(angle for *_, angle in by if angle > 0)
    return (
        f"a line in the spectrum, at a stated {FALSE_ALARM:.0%}: it needs no empty cups and in a still hand takes "
        f"{by[still, _DEFAULT, 0, 0]:.1%} of them for full, 20 g that swing by {least:g} degrees being found in "
        f"{by[still, _DEFAULT, 20, least]:.0%} (by how far lines wander {by[still, 'wander', 20, least]:.0%}); a hand that trembles needs "
        f"a learned limit ({by[shaky, 'learned', 0, 0]:.1%} of the empty cups instead of {by[shaky, _DEFAULT, 0, 0]:.0%})"
    )
