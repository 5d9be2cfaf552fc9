"""Length of the spectrum and way to find its peaks against how exact peaks are, and against how often textures are told right.

Two measurements: a corrugation's frequency and magnitude from a noisy sine of known ones, with each way to find the peak; and
held-out accuracy on simulated slides over the paper's six materials, with the features as published and with bands. Then the same
with more or fewer peaks than the published three.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.texture_peaks import WAYS, Slides, measure_peaks
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.fingertip.confusion import grouped_accuracy
from skinfab.fingertip.force.simulator import texture_logs
from skinfab.fingertip.force.texture import N_FFT, sliding_part
from skinfab.fingertip.force.texture_model import feature_table, train_texture
from skinfab.progress import Progress, silent

LENGTHS = (128, 256, 512, 1024)
#: Data sets, of each its own seed, and in each so many specimens of each material and slides over each. Specimens count: with six
#: of them the best way changes from set to set.
SEEDS = (0, 1, 2)
SPECIMENS, SLIDES = 15, 3

#: The features whose peaks, or power, each way stands for.
FEATURES_OF = {"published": "published", "interpolated": "bands"}
#: The sine whose peak is looked for: a corrugation between 3 and 8 Hz, its amplitude, and the noise of a force.
_RATE_HZ, _AMPLITUDE_N, _NOISE_N, _SINES = 200.0, 0.03, 0.005, 120


@dataclass(frozen=True)
class Row:
    """One length of the spectrum and one way.

    Parameters
    ----------
    way : str
        ``published``: bins of a plain spectrum, three peaks and three angles; ``interpolated``: Hann window and parabola, bands.
    n_fft : int
    seconds : float
        That the window lasts.
    frequency_rms_hz : float
        Error of the peak of a sine.
    magnitude_max : float
        Its magnitude's largest error, as a part.
    accuracy, low, high : float
        Of textures on specimens held out, and its 95 % interval over data sets and specimens.
    us_per_slide : float
        Least processor time of the features.
    """

    way: str
    n_fft: int
    seconds: float
    frequency_rms_hz: float
    magnitude_max: float
    accuracy: float
    low: float
    high: float
    us_per_slide: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write texture.csv, texture_peaks.csv, texture_ablation.csv, texture.png and .txt into `folder`, which is there already.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows", "peaks" and "ablation".
    """
    from skinfab.bench.texture_ablation import slides_without
    from skinfab.bench.texture_chart import draw
    from skinfab.files import atomic_write

    notes = [f"simulated: {len(SEEDS)} sets of {SPECIMENS} specimens and {SLIDES} slides of each of the paper's six materials"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        sets = slides_of(progress=lambda done, what: progress(0.3 * done, what))
        rows = measure(sets, repeats=repeats, progress=lambda done, what: progress(0.3 + 0.3 * done, what))
    write_csv(rows, folder / "texture.csv")
    write_csv(measure_peaks(sets), folder / "texture_peaks.csv")
    write_csv(slides_without(progress=lambda done, what: progress(0.6 + 0.4 * done, what)), folder / "texture_ablation.csv")
    table, peaks = read_csv(folder / "texture.csv"), read_csv(folder / "texture_peaks.csv")
    said = sentence(table)
    atomic_write(folder / "texture.txt", "\n".join([said, *notes]) + "\n")
    draw(table, peaks, folder / "texture.png")
    return {"sentence": said, "notes": notes, "rows": table, "peaks": peaks, "ablation": read_csv(folder / "texture_ablation.csv")}


def slides_of(
    *, seeds: Sequence[int] = SEEDS, specimens: int = SPECIMENS, slides: int = SLIDES, progress: Progress = silent
) -> list[Slides]:
    """A set of slides for each seed."""
    sets = []
    for k, seed in enumerate(seeds):
        progress(k / len(seeds), f"slides, set {k + 1} of {len(seeds)}")
        logs = texture_logs(specimens=specimens, slides=slides, seed=seed)
        sets.append(Slides([sliding_part(each) for each in logs], [each.label for each in logs], [each.group for each in logs]))
    return sets


def measure(sets: Sequence[Slides], *, lengths: Sequence[int] = LENGTHS, repeats: int = REPEATS, progress: Progress = silent) -> list[Row]:
    """A row for every way and length."""
    rows = []
    for j, way in enumerate(WAYS):
        for k, n_fft in enumerate(lengths):
            progress((j + k / len(lengths)) / len(WAYS), f"{way}, {n_fft} samples")
            frequency, magnitude = peak_errors(way, n_fft)
            right: list[bool] = []
            specimen_of: list[tuple[int, str]] = []
            for i, each in enumerate(sets):
                said = train_texture(each.parts, each.labels, each.groups, features=FEATURES_OF[way], n_fft=n_fft).said
                right += [a == b for a, b in zip(said, each.labels, strict=True)]
                specimen_of += [(i, group) for group in each.groups]
            rate = grouped_accuracy(np.array(right), specimen_of)
            work = partial(feature_table, sets[0].parts, FEATURES_OF[way], n_fft=n_fft)
            times = [timed_twice(work)[1] for _ in range(repeats)]
            each_us = 1e6 * min(times) / len(sets[0].parts)
            rows.append(Row(way, n_fft, n_fft / _RATE_HZ, frequency, magnitude, rate.value, rate.low, rate.high, each_us))
    return rows


def peak_errors(way: str, n_fft: int, *, seed: int = 0) -> tuple[float, float]:
    """Root mean square error of the frequency (Hz) of a sine's peak, and the largest of its magnitude as a part."""
    rng = np.random.default_rng(seed)
    time = np.arange(n_fft) / _RATE_HZ
    apart, size = [], []
    for true in np.linspace(3, 8, _SINES):
        signal = _AMPLITUDE_N * np.sin(2 * math.pi * true * time + rng.uniform(0, 2 * math.pi)) + _NOISE_N * rng.standard_normal(n_fft)
        peak = WAYS[way](signal, _RATE_HZ, n_fft=n_fft, count=1)
        apart.append(float(peak.frequency[0]) - true)
        size.append(abs(2 * float(peak.magnitude[0]) / _AMPLITUDE_N - 1))
    return float(np.sqrt(np.mean(np.square(apart)))), max(size)


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """What the default does beside the published way: every number comes from the table."""
    theirs, ours = (next(row for row in table if row["way"] == way and row["n_fft"] == N_FFT) for way in WAYS)
    return (
        f"Texture, simulated: from {N_FFT} samples ({ours['seconds']:.2f} s) a peak is off by {ours['frequency_rms_hz']:.3f} Hz and "
        f"{100 * ours['magnitude_max']:.0f} % (as published {theirs['frequency_rms_hz']:.2f} Hz and "
        f"{100 * theirs['magnitude_max']:.0f} %), and {100 * ours['accuracy']:.1f} % of the slides "
        "over specimens held out are told right by bands, "
        f"{100 * theirs['accuracy']:.1f} % by the published nine features, {ours['us_per_slide']:.0f} and "
        f"{theirs['us_per_slide']:.0f} us a slide."
    )
