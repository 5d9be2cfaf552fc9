"""What was taken for what."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.rates import Rate, by_trial, wilson

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DPI = 150


@dataclass(frozen=True, eq=False)
class Confusion:
    """Counts of what was taken for what.

    Parameters
    ----------
    names : tuple of str
        The classes.
    counts : (c, c) int
        Row: what it was; column: what it was taken for.

    Examples
    --------
    >>> found = Confusion.of(["a", "a", "b"], ["a", "b", "b"], ("a", "b"))
    >>> found.counts.tolist()
    [[1, 1], [0, 1]]
    >>> print(found.accuracy)
    0.667 [0.208, 0.939]
    """

    names: tuple[str, ...]
    counts: NDArray[np.int64]

    @classmethod
    def of(cls, truth: Sequence[str], said: Sequence[str], names: Sequence[str]) -> Confusion:
        """Count.

        Raises
        ------
        InputError
            Truth and decisions are not of one length, or one is of no class.
        """
        if len(truth) != len(said):
            raise InputError(f"{len(said)} decisions on {len(truth)} cases; give one a case")
        if other := next((each for each in (*truth, *said) if each not in names), None):
            raise InputError(f"class {other!r} is none of {', '.join(map(repr, names))}")
        row = {name: k for k, name in enumerate(names)}
        counts = np.zeros((len(names), len(names)), dtype=np.int64)
        np.add.at(counts, ([row[each] for each in truth], [row[each] for each in said]), 1)
        return cls(tuple(names), counts)

    def __add__(self, other: Confusion) -> Confusion:
        """Of both together."""
        if self.names != other.names:
            raise InputError(f"classes {', '.join(self.names)} and {', '.join(other.names)} cannot be counted together")
        return Confusion(self.names, self.counts + other.counts)

    @cached_property
    def accuracy(self) -> Rate:
        """Right of all, with Wilson's interval: for cases that are independent (else `grouped_accuracy`)."""
        return wilson(int(np.trace(self.counts)), int(self.counts.sum()))

    def facts(self) -> dict[str, Any]:
        """Ready for JSON."""
        known = self.counts.sum() > 0
        return {
            "classes": list(self.names),
            "counts": self.counts.tolist(),
            "accuracy": {"value": self.accuracy.value if known else None, "low": self.accuracy.low, "high": self.accuracy.high},
        }

    def draw_on(self, axes: Axes, *, title: str = "") -> None:
        """Percent of each row as a map with numbers on it, as the papers print theirs."""
        of = self.counts.sum(axis=1, keepdims=True)
        part = np.divide(100.0 * self.counts, of, out=np.zeros(self.counts.shape), where=of > 0)
        axes.imshow(part, cmap="Blues", vmin=0, vmax=100)
        size = 8 if len(self.names) <= 6 else 6
        for i, j in np.ndindex(*part.shape):
            if self.counts[i, j]:
                axes.text(j, i, f"{part[i, j]:.0f}", ha="center", va="center", fontsize=size, color="white" if part[i, j] > 55 else "black")
        axes.set_xticks(range(len(self.names)), self.names, rotation=90 if max(map(len, self.names)) > 3 else 0, fontsize=size)
        axes.set_yticks(range(len(self.names)), self.names, fontsize=size)
        axes.set_title(title, fontsize=9)

    def draw(self, path: Path, *, title: str, simulated: bool) -> None:
        """Write the map as PNG."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from skinfab.files import atomic_path

        side = 2.6 + 0.32 * len(self.names)
        figure = Figure(figsize=(side, side), dpi=_DPI, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots()
        self.draw_on(axes, title=f"{title}{' (simulated)' if simulated else ''}: {100 * self.accuracy.value:.1f} % right")
        axes.set(xlabel="taken for", ylabel="was")
        with atomic_path(path) as partial:
            figure.savefig(partial)


def grouped_accuracy(right: NDArray[np.bool_], groups: Sequence[Hashable]) -> Rate:
    """Right of all, where cases of one group (participant, object) are not independent: whole groups are drawn anew.

    Parameters
    ----------
    right : (n,) bool
    groups : sequence of n

    Examples
    --------
    >>> print(grouped_accuracy(np.array([True] * 9 + [False]), ["Ann"] * 5 + ["Bo"] * 5))
    0.900 [0.596, 1.000]
    """
    each: dict[Hashable, list[bool]] = {}
    for one, group in zip(right.tolist(), groups, strict=True):
        each.setdefault(group, []).append(one)
    return by_trial([sum(of) for of in each.values()], [len(of) for of in each.values()])
