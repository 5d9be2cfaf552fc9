"""In which order, and from which end, the patterns are printed: a short way for the head between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gcode.geometry import Point
from skinfab.paths import Path

_Index = NDArray[np.int64]

#: Lengths are compared in nanometres, as whole numbers: ties are exact, and every machine finds the same order.
_PER_MM = 1e6

#: So many patterns in all, over the orders that are improved: a few patterns are tried from every start, hundreds from two.
_IMPROVED = 400

#: Runs of up to so many patterns are moved elsewhere.
_LONGEST_RUN = 3


def short_order(paths: dict[str, Path], *, start: Point) -> list[tuple[str, Path]]:
    """The paths in an order of short travel from `start`, each turned to begin at the end that is met first.

    Nearest neighbours from every first pattern; the shortest of these orders are improved until neither turning a run
    of patterns round (2-opt) nor moving up to three elsewhere (Or-opt) shortens them. Not always the shortest, but a
    few per cent from it; the same for the same paths whatever their order.

    Parameters
    ----------
    paths : dict of str to Path
    start : (x, y), mm
        Where the head comes from. Where it goes after the last pattern does not count.

    Returns
    -------
    list of (str, Path)

    References
    ----------
    G. A. Croes, "A Method for Solving Traveling-Salesman Problems", Operations Research 6, 1958; I. Or, "Traveling
    Salesman-Type Combinatorial Problems", Northwestern University, 1976.

    Examples
    --------
    >>> from skinfab.paths import Line
    >>> paths = {"A": Path((Line((0, 9), (5, 9)),)), "B": Path((Line((0, 3), (5, 3)),))}
    >>> [(name, path.start.tolist()) for name, path in short_order(paths, start=(0.0, 0.0))]
    [('B', [0.0, 3.0]), ('A', [5.0, 9.0])]
    """
    names = sorted(paths)
    far = _distances(np.array([(paths[n].start, paths[n].end) for n in names]).reshape(-1, 2), start)
    tries = _nearest_neighbours(far, len(names))[: max(_IMPROVED // len(names), 1)]
    best = min((_improved(order, far) for order in tries), key=lambda order: (_travel(order, far), order.tolist()))
    return [(names[end // 2], paths[names[end // 2]].reversed() if end % 2 else paths[names[end // 2]]) for end in best.tolist()]


def _distances(ends: NDArray[np.float64], start: Point) -> _Index:
    """Between all ends, 2 k and 2 k + 1 those of path k; then `start`; last a place that is no way from anywhere."""
    points = np.vstack([ends, start])
    far = np.zeros((len(points) + 1, len(points) + 1), dtype=np.int64)
    far[:-1, :-1] = np.rint(np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)) * _PER_MM)
    return far


def _nearest_neighbours(far: _Index, count: int) -> _Index:
    """From each end first, the order of nearest neighbours, (2 count, count): the end each path is begun at; the shortest first."""
    first = np.arange(2 * count)
    orders = np.empty((2 * count, count), dtype=np.int64)
    taken = np.zeros((2 * count, 2 * count), dtype=bool)
    here, travel = first, far[2 * count, : 2 * count].copy()
    for k in range(count):
        orders[:, k] = here
        taken[first, here] = taken[first, here ^ 1] = True
        if k + 1 < count:
            away = np.where(taken, np.iinfo(np.int64).max, far[here ^ 1, : 2 * count])
            here = away.argmin(axis=1)
            travel += away[first, here]
    return orders[np.argsort(travel, kind="stable")]


def _travel(order: _Index, far: _Index) -> int:
    enter, leave = _stations(order, far)
    return int(far[leave[:-1], enter[1:]].sum())


def _stations(order: _Index, far: _Index) -> tuple[_Index, _Index]:
    """Where the head comes down and where it lifts: at the start, at each path, and nowhere at last."""
    outer = np.array([len(far) - 2]), np.array([len(far) - 1])
    return np.concatenate([outer[0], order, outer[1]]), np.concatenate([outer[0], order ^ 1, outer[1]])


def _improved(order: _Index, far: _Index) -> _Index:
    """Move by move, always the one that saves most, until none saves any."""
    while (better := _best_move(order, far)) is not None:
        order = better
    return order


def _best_move(order: _Index, far: _Index) -> _Index | None:
    """The order after the move that saves most, or None where none saves."""
    count = len(order)
    enter, leave = _stations(order, far)
    link = far[leave[:-1], enter[1:]]
    # Turning the run from i to j: it is entered where it was left, and the other way round.
    saved = link[:-1, None] + link[1:] - far[leave[:-2, None], leave[1:-1]] - far[enter[1:-1, None], enter[2:]]
    i, j = divmod(int(np.triu(saved).argmax()), count)
    most, best = int(saved[i, j]) if i <= j else 0, np.concatenate([order[:i], order[i : j + 1][::-1] ^ 1, order[j + 1 :]])
    for size in range(1, min(_LONGEST_RUN, count - 1) + 1):
        # Moving the run from i to i + size - 1 in between stations k and k + 1, as it is or turned.
        head, tail = enter[1 : count - size + 2], leave[size : count + 1]
        before, after = leave[: count - size + 1], enter[size + 1 :]
        closed = link[: count - size + 1] + link[size:] - far[before, after]
        outside = np.arange(count + 1) - np.arange(count - size + 1)[:, None]
        for turned, (a, b) in enumerate(((head, tail), (tail, head))):
            gain = closed[:, None] + link - far[leave[:-1], a[:, None]] - far[b[:, None], enter[1:]]
            gain[(outside >= 0) & (outside <= size)] = 0
            i, k = divmod(int(gain.argmax()), count + 1)
            if gain[i, k] > most:
                run = order[i : i + size]
                run = run[::-1] ^ 1 if turned else run
                rest = np.delete(order, np.arange(i, i + size))
                at = k if k < i else k - size
                most, best = int(gain[i, k]), np.concatenate([rest[:at], run, rest[at:]])
    return best if most > 0 else None
