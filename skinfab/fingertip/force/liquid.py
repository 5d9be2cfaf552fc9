"""Does a held cup hold a liquid? After it was stirred and while the hand keeps still, the lines of a rigid object stay where they are.

A liquid swings at its own frequency: a line in the spectrum of force and moment. Each frequency at which water in a cup may
swing is compared with those about it, so that noise need not be white: a filter, held readings, or a sensor that warms up have
spectra that are smooth there. (A complex Hotelling test of one periodogram ordinate against its neighbours; Giri 1965.)
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
ComplexArray = NDArray[np.complex128]

#: Chance that a rigid object is taken for one with a liquid in it.
FALSE_ALARM = 0.01
#: A block's length, s: a sixth of the period of water that swings in a cup 80 mm wide.
BLOCK_S = 0.05
#: Where water may swing, Hz: sqrt(1.84 g / r) / 2 pi of cups of a radius r from 13 to 200 mm.
BAND_HZ = (1.5, 6.0)
#: A piece of this length, s, is judged by itself: by then a swing has died away.
PIECE_S = 6.0
#: Shorter ones have too few frequencies to compare with.
LEAST_S = 3.0
#: Times are written with so many digits that a log is no longer or shorter than it says by this part of a sample.
PART_OF_A_SAMPLE = 0.01
#: Neighbours to compare with: so far, Hz, and at least so many on both sides together; nearer ones see the swing itself.
_REACH_HZ, _NEIGHBOURS, _GAP_HZ = 3.5, 24, 0.25
#: So many ordinates lose power with the straight line, and tell less than the noise.
_BENT = 2
#: Below this rate, Hz, there are no neighbours above the band.
_LEAST_RATE_HZ = 20.0
#: A rigid object whose lines move slower than water, and by more than noise would once in a million logs, is not held still.
_MOVED = 1e-6
#: Where the noise is taken from that blurs the line's way, Hz.
_ABOVE_HZ = (7.0, 15.0)
#: What such slow movements are compared with, Hz: they hardly show there.
_QUIET_HZ = (3.0, 10.0)
#: Components whose correlations leave less than this part of them free are one and the same.
_SAME = 1e-9


@dataclass(frozen=True, eq=False)
class Stirred:
    """What a held object did after it was stirred.

    Parameters
    ----------
    liquid : bool
        Do its lines swing more than a rigid object's, at a chance of `FALSE_ALARM` to say so wrongly?
    moves : bool
        It does not swing, but moves, slower than a liquid does: a hand that is not still, or a sensor that warms up.
    chance : float
        Of a rigid object that seems to swing as much.
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
    moves: bool
    chance: float
    wander_mm: float
    period_s: float
    time: FloatArray
    path: FloatArray
    pivot: FloatArray

    @property
    def answer(self) -> str:
        """In words."""
        if self.liquid:
            return "liquid"
        return "moves, but does not swing" if self.moves else "solid or empty"


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
        It lasts for less than three seconds, has fewer than 20 samples a second, or nothing is held.

    Examples
    --------
    >>> from skinfab.fingertip.force.liquid_simulator import stir
    >>> stirred(stir(water_kg=0.0, seed=1)).liquid, stirred(stir(water_kg=0.1, seed=1)).liquid
    (False, True)
    """
    lasts = len(log) / log.rate_hz if len(log) > 1 else 0.0
    if not len(log) > LEAST_S * log.rate_hz - PART_OF_A_SAMPLE:
        raise InputError(f"{log.name} lasts for {lasts:.2g} s; hold still for {LEAST_S:g} s or more")
    if not log.rate_hz >= _LEAST_RATE_HZ:
        raise InputError(f"{log.name} has {log.rate_hz:.3g} samples a second; a liquid swings faster: record {_LEAST_RATE_HZ:g} or more")
    width = max(round(BLOCK_S * log.rate_hz), 1)
    count = len(log) // width
    wrench = np.concatenate([log.force, log.moment], axis=1)
    mean = wrench.mean(axis=0)
    if not (np.ptp(wrench, axis=0) > 0).all() or not np.linalg.eigvalsh(np.corrcoef(_steady(wrench).T))[0] > _SAME:
        raise InputError(f"{log.name}: a component never changes, or two are the same; look at the sensor")
    chance, frequency = _swing(wrench, log.rate_hz)
    noise = _noise(wrench, log.rate_hz)
    if not np.linalg.norm(mean[:3]) > 10 * np.sqrt(np.trace(noise[:3, :3]) / len(wrench)):
        raise InputError(f"{log.name}: no weight is felt, so nothing is held; grasp the cup")
    block = wrench[: count * width].reshape(count, width, 6).mean(axis=1)
    time = log.time[: count * width].reshape(count, width).mean(axis=1)
    path, spread = _path(block, mean, noise / width)
    liquid = chance < false_alarm
    pivot = _pivot(block, noise / width) if liquid else np.full(3, np.nan)
    moves = not liquid and _moves(wrench, log.rate_hz)
    return Stirred(liquid, moves, chance, spread, 1 / frequency if liquid else math.nan, time, path, pivot)


def _steady(wrench: FloatArray) -> FloatArray:
    """Less a straight line in time: a sensor's drift is no liquid."""
    trend = np.column_stack([np.ones(len(wrench)), np.linspace(-1, 1, len(wrench))])
    return np.asarray(wrench - trend @ np.linalg.lstsq(trend, wrench, rcond=None)[0])


