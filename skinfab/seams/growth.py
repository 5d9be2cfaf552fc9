"""Darts into a sheet until it keeps to its bounds, each where and as long as it gains the most for its length.

A cut leaves the layout as it is, only free to do better: every layout is begun with the one before.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinfab.seams.outlook import dart_ways
from skinfab.seams.release import Way, held_releases, releases, right_of, sides_of
from skinfab.seams.sheet import Sheet, carried, keep_apart, lay_apart, refined, sheet_of

FloatArray = NDArray[np.float64]

#: Spots that a dart is looked for at, no two nearer than this part of the root of the area; more where none will do.
_CANDIDATES, _SPREAD = 12, 0.1
_MORE = 9

#: Of so many the gain is foretold in full.
_SOLVED = 3

#: A dart is worth what it gains over its length to this power: under 1, so that one long dart may take the place of two.
LENGTH_POWER = 0.5

#: Gain beyond what is wanted counts for nothing; what is foretold is not all had, so this much more is wanted.
_WANTED = 1.25

#: A shorter dart is worth no more for that, in parts of the root of the area: many tiny ones would follow.
_SHORT = 0.05

#: From this many times what the bound allows above 4 on, a dart that would make a sheet cover itself is cut with its sides
#: kept apart; before that darts that follow may part them, and a barrier would be much in their way.
_NEAR = 3.0

#: A piece with this many darts is better parted.
_MOST_DARTS = 60

#: Sides of a fresh cut begin this part of the barrier's reach off their place, each way; less where triangles are too thin.
_GAPS = (0.25, 0.03, 0.004)


def grow(
    start: Sheet, bound: float, *, p99: float = np.inf, power: float = LENGTH_POWER, shorter_than: float = np.inf, early: bool = True
) -> Sheet:
    """Cut darts until the mean d is at most `bound`, and 99 % of the area keep to `p99`.

    Parameters
    ----------
    start : Sheet
        Laid out freely: goes on so. Laid out apart: keeps its boundary apart.
    bound, p99 : float
    power : float
        A dart is worth what it gains over its length to this power.
    shorter_than : float, mm
        Given up when all seams together are no shorter.

    early : bool
        Keep its boundary apart as soon as it would cover itself; else it may.

    Returns
    -------
    Sheet
        Over the bounds where nothing helps any more, or it was given up.
    """
    now, darts = start, 0
    while not now.within(bound, p99) and darts < _MOST_DARTS:
        # Hot spots have no say in the mean: once it keeps to its bound, the dart that gains most of what is above 4.
        opened = None
        ways = best_darts(now, bound if now.mean > bound else 4.0, power=power)
        if ways and now.length + now.surface.lengths[ways[0].edges].sum() >= shorter_than:
            break
        for way in ways:
            opened = with_dart(now, way)
            if opened is None:
                continue
            if early and now.apart is None and now.mean - 4 < _NEAR * (bound - 4) and now.is_simple and not opened.is_simple:
                opened = with_dart(replace(now, apart=keep_apart(now)), way) or opened
            break
        if opened is None:
            break
        now, darts = opened, darts + 1
    return now


def best_darts(now: Sheet, bound: float, *, power: float = LENGTH_POWER) -> list[Way]:
    """The few best darts from the boundary to their tips, the best first; none where no dart gains anything."""
    size = now.surface.size
    wanted = _WANTED * (now.mean - bound)
    for times in (1, _MORE):
        ways = dart_ways(now, count=times * _CANDIDATES, apart=_SPREAD * size / np.sqrt(times))

        def worth(gains: list[FloatArray], ways: list[Way]) -> list[FloatArray]:
            return [_worth(now, way, gain, wanted, power) for way, gain in zip(ways, gains, strict=True)]

        sides = sides_of(now.solver, now.UV, now, ways)
        rough = [value.max() for value in worth(held_releases(sides), ways)]
        chosen = [k for k in np.argsort(rough)[::-1][: times * _SOLVED] if rough[k] > 0]
        ways, sides = [ways[k] for k in chosen], [sides[k] for k in chosen]
        if not ways:
            continue
        values = worth(releases(now.flexibility, sides), ways)
        best = [k for k in np.argsort([-value.max() for value in values], kind="stable") if values[k].max() > 0]
        if best:
            return [_up_to(ways[k], int(np.argmax(values[k]))) for k in best]
    return []


def _up_to(way: Way, end: int) -> Way:
    edges = int(way.ends[end])
    return Way(way.vertices[: edges + 1], way.edges[:edges])


def _worth(now: Sheet, way: Way, gains: FloatArray, wanted: float, power: float) -> FloatArray:
    """Of the dart to each of a way's ends."""
    surface = now.surface
    length = np.cumsum(surface.lengths[way.edges])[way.ends - 1]
    value: FloatArray = np.minimum(gains, wanted) / np.maximum(length, _SHORT * surface.size) ** power
    if surface.forbidden[way.edges].any():
        value = value * (np.cumsum(surface.forbidden[way.edges])[way.ends - 1] == 0)
    return value


def with_dart(now: Sheet, way: Way) -> Sheet | None:
    """With a dart cut along `way`, laid out from where it was; None where that is no longer one disk, or of no use."""
    cut = now.cut.copy()
    cut[way.edges] = True
    opened = sheet_of(now.surface, cut)
    if opened is None:
        return None
    uv = carried(now, opened)
    if now.apart is None:
        return refined(opened, uv)
    opened = replace(opened, apart=keep_apart(opened))
    parted = _parted(opened, uv, now, way)
    if parted is not None:
        return refined(opened, parted)
    anew = lay_apart(opened, hopeless_above=now.mean)
    return anew if anew.mean < now.mean else None


def _parted(opened: Sheet, uv: FloatArray, now: Sheet, way: Way) -> FloatArray | None:
    """The sides of a fresh cut a little off each other, as a barrier cannot part what touches; None where there is no room."""
    path = way.vertices
    assert opened.apart is not None
    place = np.full(len(now.UV), -1)
    place[path[:-1]] = np.arange(len(path) - 1)
    right = np.zeros(len(opened.F), dtype=bool)
    right[right_of(path, way.edges, now.F, now.FE, now.EF)] = True
    corners = np.flatnonzero(place[now.F.ravel()] >= 0)
    along = np.gradient(now.UV[path], axis=0)
    left = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.maximum(np.linalg.norm(along, axis=1), np.finfo(float).tiny)[:, None]
    off = np.zeros_like(uv)
    off[opened.F.ravel()[corners]] = left[place[now.F.ravel()[corners]]] * np.where(right[corners // 3], -1.0, 1.0)[:, None]
    for share in _GAPS:
        moved = uv + share * opened.apart.reach * off
        if opened.solver.best_scale(moved)[1] > 0 and replace(opened, UV=moved).is_simple:
            return moved
    return None
