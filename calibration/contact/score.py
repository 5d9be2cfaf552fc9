"""How good a detector is: contacts found against contacts that were, and how sure that is.

The rule: a found contact is right where it shares at least half of the time it spans together with a true one (intersection
over union), on the same channel; each is matched once, the best pairs first. So a contact that breaks in two
is one that is right at best and one that is wrong, and one that is forgotten after a second of twenty is not found.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibration.contact.detector import Contact

#: Two contacts are the same from this intersection over union on.
SAME = 0.5
#: Draws of a bootstrap.
DRAWS = 2000


@dataclass(frozen=True)
class Score:
    """Of one trial.

    Parameters
    ----------
    true, found, right : int
        Contacts that were, that were found, and that are both.
    right_sign : int
        Of those that are right, with the sign of the true one.
    false_alarms : int
        Found where the channel was not touched at all.
    minutes : float
    start_errors, end_errors : tuple of float, s
        Found less true, of those that are right.
    """

    true: int
    found: int
    right: int
    right_sign: int
    false_alarms: int
    minutes: float
    start_errors: tuple[float, ...]
    end_errors: tuple[float, ...]


@dataclass(frozen=True)
class Rate:
    """A part of a whole, and the ends of its 95 % confidence interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3f} [{self.low:.3f}, {self.high:.3f}]"


def score(found: Sequence[Contact], truth: Sequence[Contact], *, end: float, start: float = 0.0) -> Score:
    """Judge a trial.

    Parameters
    ----------
    found, truth : sequence of Contact
    start, end : float, s
        Of the trial; a contact that still lasts ends there.

    Examples
    --------
    >>> truth = [Contact("S1", 1.0, 3.0, 1, 0.4)]
    >>> whole = score([Contact("S1", 1.1, 2.9, 1, 0.4)], truth, end=60.0)
    >>> broken = score([Contact("S1", 1.1, 1.9, 1, 0.4), Contact("S1", 2.0, 2.9, 1, 0.4)], truth, end=60.0)
    >>> (whole.right, whole.found), (broken.right, broken.found), broken.false_alarms
    ((1, 1), (0, 2), 0)
    """
    made = [(each.channel, each.start, end if each.lasting else each.end, each.sign) for each in found]
    were = [(each.channel, each.start, end if each.lasting else each.end, each.sign) for each in truth]
    pairs, touching = [], set()
    for i, (channel, a, b, _) in enumerate(made):
        for j, (other, c, d, _) in enumerate(were):
            if channel == other and (shared := min(b, d) - max(a, c)) > 0:
                touching.add(i)
                if (part := shared / (max(b, d) - min(a, c))) >= SAME:
                    pairs.append((part, i, j))
    taken_i: set[int] = set()
    taken_j: set[int] = set()
    right = []
    for _, i, j in sorted(pairs, reverse=True):
        if i not in taken_i and j not in taken_j:
            taken_i.add(i)
            taken_j.add(j)
            right.append((i, j))
    return Score(
        len(were),
        len(made),
        len(right),
        sum(made[i][3] == were[j][3] for i, j in right),
        len(made) - len(touching),
        (end - start) / 60,
        tuple(made[i][1] - were[j][1] for i, j in right),
        tuple(made[i][2] - were[j][2] for i, j in right),
    )


def wilson(right: int, of: int) -> Rate:
    """A rate of independent cases with Wilson's interval; nothing known where there is no case.

    Examples
    --------
    >>> print(wilson(98, 100))
    0.980 [0.930, 0.994]
    """
    if not of:
        return Rate(math.nan, 0.0, 1.0)
    z = 1.959963984540054
    part, square = right / of, z * z / of
    middle, half = part + square / 2, z * math.sqrt(part * (1 - part) / of + square / (4 * of))
    return Rate(part, max((middle - half) / (1 + square), 0.0), min((middle + half) / (1 + square), 1.0))


def by_trial(right: Sequence[int], of: Sequence[int], *, seed: int = 0) -> Rate:
    """A rate over trials, with an interval by drawing whole trials: touches of one trial are not independent.

    It is no narrower than Wilson's, which a bootstrap without a single error would shrink to nothing.

    Examples
    --------
    >>> print(by_trial([10, 10, 7], [10, 10, 10]))
    0.900 [0.700, 1.000]
    """
    whole = wilson(sum(right), sum(of))
    if not sum(of):
        return whole
    drawn = np.random.default_rng(seed).integers(0, len(of), (DRAWS, len(of)))
    count = np.asarray(of, dtype=float)[drawn].sum(axis=1)
    rates = (np.asarray(right, dtype=float)[drawn].sum(axis=1) / np.maximum(count, 1))[count > 0]
    low, high = np.quantile(rates, (0.025, 0.975))
    return Rate(whole.value, min(float(low), whole.low), max(float(high), whole.high))


def poisson(count: int, minutes: float) -> Rate:
    """Events a minute, with the exact 95 % interval of a Poisson count.

    Examples
    --------
    >>> print(poisson(0, 30.0))
    0.000 [0.000, 0.123]
    """
    from scipy.stats import chi2

    low = float(chi2.ppf(0.025, 2 * count)) / 2 if count else 0.0
    return Rate(count / minutes, low / minutes, float(chi2.ppf(0.975, 2 * count + 2)) / 2 / minutes)
