"""How good events are: found against true ones, and the paper's rule as it stands, for comparison.

A found event is right where it is of the true one's kind and shares half of the time with it that they span together; each
is matched once, the best pairs first.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.contact import locate
from skinfab.fingertip.force.motion import KINDS, ROLLING, SEPARATION, SLIDING, Motion, moving_mean
from skinfab.rates import by_trial

FloatArray = NDArray[np.float64]

#: Two events are the same from this intersection over union on.
SAME = 0.5


@dataclass(frozen=True)
class Counts:
    """Of one kind in one log.

    Parameters
    ----------
    true, found, right : int
        Events that were, that were found, and that are both.
    delays : tuple of float, s
        From the beginning of a right one to when it was told.
    """

    true: int
    found: int
    right: int
    delays: tuple[float, ...]


def score(found: Sequence[Motion], truth: Sequence[Motion], *, end: float) -> dict[str, Counts]:
    """Judge a log that ends at `end` (s), kind by kind.

    Examples
    --------
    >>> truth = [Motion("rolling", 1.0, 2.0)]
    >>> score([Motion("rolling", 1.2, 2.1, 1.3), Motion("sliding", 3.0, 3.1, 3.0)], truth, end=9.0)["rolling"].right
    1
    """
    out = {}
    for kind in KINDS:
        made = [(each.start, end if each.lasting else each.end, each.told) for each in found if each.kind == kind]
        were = [(each.start, end if each.lasting else each.end) for each in truth if each.kind == kind]
        pairs = []
        for i, (a, b, _) in enumerate(made):
            for j, (c, d) in enumerate(were):
                if (part := (min(b, d) - max(a, c)) / max(max(b, d) - min(a, c), math.ulp(end))) >= SAME:
                    pairs.append((part, i, j))
        partner: dict[int, int] = {}
        for _, i, j in sorted(pairs, reverse=True):
            if i not in partner and j not in partner.values():
                partner[i] = j
        delays = tuple(made[i][2] - were[j][0] for i, j in partner.items())
        out[kind] = Counts(len(were), len(made), len(partner), delays)
    return out


def figures(scores: Sequence[dict[str, Counts]]) -> dict[str, dict[str, Any]]:
    """Precision, recall (each with its 95 % interval, whole logs drawn again) and the median delay, by kind and all together."""
    out = {}
    for name, kinds in (*((kind, (kind,)) for kind in KINDS), ("all", KINDS)):
        right = [sum(each[kind].right for kind in kinds) for each in scores]
        delays = [delay for each in scores for kind in kinds for delay in each[kind].delays]
        out[name] = {
            "precision": by_trial(right, [sum(each[kind].found for kind in kinds) for each in scores]),
            "recall": by_trial(right, [sum(each[kind].true for kind in kinds) for each in scores]),
            "delay_s": float(np.median(delays)) if delays else math.nan,
            "true": sum(each[kind].true for each in scores for kind in kinds),
        }
    return out


def published(
    time: FloatArray, force: FloatArray, moment: FloatArray, *, slide_deg: float, drop_n: float, roll_mm: float, samples: int = 10
) -> list[Motion]:
    """The paper's section 3 as it stands: one limit for beginning and end, and no history but the contact's last way.

    Parameters
    ----------
    time, force, moment : as `skinfab.fingertip.force.motion.find_motions`
    slide_deg : float, deg
        More is sliding.
    drop_n : float, N
        Less is separation, once something was touched.
    roll_mm : float, mm
        A longer way of the contact within four times `samples` is rolling.
    samples : int
        Averaged over, of which the paper says nothing.
    """
    mean = moving_mean(np.column_stack([force, moment]), samples)
    found = locate(mean[:, :3], mean[:, 3:], least_force=0.0)
    apart = (found.force_n < drop_n) & (np.maximum.accumulate(found.force_n) > 2 * drop_n)
    slides = np.degrees(found.inclination_rad) > slide_deg
    lag = 4 * samples
    way = np.linalg.norm(found.point - np.roll(found.point, lag, axis=0), axis=1)
    way[:lag] = 0.0
    touched = found.force_n >= drop_n
    kinds = np.where(apart, 1, np.where(touched & slides, 2, np.where(touched & (way > roll_mm), 3, 0)))
    edges = np.flatnonzero(np.diff(kinds, prepend=0, append=0))
    names = {1: SEPARATION, 2: SLIDING, 3: ROLLING}
    step = float(np.median(np.diff(time)))
    return [
        Motion(names[int(kinds[a])], float(time[a]), float(time[b - 1]) + step, float(time[a]))
        for a, b in itertools.pairwise(edges)
        if kinds[a]
    ]
