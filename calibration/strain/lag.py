"""By how much a reading comes after the joint's angle: the clocks of a camera and of a board, told from a sensor's slack.

A curve alone cannot tell: slack makes a reading late too, by its angle over the speed. So the reading is taken as
``f(z(t - lag))``, z being the angle behind play of a half-width r, f any curve of degree 4. For each r all lags are
judged at once: the sums of the least-squares problem are correlations of the angle's powers with the reading, and come from
FFTs. What remains unexplained is least at the lag sought. How sure that is, is told by leaving out a stroke at a time
(jackknife, Efron and Stein 1981): neighbouring samples are not independent, strokes nearly are. A movement that repeats has
several lags that fit alike; they are all named.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from calibration.strain.correlation import DEGREE, STEP_S, Pair, Sums, between, bottom, least, powers_of, total
from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: Half-widths of slack that are tried, as parts of the angles' span: nothing, to the widest that the play model knows.
SLACKS = tuple(k / 80 for k in range(21))
#: Near the best one they are tried in finer steps, so many to either side, this part of a step each.
_FINER, _PART = 6, 0.5
#: So many strokes (the joint bent, or stretched) it takes at least; and no more groups than that are left out in turn.
MIN_STROKES, MAX_GROUPS = 3, 12
#: A stroke is a movement over this part of the span.
_STROKE = 0.25
#: The joint must move by this, deg, or noise of the markers is all there is.
MIN_SPAN_DEG = 5.0
#: A reading of which a curve of the angle explains less than this at the best lag does not follow the joint.
MIN_EXPLAINED = 0.5
#: Lags are searched by this, s, to either side of the best one when strokes are left out.
_NEAR_S = 0.5
#: Another lag fits as well where it is worse by less than so many standard errors over the strokes, and leaves no more
#: unexplained than the F distribution gives in one draw of forty, a stroke counting as one sample; or where it explains all
#: but this part of the variance less: nobody would tell two clocks apart by the third digit of R2.
_ERRORS, _TAIL, _ALIKE = 2.0, 0.975, 1e-3
#: Lags nearer to each other than this part of a stroke are one: a valley of what is left unexplained may have ripples.
_ONE = 0.5
#: A half-width of slack that leaves less than this part of what is in common is not judged.
_USED_UP = 0.5
#: So many other valleys are looked at.
_RIVALS = 20


@dataclass(frozen=True)
class Lag:
    """By how much readings come after angles.

    Parameters
    ----------
    lag_s : float, s
        Negative: before.
    low_s, high_s : float, s
        Ends of its 95 % interval.
    slack_deg : float
        Half-width of the play that goes with it.
    explained : float
        Part of the reading's variance that it explains, R2.
    others_s : tuple of float, s
        Further lags that fit as well, the best first: the movement repeats.
    """

    lag_s: float
    low_s: float
    high_s: float
    slack_deg: float
    explained: float
    others_s: tuple[float, ...]


def find_lag(pairs: Sequence[Pair], lags: tuple[float, float], *, least_overlap_s: float = 0.0, near_zero: bool = False) -> Lag:
    """The lag within these limits at which a curve of the angle, behind slack, explains the reading best.

    Parameters
    ----------
    pairs : sequence of Pair
    lags : (low, high), s
    least_overlap_s : float, s
        Lags that leave less than this in common are not judged.
    near_zero : bool
        Of lags that fit alike take the one nearest to 0, as where clocks are thought to agree.

    Raises
    ------
    InputError
        The joint hardly moves, or the reading does not follow it at any lag.

    Examples
    --------
    >>> time = np.arange(0, 30, STEP_S)
    >>> angle = 40 * np.sin(time) + 20 * np.sin(0.37 * time**1.2)
    >>> late = np.interp(time - 0.25, time, angle)
    >>> all_of_it = np.ones(len(time), bool)
    >>> found = find_lag([Pair(0, angle, all_of_it, 0, late + late**2 / 500, all_of_it)], (-1, 1))
    >>> round(found.lag_s, 2), found.slack_deg, found.others_s
    (0.25, 0.0, ())
    """
    known = np.concatenate([pair.angle[pair.angle_known] for pair in pairs])
    if not len(known) or np.ptp(known) < MIN_SPAN_DEG:
        raise InputError(f"the joint moves by less than {MIN_SPAN_DEG:g} degrees, which tells no lag; record it bending and stretching")
    low, high = float(known.min()), float(known.max())
    widths = [part * (high - low) for part in SLACKS]
    grid = np.arange(round(lags[0] / STEP_S), round(lags[1] / STEP_S) + 1)
    powers = [[powers_of(pair, width, low, high) for pair in pairs] for width in widths]
    unexplained = np.empty((len(widths), len(grid)))
    least_n = np.zeros(0)
    for row, each in zip(unexplained, powers, strict=True):
        sums = total([Sums.of(pair, at, grid) for pair, at in zip(pairs, each, strict=True)])
        if not least_n.size:
            # What is in common is told without slack: behind it a movement counts only from when the slack was used up, and to
            # ask as much of that would leave the lag to slack too narrow (0.1 s wrong behind 9 degrees at an overlap of 0.55).
            overlap = np.maximum(max(least_overlap_s / STEP_S, 2 * DEGREE), sums.n)
            least_n = np.where(sums.n == overlap, _USED_UP * overlap, np.inf)
        row[:] = np.where(sums.n >= least_n, sums.unexplained(), np.inf)
    profile = least(unexplained)
    valleys = _valleys(profile)
    best = min(valleys, key=lambda k: float(profile[k]), default=int(np.argmin(profile)))
    if not (valleys and profile[best] < 1 - MIN_EXPLAINED):
        explained = max(1 - float(profile[best]), 0.0)
        raise InputError(
            f"no shift from {lags[0]:.1f} to {lags[1]:.1f} s lets the reading follow the angle (R2 {explained:.2f} at best): is it "
            "this joint's sensor, and were both recorded at once?"
        )
    groups = _strokes(pairs, low, high, grid[best])
    if len(groups) < MIN_STROKES:
        raise InputError(
            f"the joint bends and stretches {len(groups)} times while both were recorded, which does not tell a lag; it takes "
            f"{MIN_STROKES} strokes, some quick and some slow"
        )
    alike = _alike(pairs, powers, unexplained, grid, groups)
    if near_zero:
        alike.sort(key=lambda k: abs(grid[k]))
    chosen = alike[0]
    width = int(np.argmin(unexplained[:, chosen]))
    finer = [width / (len(SLACKS) - 1) + k * _PART / (len(SLACKS) - 1) for k in range(-_FINER, _FINER + 1)]
    finer = [part * widths[-1] for part in finer if 0 <= part <= 1]
    nearly = [[powers_of(pair, each, low, high) for pair in pairs] for each in finer]
    lag, spread, best_width = _jackknife(pairs, nearly, int(grid[chosen]), groups)
    return Lag(
        lag,
        lag - spread,
        lag + spread,
        finer[best_width],
        float(1 - profile[chosen]),
        tuple(float(grid[k] * STEP_S) for k in alike[1:]),
    )


def _valleys(profile: FloatArray) -> list[int]:
    """Where it is less than on either side: at the ends of the search it only falls on towards what is not known."""
    found: list[int] = (np.flatnonzero((profile[1:-1] <= profile[:-2]) & (profile[1:-1] < profile[2:])) + 1).tolist()
    return found


def _strokes(pairs: Sequence[Pair], low: float, high: float, lag: int) -> list[list[tuple[int, slice]]]:
    """Readings stroke by stroke, as (pair, where), in `MAX_GROUPS` groups at most."""
    strokes: list[tuple[int, slice]] = []
    for number, pair in enumerate(pairs):
        counts = np.flatnonzero(pair.reading_counts)
        shift = lag - pair.offset
        counts = counts[(counts - shift >= 0) & (counts - shift < len(pair.angle))]
        if not len(counts):
            continue
        moved = pair.angle[counts - shift]
        turns = _turns(moved, _STROKE * (high - low))
        edges = [int(counts[0]), *(int(counts[k]) for k in turns), int(counts[-1]) + 1]
        strokes += [(number, slice(a, b)) for a, b in pairwise(edges) if b > a]
    size = -(-len(strokes) // MAX_GROUPS) if strokes else 1
    return [strokes[k : k + size] for k in range(0, len(strokes), size)]


def _turns(angle: FloatArray, stroke: float) -> list[int]:
    """Where a movement turns that goes on by more than `stroke` before and after."""
    turns: list[int] = []
    top = bottom = 0
    way = 0
    for k, value in enumerate(angle.tolist()):
        top = k if value >= angle[top] else top
        bottom = k if value <= angle[bottom] else bottom
        if way >= 0 and angle[top] - value > stroke:
            if way:
                turns.append(top)
            way, bottom = -1, k
        elif way <= 0 and value - angle[bottom] > stroke:
            if way:
                turns.append(bottom)
            way, top = 1, k
    return turns


def _by_group(
    pairs: Sequence[Pair], powers: Sequence[FloatArray], grid: NDArray[np.int64], groups: Sequence[Sequence[tuple[int, slice]]]
) -> list[Sums]:
    """The sums of each group alone, at a few lags."""
    out = []
    for group in groups:
        parts = []
        for number, where in group:
            pair, X = pairs[number], powers[number]
            # Only the angles that these lags reach: a short FFT.
            first = min(max(where.start - int(grid[-1]) + pair.offset, 0), len(pair.angle) - 1)
            last = max(where.stop - int(grid[0]) + pair.offset, first + 1)
            cut = Pair(
                pair.angle_from + first * STEP_S,
                pair.angle[first:last],
                pair.angle_known[first:last],
                pair.reading_from + where.start * STEP_S,
                pair.reading[where],
                pair.reading_counts[where],
            )
            parts.append(Sums.of(cut, X[first:last], grid))
        out.append(total(parts))
    return out


def _alike(
    pairs: Sequence[Pair],
    powers: Sequence[Sequence[FloatArray]],
    unexplained: FloatArray,
    grid: NDArray[np.int64],
    groups: Sequence[Sequence[tuple[int, slice]]],
) -> list[int]:
    """Places of the lags that fit as well as the best one, which comes first."""
    from scipy.stats import f

    profile = least(unexplained)
    valleys = sorted(_valleys(profile), key=lambda k: float(profile[k]))
    best = valleys[0]
    apart = _ONE * float(np.median([where.stop - where.start for group in groups for _, where in group]))
    found = [best]
    ours = _group_errors(pairs, powers[int(np.argmin(unexplained[:, best]))], grid[best : best + 1], groups)
    for rival in valleys[1 : 1 + _RIVALS]:
        if profile[rival] > 1 - MIN_EXPLAINED or min(abs(rival - k) for k in found) < apart:
            continue
        theirs = _group_errors(pairs, powers[int(np.argmin(unexplained[:, rival]))], grid[rival : rival + 1], groups)
        more = (theirs - ours)[np.isfinite(ours) & np.isfinite(theirs)]
        unclear = profile[rival] <= profile[best] * f.ppf(_TAIL, len(groups), len(groups))
        unclear &= len(more) < 2 or bool(np.mean(more) <= _ERRORS * np.std(more, ddof=1) / np.sqrt(len(more)))
        # Neither lies on the grid: what that costs is no difference between them.
        if unclear or bottom(profile, rival) - bottom(profile, best) <= _ALIKE:
            found.append(rival)
    return found


def _group_errors(
    pairs: Sequence[Pair], powers: Sequence[FloatArray], lag: NDArray[np.int64], groups: Sequence[Sequence[tuple[int, slice]]]
) -> FloatArray:
    """Mean squares that one curve for all leaves in each group; NaN where a group has nothing in common."""
    each = _by_group(pairs, powers, lag, groups)
    x = total(each).curves()[0]
    squares = np.array([s.c[0] - 2 * x @ s.b[0] + x @ s.A[0] @ x for s in each])
    n = np.array([s.n[0] for s in each])
    out: FloatArray = np.where(n > 1, squares / np.maximum(n, 1), np.nan)
    return out


def _jackknife(
    pairs: Sequence[Pair], powers: Sequence[Sequence[FloatArray]], best: int, groups: Sequence[Sequence[tuple[int, slice]]]
) -> tuple[float, float, int]:
    """The lag, s, half of its 95 % interval, and which half-width goes with it."""
    from scipy.stats import t

    reach = round(_NEAR_S / STEP_S)
    near = np.arange(best - reach, best + reach + 1)
    by_width = [_by_group(pairs, each, near, groups) for each in powers]
    totals = [total(each) for each in by_width]

    def lag_of(sums: Sequence[Sums]) -> tuple[float, int]:
        unexplained = np.array([each.unexplained() for each in sums])
        profile = least(unexplained)
        # The valley that the best lag lies in, not one a period away.
        k = reach
        while 0 < k < len(profile) - 1 and min(profile[k - 1], profile[k + 1]) < profile[k]:
            k += 1 if profile[k + 1] < profile[k - 1] else -1
        return float(near[k] + between(profile, k)) * STEP_S, int(np.argmin(unexplained[:, k]))

    whole, width = lag_of(totals)
    without = np.array(
        [
            lag_of([Sums(all_.A - one.A, all_.b - one.b, all_.c - one.c) for all_, one in zip(totals, ones, strict=True)])[0]
            for ones in zip(*by_width, strict=True)
        ]
    )
    k = len(without)
    error = np.sqrt((k - 1) / k * np.sum((without - without.mean()) ** 2))
    # No better than a step: what the grid of half-widths leaves is not seen by leaving out strokes.
    return whole, max(float(t.ppf(0.975, k - 1) * error), STEP_S), width
