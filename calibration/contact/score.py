"""How good a detector is: contacts found against contacts that were, and how sure that is.

The rule: a found contact is right where it shares at least half of the time it spans together with a true one (intersection
over union), on the same channel; each is matched once, the best pairs first. So a contact that breaks in two
is one that is right at best and one that is wrong, and one that is forgotten after a second of twenty is not found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from calibration.contact.detector import Contact
from skinfab.rates import Rate

#: Two contacts are the same from this intersection over union on.
SAME = 0.5


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


def score(found: Sequence[Contact], truth: Sequence[Contact], *, end: float) -> Score:
    """Judge a trial.

    Parameters
    ----------
    found, truth : sequence of Contact
    end : float, s
        Of the trial, which began at 0; a contact that still lasts ends there.

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
        end / 60,
        tuple(made[i][1] - were[j][1] for i, j in right),
        tuple(made[i][2] - were[j][2] for i, j in right),
    )


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
