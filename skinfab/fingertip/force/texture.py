"""What a surface feels like while the fingertip slides over it: its features as published, and better ones.

Published ("Machine Learning-Enhanced Fingertip Tactile Sensing", section 4): the three strongest peaks below 10 Hz in the
spectrum of 512 samples of the tangential force, and the largest, least and mean inclination. Here: the tangential force is
divided by the normal force (what the load does falls out), its spectrum is that of Hann windows that overlap by half,
peaks stand where a parabola through their logarithms has its top, and features are the logarithms of the power in bands.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.contact import LEAST_FORCE_N, Hemisphere, locate
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise, require_nmm
from skinfab.readout.filters import Lowpass

FloatArray = NDArray[np.float64]

#: The paper's: samples of a spectrum (its frequencies lie on steps of 0.39 Hz at 200 Hz), the highest frequency, peaks.
N_FFT, TOP_HZ, PEAKS = 512, 10.0, 3

#: Bands of the improved features, Hz: as wide as they are high by octaves, from what a spectrum of 2.6 s tells apart to what is
#: left below half the paper's sampling rate.
BANDS_HZ = tuple(float(each) for each in np.geomspace(0.6, 80.0, 17))

#: Where the mean inclination over so long, s, is above this part of its upper values, the finger slides; at rest friction is not
#: used up. What is left at each end is not looked at: there it begins or stops.
_SMOOTH_S, _SLIDES, _EDGE_S = 1.0, 0.5, 0.25


@dataclass(frozen=True, eq=False)
class Slide:
    """The part of a log in which the finger slides, without the sensor's offset.

    Parameters
    ----------
    tangential : (n,) float, N
        Along the direction of the pull.
    normal : (n,) float, N
        Along the contact's inward normal.
    inclination : (n,) float, rad
        Between force and normal; of the force below 10 Hz, since the paper's extremes are less than the sensor's noise spans.
    rate_hz : float
    noise_n : float
        Standard deviation of a force's sample while nothing is touched; 0 where that is not known.
    notes : tuple of str
    """

    tangential: FloatArray
    normal: FloatArray
    inclination: FloatArray
    rate_hz: float
    noise_n: float = 0.0
    notes: tuple[str, ...] = ()

    @property
    def ratio(self) -> FloatArray:
        """Tangential by mean normal force: what is left when the load falls out."""
        return self.tangential / self.normal.mean()


def sliding_part(log: WrenchLog, surface: Hemisphere | None = None) -> Slide:
    """Find where the finger slides; where it is free at the beginning, the sensor's offset is taken off.

    Parameters
    ----------
    log : WrenchLog
    surface : Hemisphere, optional
        The fingertip, of which the contact's normal is.

    Raises
    ------
    InputError
        The log is too short or sampled too slowly, nothing is touched, nothing slides, or moments seem to be in N m.
    """
    rate = log.rate_hz
    if not rate >= 2 * TOP_HZ * 1.25:
        raise InputError(f"{log.name} has {rate:.4g} samples a second; a texture needs {2.5 * TOP_HZ:g} or more")
    force, moment, noise_n, notes = _without_offset(log)
    low = Lowpass(TOP_HZ, rate)
    if len(log) < low.shortest + 2 * round(_SMOOTH_S * rate):
        raise InputError(f"{log.name} has {len(log)} samples, {len(log) / rate:.2g} s; slide over the material for seconds")
    slow = low.zero_phase(force)
    touching = np.linalg.norm(slow, axis=1) > LEAST_FORCE_N
    if not touching.any():
        raise InputError(f"{log.name}: nothing presses with {LEAST_FORCE_N:g} N; press the finger on the material")
    normal = locate(force[touching].mean(axis=0)[None], moment[touching].mean(axis=0)[None], surface).normal[0]
    along = slow @ normal
    inclination = np.arctan2(np.linalg.norm(slow - along[:, None] * normal, axis=1), along)
    sliding = _slides(inclination, touching, round(_SMOOTH_S * rate))
    if not sliding.any():
        raise InputError(f"{log.name}: there is no tangential force; pull the material along")
    if not log.units_said:
        require_nmm(slow[touching], low.zero_phase(moment)[touching], reach_mm=RADIUS_MM, least_force=LEAST_FORCE_N, where=log.name)
    start, end = _longest(sliding)
    edge = round(_EDGE_S * rate)
    start, end = start + edge, end - edge
    if end - start < round(_SMOOTH_S * rate):
        raise InputError(f"{log.name}: the finger slides for less than {_SMOOTH_S:g} s; pull the material along for longer")
    part = slice(start, end)
    pull = force[part].mean(axis=0)
    pull -= (pull @ normal) * normal
    return Slide(force[part] @ (pull / np.linalg.norm(pull)), force[part] @ normal, inclination[part], rate, noise_n, notes)


def _without_offset(log: WrenchLog) -> tuple[FloatArray, FloatArray, float, tuple[str, ...]]:
    """Forces and moments, less what the sensor read before it was touched; and the noise that it had then."""
    free = max(round(0.2 * log.rate_hz), 4)
    head = log.force[:free]
    size = np.linalg.norm(head.mean(axis=0))
    if len(log) <= free or size > LEAST_FORCE_N or np.ptp(head, axis=0).max() > LEAST_FORCE_N:
        return (
            log.force,
            log.moment,
            0.0,
            (f"{log.name} does not begin without load, so the sensor's offset is not known and not taken off",),
        )
    return log.force - head.mean(axis=0), log.moment - log.moment[:free].mean(axis=0), float(head.std(axis=0, ddof=1).mean()), ()


def _slides(inclination: FloatArray, touching: NDArray[np.bool_], width: int) -> NDArray[np.bool_]:
    weights = np.where(touching, 1.0, 0.0)
    kernel = np.ones(width)
    count = np.convolve(weights, kernel, mode="same")
    mean = np.convolve(np.where(touching, inclination, 0.0), kernel, mode="same") / np.maximum(count, 1.0)
    upper = float(np.quantile(mean[touching], 0.9))
    out: NDArray[np.bool_] = touching & (mean > _SLIDES * upper)
    return out


def _longest(flags: NDArray[np.bool_]) -> tuple[int, int]:
    """Start and end of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    starts, ends = edges[::2], edges[1::2]
    k = int(np.argmax(ends - starts))
    return int(starts[k]), int(ends[k])


