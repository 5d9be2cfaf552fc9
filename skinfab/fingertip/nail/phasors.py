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
#: Longer windows are cut into blocks of so many readings, each turned for itself (15 turns of the paper's motor): what the motor's speed
#: drifts within 91 ms does not matter.
BLOCK = 128
#: The spectrum is read this finely before the frequency is refined: a quarter of a bin leaves half the main lobe's top.
_FINER = 4
#: The refinement ends where it moves the frequency by less, Hz: a hundredth of a turn in the longest window.
_SETTLED_HZ = 0.01
#: The drive's power over the noise's from which on the motor turns (see `turns`).
_STANDS_OUT = 15.0


@dataclass(frozen=True, eq=False)
class Phasors:
    """Of n windows.

    Parameters
    ----------
    drive : (n, 6) complex
        The reading is the real part of ``drive exp(2 pi i f t)``, t from the middle of the window; NaN for a channel without
        enough readings.
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


def find_drive(values: FloatArray, rate_hz: float) -> FloatArray:
    """The motor's frequency in each window.

    Channels count by their own scale, so that units do not matter. From the top of their common spectrum it is refined by how far the
    phase advances from the first half of the window to the second.

    Parameters
    ----------
    values : (n, samples, channels) float
        NaN where a reading is missing.
    rate_hz : float

    Returns
    -------
    (n,) float, Hz
        NaN where no frequency stands out of the noise: the motor does not turn.

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
    samples = values.shape[1]
    if samples < FIND_SHORTEST:
        raise InputError(f"{samples} readings are too few to find the motor's frequency in; {FIND_SHORTEST} are needed")
    low, high = BAND_HZ[0], min(BAND_HZ[1], 0.48 * rate_hz)
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
    out: FloatArray = np.where((power.max(axis=1) > 0) & turns(values, rate_hz, found), found, np.nan)
    return out


def turns(values: FloatArray, rate_hz: float, drive_hz: float | FloatArray) -> BoolArray:
    """Does the vibration at a frequency stand out of the noise of windows (n, samples, channels)? (n,)

    Of white noise, the power that a lock-in finds over that which the noise puts there is 1 in the mean, and 4 at most where the
    frequency was sought in it (64 readings, 2000 windows); of a motor in ten times the noise of a sensor it is 180.

    Examples
    --------
    >>> noise = np.random.default_rng(0).standard_normal((2, 64, 6))
    >>> noise[1] += 2 * np.cos(2 * np.pi * 169 * np.arange(64) / 1400)[:, None]
    >>> turns(noise, 1400.0, 169.0).tolist()
    [False, True]
    """
    blocks = blocks_of(values)
    n, count, length, _ = blocks.shape
    hz = np.repeat(np.broadcast_to(drive_hz, (n,)), count)
    found = lock_in(blocks.reshape(n * count, *blocks.shape[2:]), rate_hz, hz)
    power, noise = np.abs(found.drive) ** 2, 4 * found.noise**2 / length
    ratio = np.divide(power, noise, out=np.where(power > 0, math.inf, 0.0), where=noise > 0).reshape(n, -1)
    told = np.isfinite(power).reshape(n, -1)
    out: BoolArray = np.where(told, ratio, 0.0).sum(axis=1) > _STANDS_OUT * np.maximum(told.sum(axis=1), 1)
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
    """As the plain fit, each channel with the readings that it has: unknowns (n, 5, c), readings to spare (n, c)."""
    mask = there.swapaxes(1, 2)
    kept = A[:, None] * mask[..., None]
    normal = kept.swapaxes(2, 3) @ A[:, None]
    right = kept.swapaxes(2, 3) @ np.where(there, values, 0.0).swapaxes(1, 2)[..., None]
    count = mask.sum(axis=2)
    told = (count >= SHORTEST) & (np.linalg.eigvalsh(normal)[..., 0] > _TOLD_APART * count)
    x = np.full((*mask.shape[:2], 5), np.nan)
    x[told] = np.linalg.solve(normal[told], right[told])[..., 0]
    if not told.all():
        plain = ~told & (count >= 4) & (np.linalg.eigvalsh(normal[..., :3, :3])[..., 0] > _TOLD_APART * count)
        x[plain, :3] = np.linalg.solve(normal[plain][:, :3, :3], right[plain][:, :3])[..., 0]
        x[plain, 3:] = 0.0
    return x.swapaxes(1, 2), count - np.where(told, 5, 3)