def _spectrum(wrench: FloatArray, rate_hz: float) -> tuple[ComplexArray, FloatArray]:
    """Of each component, so that white noise has its variance everywhere, and the frequencies."""
    return np.asarray(np.fft.rfft(_steady(wrench), axis=0) / math.sqrt(len(wrench))), np.asarray(np.fft.rfftfreq(len(wrench), 1 / rate_hz))


def _noise(wrench: FloatArray, rate_hz: float) -> FloatArray:
    """Covariance (6, 6) of a sample's noise if it were white and as strong as just above the band."""
    taper = math.sqrt(8 / 3) * np.hanning(len(wrench))[:, None]  # what swings must not leak into it
    spectrum, frequency = np.fft.rfft(taper * _steady(wrench), axis=0) / math.sqrt(len(wrench)), np.fft.rfftfreq(len(wrench), 1 / rate_hz)
    above = spectrum[(frequency >= _ABOVE_HZ[0]) & (frequency <= _ABOVE_HZ[1])]
    return np.asarray((above.T @ above.conj()).real / len(above))


def _swing(wrench: FloatArray, rate_hz: float) -> tuple[float, float]:
    """Chance of the strongest line in the band, and its frequency in Hz."""
    chances, at = [], []
    for piece in np.array_split(wrench, max(int(len(wrench) / rate_hz // PIECE_S), 1)):
        spectrum, frequency = _spectrum(piece, rate_hz)
        step, every = frequency[1], np.arange(len(frequency))
        gap = max(round(_GAP_HZ / step), 1)
        far = gap + max(round(_REACH_HZ / step), _NEIGHBOURS // 2)
        for k in np.flatnonzero((frequency >= BAND_HZ[0]) & (frequency <= BAND_HZ[1])):
            off = np.abs(every - k)
            about = spectrum[(off > gap) & (off <= far) & (every > _BENT)]
            chances.append(_stands_out(spectrum[k], about))
            at.append(float(frequency[k]))
    best = int(np.argmin(chances))
    # Of that many frequencies, which are independent, one as strong by chance.
    chance = -math.expm1(len(chances) * math.log1p(-chances[best])) if chances[best] < 1 else 1.0
    return chance, at[best]


def _stands_out(line: ComplexArray, about: ComplexArray) -> float:
    """Chance of an ordinate (6,) as strong as this where it is but noise like those about it, (k, 6)."""
    from scipy.special import fdtrc

    across = about.T @ about.conj() / len(about)
    square = float((line.conj() @ np.linalg.solve(across, line)).real)
    free = len(about) - 5
    return float(fdtrc(12, 2 * free, square * free / (6 * len(about))))


def _moves(wrench: FloatArray, rate_hz: float) -> bool:
    """Is there more below the band than noise would make?"""
    spectrum, frequency = _spectrum(wrench, rate_hz)
    about = spectrum[(frequency >= _QUIET_HZ[0]) & (frequency <= _QUIET_HZ[1])]
    slow = spectrum[(frequency > 0) & (frequency < BAND_HZ[0])]
    return min(_stands_out(line, about) for line in slow) * len(slow) < _MOVED


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


def _pivot(block: FloatArray, noise: FloatArray) -> FloatArray:
    """Where the liquid's force acts, if it turns enough to tell; what keeps still beside it is an offset of the moment."""
    try:
        found = centre_of_gravity(block[:, :3], block[:, 3:], noise)
    except RefusedError:
        return np.full(3, np.nan)
    return found.point if found.sd_mm < WORST_SD_MM else np.full(3, np.nan)