@dataclass(frozen=True, eq=False)
class Peaks:
    """The most prominent frequencies, ascending.

    Parameters
    ----------
    frequency : (k,) float, Hz
    magnitude : (k,) float
        In the signal's unit; as published |X| / N, half of a sine's amplitude.
    """

    frequency: FloatArray
    magnitude: FloatArray


def published_peaks(signal: FloatArray, rate_hz: float, *, n_fft: int = N_FFT, count: int = PEAKS) -> Peaks:
    """The `count` highest maxima below 10 Hz in the spectrum of the first `n_fft` samples, as published: no window, on the grid.

    Raises
    ------
    InputError
        There are fewer samples.

    Examples
    --------
    >>> time = np.arange(512) / 200
    >>> published_peaks(0.05 * np.sin(2 * np.pi * 7.0 * time), 200.0, count=1).frequency.round(2).tolist()
    [7.03]
    """
    piece = _first(signal, n_fft)
    size = np.abs(np.fft.rfft(piece - piece.mean())) / n_fft
    at = _maxima(size, int(TOP_HZ * n_fft / rate_hz), count)
    return Peaks(at * rate_hz / n_fft, size[at])


def interpolated_peaks(signal: FloatArray, rate_hz: float, *, n_fft: int = N_FFT, count: int = PEAKS) -> Peaks:
    """As `published_peaks`, with a Hann window and the top of the parabola through the logarithms of three neighbours.

    Examples
    --------
    >>> time = np.arange(512) / 200
    >>> found = interpolated_peaks(0.05 * np.sin(2 * np.pi * 7.123 * time), 200.0, count=1)
    >>> found.frequency.round(2).tolist(), found.magnitude.round(3).tolist()
    ([7.13], [0.025])
    """
    piece = _first(signal, n_fft)
    window = np.hanning(n_fft + 1)[:-1]
    size = np.abs(np.fft.rfft((piece - piece.mean()) * window)) / window.sum()
    at = _maxima(size, int(TOP_HZ * n_fft / rate_hz), count, lowest=2)
    a, b, c = np.log(np.maximum(size[[at - 1, at, at + 1]], np.finfo(float).tiny))
    bend = a - 2 * b + c
    aside = np.divide(0.5 * (a - c), bend, out=np.zeros(len(at)), where=bend < 0)
    return Peaks((at + aside) * rate_hz / n_fft, np.exp(b - 0.25 * (a - c) * aside))


