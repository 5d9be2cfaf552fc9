"""What a channel reads at rest: its level and its own noise, or that it was not at rest; and how one that has frozen is told by that."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: How long a channel must rest before it is watched, s.
STILL_S = 3.0
#: ... and at least so many frames: a noise known by fewer says little.
STILL_FRAMES = 50
#: A window that was not at rest is tried again after half of it. After a sixth rest would be found sooner still, and more often
#: in the tail of a touch: false alarms go from 0.17 to 0.28 a minute where a log begins in the hand.
AGAIN = 2
#: No channel's noise is taken for less than this part of its reading, however quiet it is: three times that is what drift and
#: creep do in a second or two, and a tenth of the smallest contact that is of use.
NOISE_FLOOR = 1e-3
#: Noise whose neighbours are correlated by more than this is motion, not noise.
MOST_CORRELATED = 0.8
#: So is noise with a standard deviation this many times what its middle half suggests: something touched it.
MOST_PEAKED = 1.5
#: And what bends by more than this many of its own standard errors: silicone that creeps back from a touch, or a press begun.
MOST_BENT = 4.0
#: A channel is frozen where it moves by less than this part of its noise: a converter may flicker at the end of its range ...
FROZEN_PART = 0.1
#: ... for at least this long, s, and so many frames, ...
FROZEN_S, FROZEN_FRAMES = 1.0, 20
#: ... and for as long as its noise would leave it there with this chance a frame, and so many times as long as it did at rest.
FROZEN_CHANCE, FROZEN_TIMES = 1e-9, 5
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
    spread : float
        Standard deviation of its readings about a straight drift, however small.
    correlated : float
        Their correlation from one frame to the next.
    """

    level: float
    noise: float
    spread: float
    correlated: float


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
    power = float(rest @ rest)
    # Of equal readings rounding leaves a little.
    spread = math.sqrt(power / (n - 2)) if np.ptp(readings) else 0.0
    correlated = float(rest[1:] @ rest[:-1]) / power if spread else 0.0
    if not level:
        return None  # a reading of nothing but 0 has no change to speak of
    if spread <= floor:
        return Rest(level, floor, spread, correlated)
    usual = _MAD * float(np.median(np.abs(rest - np.median(rest))))
    # Behind a coarse converter most readings are one, and the middle half suggests no noise at all.
    if correlated > MOST_CORRELATED or spread > MOST_PEAKED * max(usual, floor, _step(readings) / 2):
        return None
    # Only what two standard errors tell from nothing, or the chance of the window would be taken for colour.
    more = (1 + correlated) / (1 - correlated) if correlated > 2 / np.sqrt(n) else 1.0
    noise = spread * float(np.sqrt(more))
    bend = time**2 - (time @ time) / n
    if abs(bend @ rest) > MOST_BENT * noise * math.sqrt(float(bend @ bend)):
        return None
    return Rest(level, noise, spread, correlated)


@dataclass(frozen=True)
class Patience:
    """When a channel has frozen: where it stays within `within` of one value for more than so many frames."""

    within: float
    frames: float


def patience(readings: FloatArray, rest: Rest, *, rate_hz: float) -> Patience:
    """How long a channel may read one value, by what it did at rest.

    The coarser its converter is beside its noise, the longer: the worst level is the middle of a step, and there a reading
    leaves the step only where its noise is half a step. Correlated noise stays longer by as much as its sums vary more.

    Parameters
    ----------
    readings : (n,) float
        At rest.
    rest : Rest
        What `at_rest` says of them.
    rate_hz : float

    Examples
    --------
    >>> noise = np.random.default_rng(0).standard_normal(300)
    >>> for step in (0.01, 0.8):  # a fine converter, and a coarse one
    ...     readings = np.round((100 + 0.4 * noise) / step) * step
    ...     print(f"{patience(readings, at_rest(readings), rate_hz=100.0).frames:.0f}")
    100
    205
    """
    if not rest.spread:
        return Patience(0.0, math.inf)
    step, within = _step(readings), FROZEN_PART * rest.spread
    # Between two steps a converter flickers by half a step, however quiet the channel is: what is more is its own noise.
    own = math.sqrt(max(rest.spread**2 - (step / 2) ** 2, 0.0))
    stays = math.erf((within + step / 2) / own / math.sqrt(2)) if own else 1.0
    together = (1 + rest.correlated) / max(1 - rest.correlated, 1e-3) if rest.correlated > 0 else 1.0
    unlikely = math.log(FROZEN_CHANCE) / math.log(stays) * together if stays < 1 else math.inf
    moves = np.flatnonzero(np.abs(np.diff(readings)) > within)
    longest = float(np.diff(np.concatenate([[-1], moves, [len(readings) - 1]])).max())
    return Patience(within, max(unlikely, FROZEN_TIMES * longest, FROZEN_S * rate_hz, FROZEN_FRAMES))


def _step(readings: FloatArray) -> float:
    """The least by which readings differ that do."""
    return float(np.diff(np.unique(readings)).min())
