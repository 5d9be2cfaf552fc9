"""The threshold of a contact detector, from how many false alarms a minute are wanted.

A cumulative sum (CUSUM) of winsorised, standardised readings alarms where it passes h. How many frames that takes where
nothing happens is a property of a Markov chain on the sum (Brook and Evans, "An approach to the probability distribution of
CUSUM run length", Biometrika 59, 1972); h is found where it is as long as was asked for. A channel's noise is known from
a window of so many frames and no better: the rate is averaged over what it may be instead. That the baseline is not known
exactly either costs nothing: it follows the readings, and so takes a little off each run of large ones (6 to 11 % fewer alarms).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: Half of the shift, in standard deviations of a channel, that the detector is made for: a shift of 3 is seen the soonest.
ALLOWANCE = 1.5
#: One frame adds at most this part of the threshold, so that an alarm needs three: a spike of one or two is none.
MOST_OF_THRESHOLD = 0.4
#: Cells of the chain; 2.5 m + 0.5 of them with m odd put the largest step on a cell's middle.
_CELLS = 103
#: Beyond a threshold of 9 no rate is believed (one alarm in a billion seconds): the noise of no device is normal so far out.
_THRESHOLDS = (0.5, 9.0)


@dataclass(frozen=True)
class Alarm:
    """When to call a change a contact.

    Parameters
    ----------
    threshold : float
        Of the cumulative sum, in standard deviations.
    cap : float
        A frame farther off its baseline than this many standard deviations counts as that far off.
    """

    threshold: float
    cap: float


def alarm_for(per_minute: float, *, channels: int, rate_hz: float, still_frames: int) -> Alarm:
    """The threshold at which so many false alarms a minute are to be expected, over all channels and both signs.

    Parameters
    ----------
    per_minute : float
        False alarms a minute, all channels together.
    channels : int
    rate_hz : float
    still_frames : int
        Of how many frames each channel's noise was estimated.

    Raises
    ------
    InputError
        No threshold gives that rate: it is no rate, or too high or too low to be had.

    Examples
    --------
    >>> found = alarm_for(0.1, channels=8, rate_hz=100.0, still_frames=300)
    >>> round(found.threshold, 1), round(found.cap, 1)
    (3.5, 2.9)
    """
    if not (math.isfinite(per_minute) and per_minute > 0):
        raise InputError(f"{per_minute:g} false alarms a minute cannot be had; give a number above zero, such as 0.1")
    wanted = math.log(per_minute / (channels * 60 * rate_hz))
    low, high = _THRESHOLDS
    if not _log_rate(high, still_frames) < wanted < _log_rate(low, still_frames):
        most = math.exp(_log_rate(low, still_frames)) * channels * 60 * rate_hz
        raise InputError(
            f"{per_minute:g} false alarms a minute cannot be promised for {channels} channels at {rate_hz:g} Hz; "
            f"give fewer than {most:.2g}, and not next to none"
        )
    from scipy.optimize import brentq

    threshold = float(brentq(lambda h: _log_rate(h, still_frames) - wanted, low, high, xtol=1e-3))
    return Alarm(threshold, ALLOWANCE + MOST_OF_THRESHOLD * threshold)


def run_length(threshold: float, *, scale: float = 1.0, shift: float = 0.0) -> float:
    """Mean frames to an alarm of a one-sided sum, of readings with mean `shift` and standard deviation `scale`.

    Examples
    --------
    >>> run_length(4.0) > 1e5, run_length(4.0, shift=3.0) < 5
    (True, True)
    """
    from scipy.stats import norm

    width = threshold / (_CELLS - 0.5)
    largest = round(MOST_OF_THRESHOLD * threshold / width)
    steps = np.arange(1 - _CELLS, _CELLS)
    below = norm.cdf(((steps + 0.5) * width + ALLOWANCE - shift) / scale)
    below[steps >= largest] = 1.0  # winsorised: nothing goes farther
    cell = np.arange(_CELLS)
    # The lowest cell takes all that falls below it.
    chain = np.diff(below[cell[None, :] - cell[:, None] + _CELLS - 1], axis=1, prepend=0.0)
    return float(np.linalg.solve(np.eye(_CELLS) - chain, np.ones(_CELLS))[0])


@lru_cache(maxsize=256)
def _log_rate(threshold: float, still_frames: int) -> float:
    """Log of the expected alarms a frame of one channel, both signs, over what its noise may be."""
    normal, weights = np.polynomial.hermite_e.hermegauss(9)
    # An estimated standard deviation is off by this part of it.
    scales = 1 / np.maximum(1 + normal / math.sqrt(2 * (still_frames - 2)), 0.2)
    rates = [2 / run_length(threshold, scale=float(scale)) for scale in scales]
    return math.log(float(np.average(rates, weights=weights)))