def reference_of(drive: ComplexArray) -> ComplexArray:
    """What phasors are turned to: the direction that the given ones have in common, (n, 6) to (6,).

    Channels count by their own size, so that units do not matter; a channel without readings counts nothing.

    Examples
    --------
    >>> drive = np.exp(1j * np.array([[0.3], [2.0]])) * np.arange(1, 7)
    >>> reference = reference_of(drive)
    >>> np.ptp(np.angle(drive @ reference.conj() / np.exp(1j * np.array([0.3, 2.0])))).round(9)
    np.float64(0.0)
    """
    known = np.nan_to_num(drive)
    size = np.sqrt((np.abs(known) ** 2).mean(axis=0))
    unit = np.divide(known, size, out=np.zeros_like(known), where=size > 0)
    values, vectors = np.linalg.eigh(unit.T @ unit.conj())
    common: ComplexArray = np.divide(vectors[:, values.argmax()], size, out=np.zeros(len(size), dtype=complex), where=size > 0)
    return common


def turned(drive: ComplexArray, reference: ComplexArray) -> ComplexArray:
    """Phasors (..., 6) without the motor's phase: turned so that they lie along the reference as nearly as they can."""
    along = (np.nan_to_num(drive) * reference.conj()).sum(axis=-1, keepdims=True)
    size = np.abs(along)
    out: ComplexArray = drive * np.divide(along.conj(), size, out=np.ones_like(along), where=size > 0)
    return out


def blocks_of(values: FloatArray) -> FloatArray:
    """Windows (n, samples, 6) cut into blocks of equal length near `BLOCK`, (n, blocks, length, 6); the rest is left out.

    Examples
    --------
    >>> blocks_of(np.zeros((2, 1024, 6))).shape, blocks_of(np.zeros((2, 33, 6))).shape
    ((2, 8, 128, 6), (2, 1, 33, 6))
    """
    n, samples, channels = values.shape
    count = max(samples // BLOCK, 1)
    length = samples // count
    return values[:, : count * length].reshape(n, count, length, channels)


def turned_phasors(
    values: FloatArray, rate_hz: float, drive_hz: float | FloatArray, reference: ComplexArray
) -> tuple[ComplexArray, FloatArray]:
    """Phasors of windows, block by block, turned to a reference and averaged; and the noise of a reading.

    Returns
    -------
    drive : (n, 6) complex
        NaN for a channel that no block of the window has enough readings of.
    noise : (n, 6) float
    """
    blocks = blocks_of(values)
    n, count = blocks.shape[:2]
    found = lock_in(blocks.reshape(n * count, *blocks.shape[2:]), rate_hz, np.repeat(np.broadcast_to(drive_hz, (n,)), count))
    each, noise = turned(found.drive, reference).reshape(n, count, -1), found.noise.reshape(n, count, -1)
    if count == 1:
        return each[:, 0], noise[:, 0]
    there = np.isfinite(each)
    of = there.sum(axis=1)
    mean = np.divide(np.where(there, each, 0.0).sum(axis=1), of, out=np.full((n, each.shape[2]), np.nan + 0j), where=of > 0)
    rms = np.sqrt(np.divide(np.where(there, noise**2, 0.0).sum(axis=1), of, out=np.full(of.shape, np.nan), where=of > 0))
    return mean, rms


def lock_in_weights(samples: int, rate_hz: float, drive_hz: float) -> ComplexArray:
    """Weights w (samples,) with which ``w @ values`` is the phasor at the drive that `lock_in` fits to whole windows.

    Raises
    ------
    InputError
        A window is shorter than `SHORTEST`.

    Examples
    --------
    >>> values = np.random.default_rng(0).standard_normal((33, 6))
    >>> bool(np.allclose(lock_in_weights(33, 1400.0, 169.0) @ values, lock_in(values[None], 1400.0, 169.0).drive[0]))
    True
    """
    # The fit is linear in the readings, so its answers to the unit readings are its weights.
    fitted = lock_in(np.eye(samples)[None], rate_hz, drive_hz)
    return fitted.drive[0]
