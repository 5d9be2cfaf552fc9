"""What is left over in the end: seams that a sheet can do without are closed, and its least worthy ones put elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.seams.closing import Fringe, closing_costs, closing_step, fringes
from skinfab.seams.growth import grow
from skinfab.seams.sheet import Sheet, keep_apart, refined, sheet_of

FloatArray = NDArray[np.float64]

#: So many edges of a seam's end are looked at, ...
_EDGES = 6

#: ... and closed if it is foretold to cost this part of what the bound leaves: closing costs more than to second order.
_FORETOLD = 0.9

#: If a closing fails so many next ones are tried before the rest is thought to fail as well.
_TRIED = 2

#: A shorter end, in parts of the root of the area, is not worth putting elsewhere.
_WORTH_MOVING = 0.02

#: What takes the place of a closed end is chosen nearly by gain for length: long darts were cut before.
_LENGTH_POWER = 0.7


@dataclass(frozen=True, eq=False)
class _Closing:
    """The first `count` edges of a seam's end, what closing them is foretold to cost in mean d, and their length in mm."""

    fringe: Fringe
    count: int
    cost: float
    length: float

    @property
    def name(self) -> tuple[int, int]:
        return int(self.fringe.edges[0]), self.count


def trim(now: Sheet, bound: float, *, p99: float = np.inf) -> Sheet:
    """Close ends of seams, the longest first, as long as the sheet keeps to its bounds.

    Parameters
    ----------
    now : Sheet
        Within the bounds.
    bound, p99 : float

    Returns
    -------
    Sheet
        With no more seam than before.
    """
    failed: set[tuple[int, int]] = set()
    while True:
        found = _closings(now)
        left = _FORETOLD * (bound - now.mean)
        found = sorted((c for c in found if c.cost <= left and c.name not in failed), key=lambda c: -c.length)
        for closing in found[:_TRIED]:
            closed = _closed(now, closing)
            if closed is not None and closed.within(bound, p99):
                now = closed
                break
            failed.add(closing.name)
        else:
            return now


def exchange(now: Sheet, bound: float, *, p99: float = np.inf, rounds: int, report: Callable[[float], None] | None = None) -> Sheet:
    """Close the end of a seam that does least for its length and cut a dart where it does more, as long as that shortens the seams.

    Parameters
    ----------
    now : Sheet
        Within the bounds.
    bound, p99 : float
    rounds : int
        How often that is tried.
    report : callable, optional
        Called with the part that is done; what it raises ends it.

    Returns
    -------
    Sheet
        With no more seam than before.
    """
    now = trim(now, bound, p99=p99)
    failed: set[int] = set()
    for k in range(rounds):
        if report:
            report(k / rounds)
        found = [c for c in _closings(now) if c.name[0] not in failed and c.length > _WORTH_MOVING * now.surface.size]
        if not found:
            break
        worst = min(found, key=lambda c: c.cost / c.length)
        closed = _closed(now, worst)
        other = None if closed is None else grow(closed, bound, p99=p99, power=_LENGTH_POWER, shorter_than=now.length)
        if other is None or not other.within(bound, p99):
            failed.add(worst.name[0])
            continue
        now = trim(other, bound, p99=p99)
    return now


def _closings(now: Sheet) -> list[_Closing]:
    ends = fringes(now, most=_EDGES)
    found = []
    for end, costs in zip(ends, closing_costs(now, ends), strict=True):
        length = np.cumsum(now.surface.lengths[end.edges])
        found += [_Closing(end, k + 1, float(costs[k]), float(length[k])) for k in range(len(costs)) if np.isfinite(costs[k])]
    return found


def _closed(now: Sheet, closing: _Closing) -> Sheet | None:
    """At its least d after closing; None where that is no disk, or the layout cannot be begun."""
    cut = now.cut.copy()
    cut[closing.fringe.edges[: closing.count]] = False
    closed = sheet_of(now.surface, cut)
    if closed is None:
        return None
    moved = closing_step(now, closing.fringe, closing.count)
    uv = np.empty((len(closed.origin), 2))
    uv[closed.F.ravel()] = moved[now.F.ravel()]
    if not closed.solver.best_scale(uv)[1] > 0:
        return None
    if now.apart is not None:
        closed = replace(closed, apart=keep_apart(closed))
        if not replace(closed, UV=uv).is_simple:
            return None
    return refined(closed, uv)
