"""Is the improved method as sure as it is right? Its confidence beside what is right, on participants of other seeds than its constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.confusion import grouped_accuracy
from skinfab.fingertip.nail.improved import asked, frequency, learn
from skinfab.fingertip.nail.protocol import Protocol, sessions
from skinfab.fingertip.nail.train import WINDOW
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]

#: Confidences that are put together: narrower where most of them are.
EDGES = (0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 0.96, 1.0)
_DPI = 140


@dataclass(frozen=True)
class Row:
    """Trials of one test that were told with like confidence, by the default window.

    Parameters
    ----------
    test : str
    low, high : float
        Between which the confidence lies; 0 and 1 for all trials together.
    trials : int
    confidence : float
        Its mean, percent.
    percent, percent_low, percent_high : float
        Right, and the 95 % interval (participants drawn anew).
    simulated : bool
    """

    test: str
    low: float
    high: float
    trials: int
    confidence: float
    percent: float
    percent_low: float
    percent_high: float
    simulated: bool = True


def measure(protocol: Protocol, tests: Sequence[str], *, seed: int = 1, progress: Progress = silent) -> list[Row]:
    """A row for each test and range of confidence that has trials, after one for all of the test.

    Examples
    --------
    >>> rows = measure(Protocol(participants=2, training=3, rounds=2, samples=64), ("edges4",))
    >>> rows[0].trials, sum(row.trials for row in rows[1:])
    (16, 16)
    """
    rows = []
    for j, test in enumerate(tests):
        sure, right, of = [], [], []
        for k, each in enumerate(sessions(test, protocol=replace(protocol, estimates=1), seed=seed)):
            progress((j + k / protocol.participants) / len(tests), f"{test}: confidence, participant {k + 1}")
            model, windows = learn(each), asked(each, WINDOW)
            found = model.decide(windows, drive_hz=frequency(windows, model))
            sure.append(found.confidence)
            right.append(found.classes == each.rounds.classes)
            of += [k] * len(windows)
        rows += _rows(test, np.concatenate(sure), np.concatenate(right), np.array(of))
    return rows


def _rows(test: str, sure: FloatArray, right: NDArray[np.bool_], of: NDArray[np.int64]) -> list[Row]:
    rows = []
    for low, high in ((0.0, 1.0), *pairwise(EDGES)):
        here = (sure >= low) & ((sure < high) | (high == EDGES[-1]))
        if not here.any():
            continue
        rate = grouped_accuracy(right[here], of[here].tolist())
        percent = (100 * rate.value, 100 * rate.low, 100 * rate.high)
        rows.append(Row(test, low, high, int(here.sum()), 100 * float(sure[here].mean()), *percent))
    return rows


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """How far confidence and truth are apart: every number in it comes from the table."""
    parts = []
    for test in dict.fromkeys(row["test"] for row in table):
        whole, *ranges = (row for row in table if row["test"] == test)
        apart = sum(row["trials"] * abs(row["confidence"] - row["percent"]) for row in ranges) / whole["trials"]
        parts.append(
            f"{whole['confidence']:.1f} % of {test} where {whole['percent']:.1f} % are right (in like ranges {apart:.1f} points apart)"
        )
    return f"The improved method's confidence, simulated, is {', '.join(parts)} in the mean."


def draw(table: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write the chart as PNG: what is right over how sure it was, a panel a test; marks are as large as trials are many."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from skinfab.bench.marked import png
    from skinfab.files import atomic_write

    tests = list(dict.fromkeys(row["test"] for row in table))
    figure = Figure(figsize=(3.6 * len(tests) + 0.4, 4.3), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle("Nail: is it as sure as it is right? (simulated participants; windows of 33 readings)", fontsize=10)
    for axes, test in zip(figure.subplots(1, len(tests), sharey=True, squeeze=False)[0], tests, strict=True):
        whole, *rows = (row for row in table if row["test"] == test)
        axes.plot([0, 100], [0, 100], color="#888888", lw=1, ls="--", label="as sure as right")
        x, y = [row["confidence"] for row in rows], [row["percent"] for row in rows]
        off = [[row["percent"] - row["percent_low"] for row in rows], [row["percent_high"] - row["percent"] for row in rows]]
        axes.errorbar(x, y, off, fmt="none", ecolor="#0072B2", elinewidth=1, capsize=2, label="95 % interval over participants")
        size = [12 + 240 * row["trials"] / whole["trials"] for row in rows]
        axes.scatter(x, y, s=size, color="#0072B2", alpha=0.7, zorder=3, label="right (area: how many trials)")
        axes.set(title=f"{test}: {whole['confidence']:.1f} sure, {whole['percent']:.1f} right", xlabel="confidence, %")
        axes.set(xlim=(25, 104), ylim=(-4, 106), yticks=range(0, 101, 20))
        axes.title.set_fontsize(9)
        axes.grid(True, lw=0.3, alpha=0.6)
    figure.axes[0].set_ylabel("right, %")
    marks, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(marks, names, loc="outside lower center", ncols=3, fontsize=8)
    atomic_write(path, png(figure))
