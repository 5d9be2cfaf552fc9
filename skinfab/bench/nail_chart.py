"""The charts of the nail's tests: accuracies by sensor condition as in the paper's figures 6, 8 and 10, confusion as in 7, 9, 11 and 12."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.marked import png, ring, save
from skinfab.files import atomic_write
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome
from skinfab.fingertip.nail.published import CONDITIONS

_OURS, _PAPER, _IMPROVED = "#0072B2", "#D55E00", "#009E73"
_DPI = 130
#: Above 100 %, so that a mark there is whole.
_TOP = 106
#: Inches for the names of classes, the marks' own size.
_NAMES_INCHES, _NAME_SIZE = 1.55, 6


def draw_accuracy(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the accuracies as PNG: a panel a test, bars with the participants' standard deviation, the paper's as marks."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    tests = list(dict.fromkeys(row["test"] for row in table))
    figure = Figure(figsize=(11, 3.9), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Nail: accuracy by sensor condition (simulated participants; error bars: their standard deviation)", fontsize=10)
    for axes, test in zip(figure.subplots(1, len(tests), sharey=True, squeeze=False)[0], tests, strict=True):
        rows = [row for row in table if row["test"] == test and row["method"] == "published"]
        at = np.arange(len(rows))
        axes.bar(
            at,
            [r["percent"] for r in rows],
            yerr=[r["deviation"] for r in rows],
            color=_OURS,
            alpha=0.75,
            capsize=2,
            label="published method",
        )
        for exact, mark in ((True, "D"), (False, "_")):
            of = [(k, r["paper"]) for k, r in enumerate(rows) if r["paper"] is not None and bool(r["around"]) != exact]
            if of:
                axes.plot(
                    *zip(*of, strict=True),
                    mark,
                    color=_PAPER,
                    ms=6 if exact else 14,
                    mew=1.5,
                    label="paper" if exact else 'paper, "around 50 %"',
                )
        better = next(r for r in table if r["test"] == test and r["method"] == "improved")
        axes.plot(0, better["percent"], "^", color=_IMPROVED, ms=8, label="improved method")
        ring(axes, 0, better["percent"], size=16)
        axes.set_xticks(at, [r["condition"] for r in rows], rotation=90, fontsize=7)
        axes.set(title=test, ylim=(0, _TOP), yticks=range(0, 101, 20))
    figure.axes[0].set_ylabel("right, %")
    named = {name: mark for axes in figure.axes for mark, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=len(named), fontsize=8)
    save(figure, path, default=why(table))


def why(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default is, and why."""
    said = []
    for better in (row for row in table if row["method"] == "improved"):
        published = [row["percent"] for row in table if (row["test"], row["method"]) == (better["test"], "published")]
        said.append(f"{better['test']} {better['percent']:.1f} % (published, under any condition, {max(published):.1f} at best)")
    return f"the improved method, on all six channels: {', '.join(said)}"


def draw_confusion(outcome: Outcome, path: Path) -> None:
    """Write what was taken for what under each sensor condition as PNG, in percent of each row.

    Classes have their numbers, as in the paper's figures, and their names at the left and at the bottom. No trial of the test is without
    contact, so that 0 is no row.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    names = ["0 no contact", *(f"{k} {pattern.name}" for k, pattern in enumerate(TESTS[outcome.test], 1))]
    side = 3 * (1.6 + 0.2 * len(names)) + _NAMES_INCHES
    figure = Figure(figsize=(side, side), dpi=_DPI)  # fixed margins: a layout engine draws every number twice
    FigureCanvasAgg(figure)
    margin = (_NAMES_INCHES + 0.3) / side
    figure.subplots_adjust(left=margin, right=0.98, bottom=margin, top=0.93, wspace=0.12, hspace=0.22)
    figure.suptitle(f"{outcome.test}, published method: what (row) was taken for what (column), % (simulated)", fontsize=10)
    panels = figure.subplots(3, 3)
    for axes, condition in zip(panels.ravel(), CONDITIONS, strict=True):
        found = outcome.confusion[condition]
        found.draw_on(axes, title=f"{condition}: {100 * found.accuracy.value:.1f} %")
        axes.set_ylim(len(names) - 0.5, 0.5)
    for axes in panels[:, 0]:
        axes.set_yticks(range(1, len(names)), names[1:], fontsize=_NAME_SIZE)
        axes.set_ylabel("was")
    for axes in panels[-1]:
        axes.set_xticks(range(len(names)), names, fontsize=_NAME_SIZE, rotation=90)
        axes.set_xlabel("taken for")
    atomic_write(path, png(figure))
