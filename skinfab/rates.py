"""How often something was right, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

#: Draws of a bootstrap.
DRAWS = 2000
#: The normal distribution's two-sided 95 % quantile.
_Z = 1.959963984540054


@dataclass(frozen=True)
class Rate:
    """A part of a whole, and the ends of its 95 % confidence interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3f} [{self.low:.3f}, {self.high:.3f}]"


def wilson(right: int, of: int) -> Rate:
    """A rate of independent cases with Wilson's interval; nothing known where there is no case.

    Examples
    --------
    >>> print(wilson(98, 100))
    0.980 [0.930, 0.994]
    """
    if not of:
        return Rate(math.nan, 0.0, 1.0)
    part, square = right / of, _Z * _Z / of
    middle, half = part + square / 2, _Z * math.sqrt(part * (1 - part) / of + square / (4 * of))
    return Rate(part, max((middle - half) / (1 + square), 0.0), min((middle + half) / (1 + square), 1.0))


def by_trial(right: Sequence[int], of: Sequence[int], *, seed: int = 0) -> Rate:
    """A rate over trials, with an interval by drawing whole trials: cases of one trial are not independent.

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
