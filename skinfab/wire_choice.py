"""One way out for each of several wires, such that few of them cross.

Wires are chosen one after the other, each the cheapest beside those before it. Then a wire in trouble takes its cheapest way
beside all others, again and again; where none gains by that, the crossings that are left weigh more from then on (P. Morris,
"The breakout method for escaping from local minima", AAAI 1993). The cheapest choice met is the result.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from skinfab.tolerances import MOULD_GRID_MM
from skinfab.wire_ways import Ways

#: What faults cost, beside mm of wire: a crossing more than any length, and a wire that shares another's slot more than ten
#: crossings. The search takes longer the farther these two are apart.
CROSSING = 1e5
CLASH = 1e6

#: Steps of the search, for each wire; of forty crowded cases whose best is known it missed two by a crossing.
_STEPS = 40


def choose_ways(ways: Sequence[Ways], faults: Sequence[NDArray[np.float64]], *, apart: float) -> list[int | None]:
    """The number of the way that each wire takes; None where all its ways lead through walls that others take.

    Parameters
    ----------
    ways : sequence of Ways
        Of each wire.
    faults : sequence of (n,) float
        What is wrong with each of these, whatever the other wires do; as much as a ``CROSSING`` where it crosses something.
    apart : float, mm
        Distance of two ways in the wall at least.

    Examples
    --------
    Two wires from neighbouring places, for either of which up is shorter than down; in the wall there is room for one.

    >>> def up_or_down(x):
    ...     wire = np.array([[[x, 0.0], [x, 2.0]], [[x, 0.0], [x, -3.0]]])
    ...     wall = np.array([[[x, 2.0], [x, 4.0]], [[x, -3.0], [x, -5.0]]])
    ...     return Ways(wire, wall, np.zeros(2, dtype=bool), np.array([2.0, 3.0]))
    >>> choose_ways([up_or_down(0.0), up_or_down(0.5)], [np.zeros(2), np.zeros(2)], apart=1.0)
    [0, 1]
    """
    search = _Search(ways, faults, apart)
    chosen = search.untangled()
    kept: list[int | None] = []
    for k, c in enumerate(chosen):
        taken = [ways[j].wall[i] for j, i in enumerate(kept) if i is not None]
        clashes = c >= 0 and _near(ways[k].wall[c : c + 1], np.array(taken).reshape(-1, 2, 2), apart).any()
        kept.append(None if c < 0 or clashes else int(c))
    return kept


class _Search:
    """A choice is (wires,) int64, the way of each wire, and -1 where it has none."""

    def __init__(self, ways: Sequence[Ways], faults: Sequence[NDArray[np.float64]], apart: float) -> None:
        self.length, self.faults, self.apart = [w.length for w in ways], faults, apart
        self.wires, self.walls = (np.concatenate([np.zeros((0, 2, 2)), *(getattr(w, name) for w in ways)]) for name in ("wire", "wall"))
        ends = np.cumsum([0, *(len(w.length) for w in ways)])
        self.of = [slice(*each) for each in pairwise(ends.tolist())]
        self.some = [k for k, w in enumerate(ways) if len(w.length)]
        self.columns: dict[tuple[int, int], NDArray[np.float64]] = {}
        self.chosen = np.full(len(ways), -1)
        # Of each wire's choice with all ways of all wires.
        self.beside = np.zeros((len(ways), len(self.wires)))
        # How much more than at first each crossing weighs: of two wires, and of a wire by itself.
        self.weight, self.own_weight = np.ones((len(ways), len(ways))), np.ones(len(ways))

    def untangled(self) -> NDArray[np.int64]:
        for k in self.some:
            self._take(k, int(self._costs(k).argmin()))
        least, best = self._cost(), self.chosen.copy()
        for _ in range(_STEPS * len(self.some)):
            if not (troubled := self._troubled()):
                break
            if not any(self._improved(k) for k in troubled):
                self._weigh_more(troubled)
            elif (cost := self._cost()) < least:
                least, best = cost, self.chosen.copy()
        for k in self.some:
            self._take(k, int(best[k]))
        self._shorten()
        return self.chosen

    def _shorten(self) -> None:
        """Single wires take better ways while there are some."""
        self.weight[:], self.own_weight[:] = 1.0, 1.0
        while any([self._improved(k, by=MOULD_GRID_MM) for k in self.some]):
            pass

    def _improved(self, k: int, *, by: float = CROSSING / 2) -> bool:
        costs = self._costs(k)
        c = int(costs.argmin())
        if not costs[c] < costs[self.chosen[k]] - by:
            return False
        self._take(k, c)
        return True

    def _take(self, k: int, c: int) -> None:
        self.chosen[k] = c
        self.beside[k] = self._column(k, c)

    def _costs(self, k: int) -> NDArray[np.float64]:
        """Of each way of wire k beside the others' choices."""
        return self.length[k] + self.own_weight[k] * self.faults[k] + self.weight[k] @ self.beside[:, self.of[k]]

    def _cost(self) -> float:
        """Of all choices together, as crossings weighed at first."""
        return sum(
            float(self.length[k][c] + self.faults[k][c] + self.beside[:, self.of[k]][:, c].sum() / 2)
            for k, c in enumerate(self.chosen)
            if c >= 0
        )

    def _troubled(self) -> list[int]:
        """Wires that would be better by a crossing if they were alone."""
        return [
            k
            for k in self.some
            if self.faults[k][self.chosen[k]] - self.faults[k].min() + self.beside[:, self.of[k]][:, self.chosen[k]].sum() >= CROSSING / 2
        ]

    def _weigh_more(self, troubled: Sequence[int]) -> None:
        for k in troubled:
            self.weight[k] += self.beside[:, self.of[k]][:, self.chosen[k]] > 0
            self.own_weight[k] += self.faults[k][self.chosen[k]] - self.faults[k].min() >= CROSSING / 2

    def _column(self, j: int, c: int) -> NDArray[np.float64]:
        """What way c of wire j costs together with all ways of the others."""
        column = self.columns.get((j, c))
        if column is None:
            at = slice(self.of[j].start + c, self.of[j].start + c + 1)
            column = CROSSING * _cross(self.wires, self.wires[at])[:, 0] + CLASH * _near(self.walls, self.walls[at], self.apart)[:, 0]
            column[self.of[j]] = 0.0
            self.columns[j, c] = column
        return column


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether each of some segments meets each of others, (n, m); segments on one line do not count."""
    of_a, of_b = _sides(a, b), _sides(b, a)
    return (of_a.prod(axis=2) <= 0) & (of_b.prod(axis=2).T <= 0) & (of_a != 0).any(axis=2)


def _sides(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """On which side of the line along each `a` the two ends of each `b` lie, (n, m, 2)."""
    along, to = (a[:, 1] - a[:, 0])[:, None, None], b[None] - a[:, None, None, 0]
    return np.sign(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])


def _near(a: NDArray[np.float64], b: NDArray[np.float64], apart: float) -> NDArray[np.bool_]:
    """Whether each of some segments is nearer to each of others than that, (n, m)."""
    ends = np.minimum(_to_ends(a, b), _to_ends(b, a).T)
    return (ends < apart) | _cross(a, b)


def _to_ends(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of each segment `a` to the nearer end of each `b`, (n, m)."""
    along, to = (a[:, 1] - a[:, 0])[:, None, None], b[None] - a[:, None, None, 0]
    t = (to * along).sum(axis=3) / np.maximum((along**2).sum(axis=3), np.finfo(float).tiny)
    away = to - np.clip(t, 0, 1)[..., None] * along
    return np.sqrt((away**2).sum(axis=3)).min(axis=2, initial=np.inf)
