"""What a channel reads at rest: its level and its own noise, or that it was not at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: How long a channel must rest before it is watched, s.
STILL_S = 3.0
#: ... and at least so many frames: a noise known by fewer says little.
STILL_FRAMES = 50
#: No channel's noise is taken for less than this part of its reading, however quiet it is: three times that is what drift and
#: creep do in a second or two, and a tenth of the smallest contact that is of use.
NOISE_FLOOR = 1e-3
#: Noise whose neighbours are correlated by more than this is motion, not noise.
MOST_CORRELATED = 0.8
#: So is noise with a standard deviation this many times what its middle half suggests: something touched it.
MOST_PEAKED = 1.5
#: A standard deviation is this many times the median of absolute deviations, of normal noise.
_MAD = 1.4826


@dataclass(frozen=True)
class Rest:
    """A channel at rest.

    Parameters
    ----------
    level : float
        Its reading, R0 or U0.
    noise : float
        Standard deviation of what sums up: of white noise its own, of correlated noise as much more as sums of it vary more.
    """

    level: float
    noise: float


def at_rest(readings: FloatArray) -> Rest | None:
    """Level and noise of a window of readings, or None where the channel was not at rest in it.

    A straight drift is no motion: it is taken off first. Of correlated noise (a filter in the device, hum) sums vary by
    (1 + r) / (1 - r) times as much as of white noise, with r between neighbours.

    Parameters
    ----------
    readings : (n,) float
        Finite, `STILL_FRAMES` or more.

    Examples
    --------
    >>> noise = np.random.default_rng(0).standard_normal(300)
    >>> found = at_rest(100 + 0.4 * noise)
    >>> round(found.level, 1), round(found.noise, 1)
    (100.0, 0.4)
    >>> at_rest(np.where(np.arange(300) < 200, 100, 140) + 0.4 * noise) is None  # touched meanwhile
    True
    """
    n = len(readings)
    level = float(np.median(readings))
    time = np.arange(n) - (n - 1) / 2
    rest = readings - readings.mean()
    rest = rest - time * (time @ rest) / (time @ time)
    floor = NOISE_FLOOR * abs(level)
    spread = float(np.sqrt(rest @ rest / (n - 2)))
    if spread <= floor:
        return Rest(level, floor) if level else None  # a reading of nothing but 0 has no change to speak of
    correlated = float(rest[1:] @ rest[:-1] / (rest @ rest))
    usual = _MAD * float(np.median(np.abs(rest - np.median(rest))))
    if correlated > MOST_CORRELATED or spread > MOST_PEAKED * max(usual, floor):
        return None
    # Only what two standard errors tell from nothing, or the chance of the window would be taken for colour.
    more = (1 + correlated) / (1 - correlated) if correlated > 2 / np.sqrt(n) else 1.0
    return Rest(level, spread * float(np.sqrt(more))) if level else None