def _first(signal: FloatArray, n_fft: int) -> FloatArray:
    if len(signal) < n_fft:
        raise InputError(f"a spectrum of {n_fft} samples was asked for, and the finger slides for {len(signal)} only; slide for longer")
    return signal[:n_fft]


def _maxima(size: FloatArray, top: int, count: int, *, lowest: int = 1) -> NDArray[np.int64]:
    """The `count` highest inner maxima up to bin `top`, ascending; the highest bins where there are fewer maxima."""
    inner = np.arange(lowest, min(top, len(size) - 2) + 1)
    peak = (size[inner] >= size[inner - 1]) & (size[inner] > size[inner + 1])
    order = np.lexsort((-size[inner], ~peak))
    return np.sort(inner[order[:count]])


def published_features(slide: Slide, *, n_fft: int = N_FFT) -> FloatArray:
    """Frequencies (Hz) and magnitudes (mN) of the three peaks, and largest, least and mean inclination (degrees): (9,)."""
    peaks = published_peaks(slide.tangential, slide.rate_hz, n_fft=n_fft)
    angle = np.degrees(_first(slide.inclination, n_fft))
    return np.concatenate([peaks.frequency, 1000 * peaks.magnitude, [angle.max(), angle.min(), angle.mean()]])


PUBLISHED_NAMES = (*(f"peak {k} Hz" for k in (1, 2, 3)), *(f"peak {k} mN" for k in (1, 2, 3)), "max deg", "min deg", "mean deg")


def band_features(slide: Slide, *, n_fft: int = N_FFT) -> FloatArray:
    """Logarithms of the friction's power in `BANDS_HZ`, and of its mean and standard deviation below 10 Hz: (18,).

    Logarithms, because specimens of a material differ by parts of what they are.

    All of the slide counts, in Hann windows of `n_fft` samples that overlap by half, or one of all samples where it is shorter.
    Bands above half of the sampling rate, or too narrow for the window, take the power of the nearest frequency below it.
    """
    ratio = slide.ratio
    n = min(n_fft, len(ratio))
    starts = range(0, len(ratio) - n + 1, max(n // 2, 1))
    window = np.hanning(n + 1)[:-1]
    pieces = np.stack([ratio[k : k + n] for k in starts])
    pieces = (pieces - pieces.mean(axis=1, keepdims=True)) * window
    power = (np.abs(np.fft.rfft(pieces, axis=1)) ** 2).mean(axis=0) * 2 / (slide.rate_hz * (window**2).sum())
    frequency = np.fft.rfftfreq(n, 1 / slide.rate_hz)
    edges = np.searchsorted(frequency, BANDS_HZ)
    bands = [power[min(a, len(power) - 1) : max(b, a + 1)].mean() for a, b in itertools.pairwise(edges)]
    # The sensor's noise is a friction that is the less the harder the finger presses: it is taken off, and what is less than a
    # usual sensor's noise at 1 N counts for nothing.
    white = 2 * slide.noise_n**2 / slide.rate_hz / float(slide.normal.mean()) ** 2
    floor = 2 * SensorNoise().force_n ** 2 / slide.rate_hz
    friction = np.tan(slide.inclination)
    features = np.array([*(max(each - white, 0.0) + floor for each in bands), friction.mean(), friction.std()])
    out: FloatArray = np.log(np.maximum(features, np.finfo(float).tiny))
    return out


BAND_NAMES = (
    *(f"log power {a:.3g} to {b:.3g} Hz" for a, b in itertools.pairwise(BANDS_HZ)),
    "log mean friction",
    "log spread of friction",
)
