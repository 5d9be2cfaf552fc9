"""Does a held cup hold a liquid? After it was stirred and while the hand keeps still, the lines of a rigid object stay where they are.

Force and moment are compared with what they would be of a rigid object: constant but for white noise and a drift along a
straight line. The noise is taken from the differences of samples that follow one another, in which a liquid that swings a few
times a second hardly shows; the statistic is the variance of means over short blocks, in units of that noise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import WORST_SD_MM, centre_of_gravity, lines
from skinfab.fingertip.force.logs import WrenchLog

FloatArray = NDArray[np.float64]

#: Chance that a rigid object is taken for one with a liquid in it.
FALSE_ALARM = 0.01
#: A block's length, s: a sixth of the period of water that swings in a cup 80 mm wide.
BLOCK_S = 0.05
#: Fewest blocks: two seconds.
_BLOCKS = 40


@dataclass(frozen=True, eq=False)
class Stirred:
    """What a held object did after it was stirred.

    Parameters
    ----------
    liquid : bool
        Do its lines move more than a rigid object's, at a chance of `FALSE_ALARM` to say so wrongly?
    chance : float
        Of a rigid object that seems to move as much.
    wander_mm : float
        Root mean square of the lines' sideways movement, less what the noise makes of it.
    period_s : float
        Of the strongest swing; NaN where it is rigid.
    time : (k,) float, s
        Of the blocks.
    path : (k, 3) float, mm
        Where each block's line passes the plane through the mean one's nearest point to the origin.
    pivot : (3,) float, mm
        Through which the force that changes acts: of a pendulum, where it hangs; NaN where that is not known to some millimetres.
    """

    liquid: bool
    chance: float
    wander_mm: float
    period_s: float
    time: FloatArray
    path: FloatArray
    pivot: FloatArray


def stirred(log: WrenchLog, *, false_alarm: float = FALSE_ALARM) -> Stirred:
    """Judge a log that begins after the stick was taken out, in one pose.

    Parameters
    ----------
    log : WrenchLog
        Force and moment of the whole hand.
    false_alarm : float

    Raises
    ------
    InputError
        It lasts for less than two seconds, or nothing is held.

    Examples
    --------
    >>> from skinfab.fingertip.force.liquid_simulator import stir
    >>> stirred(stir(water_kg=0.0, seed=1)).liquid, stirred(stir(water_kg=0.1, seed=1)).liquid
    (False, True)
    """
    width = max(round(BLOCK_S * log.rate_hz), 2) if len(log) > 1 else 2
    count = len(log) // width
    if count < _BLOCKS:
        raise InputError(f"{log.name} lasts for {len(log) / log.rate_hz if len(log) > 1 else 0:.2g} s; hold still for 2 s or more")
    wrench = np.concatenate([log.force, log.moment], axis=1)[: count * width]
    noise = np.diff(wrench, axis=0).T @ np.diff(wrench, axis=0) / (2 * (len(wrench) - 1))
    if not np.linalg.eigvalsh(noise)[0] > 0:
        raise InputError(f"{log.name}: a component never changes, or two are the same; look at the sensor")
    mean = wrench.mean(axis=0)
    if not np.linalg.norm(mean[:3]) > 10 * np.sqrt(np.trace(noise[:3, :3]) / len(wrench)):
        raise InputError(f"{log.name}: no weight is felt, so nothing is held; grasp the cup")
    block = wrench.reshape(count, width, 6).mean(axis=1)
    time = log.time[: count * width].reshape(count, width).mean(axis=1)
    # A sensor that warms up drifts: a straight line in time is no liquid.
    trend = np.column_stack([np.ones(count), time - time.mean()])
    steady = block - trend @ np.linalg.lstsq(trend, block, rcond=None)[0]
    free = 6 * (count - 2)
    square = float(np.einsum("ki,ij,kj->", steady, np.linalg.inv(noise / width), steady))
    from scipy.stats import f

    # The noise is an estimate too, from differences that overlap: 2/3 as good as as many independent ones. The mean of such an
    # estimate's inverse is too large by known / (known - 7), six components being estimated together.
    known = (len(wrench) - 1) * 2 / 3
    chance = float(f.sf(square / free * (known - 7) / known, free, 6 * known))
    path, spread = _path(block, mean, noise / width)
    liquid = chance < false_alarm
    period = _period(steady, np.diag(noise), 1 / float(time[1] - time[0])) if liquid else float("nan")
    pivot = _pivot(block, noise / width) if liquid else np.full(3, np.nan)
    return Stirred(liquid, chance, spread, period, time, path, pivot)


def _path(block: FloatArray, mean: FloatArray, noise: FloatArray) -> tuple[FloatArray, float]:
    """Where the blocks' lines cut a plane across the mean one, and how far they wander beyond what noise does."""
    q, g = lines(block[:, :3], block[:, 3:])
    (middle,), (axis,) = lines(mean[None, :3], mean[None, 3:])
    path = q + ((middle - q) @ axis / (g @ axis))[:, None] * g
    F = mean[:3]
    size = np.linalg.norm(F)
    # A change of the moment moves the line by dM / |F|; that of the force matters less near the plane.
    across = np.eye(3) - np.outer(axis, axis)
    by_noise = float(np.trace(across @ noise[3:, 3:] @ across) / size**2)
    wander = float(((path - path.mean(axis=0)) ** 2).sum(axis=1).mean())
    return path, math.sqrt(max(wander - by_noise, 0.0))


def _period(steady: FloatArray, noise: FloatArray, rate_hz: float) -> float:
    """Of the strongest swing of all components together, each in units of its noise."""
    power = (np.abs(np.fft.rfft(steady, axis=0)) ** 2 / noise).sum(axis=1)
    k = int(power[1:].argmax()) + 1
    return len(steady) / (k * rate_hz)


def _pivot(block: FloatArray, noise: FloatArray) -> FloatArray:
    """Where the liquid's force acts, if it turns enough to tell; what keeps still beside it is an offset of the moment."""
    try:
        found = centre_of_gravity(block[:, :3], block[:, 3:], noise)
    except RefusedError:
        return np.full(3, np.nan)
    return found.point if found.sd_mm < WORST_SD_MM else np.full(3, np.nan)
