"""The nail's vibration as phasors: amplitude and phase of each channel at the motor's frequency and at twice that.

A lock-in by least squares: constant, cosine and sine at the drive and at its second harmonic are fitted to each channel, so that any
window will do from eight readings on, a whole number of turns or not, and readings that are missing or saturated are left out.
The motor's frequency is found in the data. Its phase is nobody's choice, so phasors are turned until the six together lie as those of a
reference do; then only what the finger does is left of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
BoolArray = NDArray[np.bool_]

#: Readings a window needs: five unknowns a channel and something to judge the fit by.
SHORTEST = 8
#: Where the motor's frequency is looked for, Hz: half and twice the paper's 169 Hz, without the harmonics of hand tremor (10 Hz).
BAND_HZ = (80.0, 340.0)
#: A sine whose frequency is to be found needs some turns: at 169 Hz and 1.4 kHz these are eight.
FIND_SHORTEST = 64
#: Smallest eigenvalue of the normal equations, as a part of the readings, with which the harmonic can still be told from the drive;
#: below it (at a third or a quarter of the sampling rate, or with too few readings) the drive alone is fitted.
_TOLD_APART = 1e-3
#: The spectrum is read this finely before the frequency is refined: a quarter of a bin leaves half the main lobe's top.
_FINER = 4
#: The refinement ends where it moves the frequency by less, Hz: a hundredth of a turn in the longest window.
_SETTLED_HZ = 0.01


@dataclass(frozen=True, eq=False)
class Phasors:
    """Of n windows.

    Parameters
    ----------
    drive : (n, 6) complex
        The reading is the real part of ``drive exp(2 pi i f t)``, t from the middle of the window; NaN for a channel without enough readings.
    harmonic : (n, 6) complex
        The same at 2 f; 0 where it cannot be told from the drive.
    noise : (n, 6) float
        Root mean square of what the fit leaves.
    drive_hz : (n,) float
    """

    drive: ComplexArray
    harmonic: ComplexArray
    noise: FloatArray
    drive_hz: FloatArray

    def __len__(self) -> int:
        return len(self.drive)


def find_drive(values: FloatArray, rate_hz: float, *, band_hz: tuple[float, float] = BAND_HZ) -> FloatArray:
    """The motor's frequency in each window.

    Channels count by their own scale, so that units do not matter. From the top of their common spectrum it is refined by how far the
    phase advances from the first half of the window to the second.

    Parameters
    ----------
    values : (n, samples, channels) float
        NaN where a reading is missing.
    rate_hz : float
    band_hz : (low, high)

    Returns
    -------
    (n,) float, Hz
        NaN where nothing at all vibrates.

    Raises
    ------
    InputError
        A window is shorter than `FIND_SHORTEST`, or the band is not below half the sampling rate.

    Examples
    --------
    >>> time = np.arange(256) / 1400
    >>> one = np.cos(2 * np.pi * 171.3 * time)[None, :, None]
    >>> round(float(find_drive(one, 1400.0)[0]), 2)
    171.3
    """
    n, samples, _ = values.shape
    if samples < FIND_SHORTEST:
        raise InputError(f"{samples} readings are too few to find the motor's frequency in; {FIND_SHORTEST} are needed")
    low, high = band_hz[0], min(band_hz[1], 0.48 * rate_hz)
    if not low < high:
        raise InputError(f"{rate_hz:g} readings a second are too few for a motor of {low:g} Hz and more; sample faster")
    there = np.isfinite(values)
    count = there.sum(axis=1, keepdims=True)
    mean = np.where(there, values, 0.0).sum(axis=1, keepdims=True) / np.maximum(count, 1)
    moved = np.where(there, values - mean, 0.0)
    scale = np.sqrt((moved**2).sum(axis=1, keepdims=True) / np.maximum(count, 1))
    moved = np.divide(moved, scale, out=np.zeros_like(moved), where=scale > 0)
    size = _FINER * samples
    power = (np.abs(np.fft.rfft(moved * np.hanning(samples)[:, None], n=size, axis=1)) ** 2).sum(axis=2)
    frequency = np.fft.rfftfreq(size, 1 / rate_hz)
    power[:, (frequency < low) | (frequency > high)] = 0.0
    found = frequency[power.argmax(axis=1)]
    time = np.arange(samples) / rate_hz
    half = samples // 2
    apart = (samples - half) / rate_hz
    for _ in range(6):
        turned = moved * np.exp(-2j * math.pi * found[:, None] * time)[..., None]
        # A window over each half, so that the constant and the other frequencies stay out.
        shape = np.hanning(half + 2)[1:-1, None]
        first, second = (turned[:, :half] * shape).sum(axis=1), (turned[:, samples - half :] * shape).sum(axis=1)
        step = np.angle((second * first.conj()).sum(axis=1)) / (2 * math.pi * apart)
        found = np.clip(found + step, low, high)
        if np.abs(step).max() < _SETTLED_HZ:
            break
    out: FloatArray = np.where(power.max(axis=1) > 0, found, np.nan)
    return out


def lock_in(values: FloatArray, rate_hz: float, drive_hz: float | FloatArray) -> Phasors:
    """Phasors of windows at a known frequency.

    Parameters
    ----------
    values : (n, samples, 6) float
        NaN where a reading is missing or saturated.
    rate_hz : float
    drive_hz : float or (n,) float

    Raises
    ------
    InputError
        A window is shorter than `SHORTEST`.

    Examples
    --------
    >>> time = (np.arange(20) - 9.5) / 1400
    >>> wave = 3 + 2 * np.cos(2 * np.pi * 169 * time + 0.5) + 0.3 * np.sin(2 * np.pi * 338 * time)
    >>> found = lock_in(np.repeat(wave[None, :, None], 6, axis=2), 1400.0, 169.0)
    >>> np.round([abs(found.drive[0, 0]), np.angle(found.drive[0, 0]), abs(found.harmonic[0, 0])], 6).tolist()
    [2.0, 0.5, 0.3]
    """
    values = np.asarray(values, dtype=float)
    n, samples, channels = values.shape
    if samples < SHORTEST:
        raise InputError(f"a window of {samples} readings is too short; {SHORTEST} are needed")
    drive = np.broadcast_to(np.asarray(drive_hz, dtype=float), (n,))
    turn = np.exp(2j * math.pi * drive[:, None] * ((np.arange(samples) - (samples - 1) / 2) / rate_hz))
    A = np.stack([np.ones((n, samples)), turn.real, -turn.imag, (turn**2).real, -(turn**2).imag], axis=2)
    there = np.isfinite(values)
    if there.all():
        normal = A.transpose(0, 2, 1) @ A
        right = A.transpose(0, 2, 1) @ values
        told = np.linalg.eigvalsh(normal)[:, 0] > _TOLD_APART * samples
        x = np.zeros((n, 5, channels))
        x[told] = np.linalg.solve(normal[told], right[told])
        if not told.all():
            x[~told, :3] = np.linalg.solve(normal[~told, :3, :3], right[~told, :3])
        left = samples - np.where(told, 5, 3)[:, None]
        rest = values - A @ x
    else:
        x, left = _with_gaps(A, values, there)
        rest = np.where(there, values - A @ x, 0.0)
    noise = np.sqrt((rest**2).sum(axis=1) / np.maximum(left, 1))
    return Phasors(x[:, 1] + 1j * x[:, 2], x[:, 3] + 1j * x[:, 4], noise, drive)


def _with_gaps(A: FloatArray, values: FloatArray, there: BoolArray) -> tuple[FloatArray, FloatArray]:
    """As the plain fit, channel by channel with the readings that each has: unknowns (n, 5, c), readings to spare (n, c)."""
    n, _, channels = values.shape
    x = np.full((n, 5, channels), np.nan)
    left = np.zeros((n, channels))
    known = np.where(there, values, 0.0)
    for k in range(channels):
        weighted = A * there[:, :, k, None]
        normal = weighted.transpose(0, 2, 1) @ A
        right = weighted.transpose(0, 2, 1) @ known[:, :, k, None]
        count = there[:, :, k].sum(axis=1)
        told = (count >= SHORTEST) & (np.linalg.eigvalsh(normal)[:, 0] > _TOLD_APART * count)
        plain = ~told & (count >= 4) & (np.linalg.eigvalsh(normal[:, :3, :3])[:, 0] > _TOLD_APART * count)
        x[told, :, k] = np.linalg.solve(normal[told], right[told])[..., 0]
        x[plain, :3, k] = np.linalg.solve(normal[plain, :3, :3], right[plain, :3])[..., 0]
        x[plain, 3:, k] = 0.0
        left[:, k] = count - np.where(told, 5, 3)
    return x, left
