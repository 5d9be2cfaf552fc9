"""How many peaks of a slide's spectrum tell its texture: the published features with one to six of them, beside power in bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.confusion import grouped_accuracy
from skinfab.fingertip.force.discriminant import fit_discriminant
from skinfab.fingertip.force.texture import N_FFT, Slide, band_features, interpolated_peaks, published_peaks
from skinfab.fingertip.force.texture_model import FOLDS
from skinfab.fingertip.splits import group_folds

FloatArray = NDArray[np.float64]

COUNTS = (1, 2, 3, 4, 6)
WAYS = {"published": published_peaks, "interpolated": interpolated_peaks}
#: In the table, how the default is called, which looks for no peaks.
BANDS = "bands"


@dataclass(frozen=True)
class PeaksRow:
    """One way to find peaks, and so many of them; or power in bands, with none.

    Parameters
    ----------
    way : str
    peaks : int
    features : int
        Frequencies and magnitudes of the peaks and three angles; or the bands' own.
    accuracy, low, high : float
        Of textures on specimens held out, and its 95 % interval.
    """

    way: str
    peaks: int
    features: int
    accuracy: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Slides:
    """One set of slides, the material of each and its specimen."""

    parts: Sequence[Slide]
    labels: Sequence[str]
    groups: Sequence[str]


def measure_peaks(sets: Sequence[Slides], *, counts: Sequence[int] = COUNTS) -> list[PeaksRow]:
    """A row for each way and number of peaks, and one for bands, all at the default length of the spectrum."""
    rows = [_row(way, count, [with_peaks(each, way, count) for each in sets], sets) for way in WAYS for count in counts]
    return [*rows, _row(BANDS, 0, [np.stack([band_features(part) for part in each.parts]) for each in sets], sets)]


def with_peaks(each: Slides, way: str, count: int) -> FloatArray:
    """Frequencies (Hz) and magnitudes (mN) of so many peaks, and largest, least and mean inclination (degrees), a row a slide."""
    rows = []
    for part in each.parts:
        found = WAYS[way](part.tangential, part.rate_hz, count=count)
        angle = np.degrees(part.inclination[:N_FFT])
        rows.append(np.concatenate([found.frequency, 1000 * found.magnitude, [angle.max(), angle.min(), angle.mean()]]))
    return np.stack(rows)


def _row(way: str, peaks: int, tables: Sequence[FloatArray], sets: Sequence[Slides]) -> PeaksRow:
    right, specimen_of = [], []
    for k, (table, each) in enumerate(zip(tables, sets, strict=True)):
        labels = np.array(each.labels)
        fewest = min(len({g for g, own in zip(each.groups, each.labels, strict=True) if own == name}) for name in each.labels)
        for train, test in group_folds(each.groups, k=min(FOLDS, fewest), strata=each.labels, seed=0):
            model = fit_discriminant(table[train], labels[train].tolist())
            said = np.array(model.names)[model.distances(table[test]).argmin(axis=1)]
            right += (said == labels[test]).tolist()
            specimen_of += [(k, each.groups[j]) for j in test.tolist()]
    rate = grouped_accuracy(np.array(right), specimen_of)
    return PeaksRow(way, peaks, tables[0].shape[1], rate.value, rate.low, rate.high)
