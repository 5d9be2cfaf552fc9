"""The published method as a model that can be saved: its support vectors as plain arrays, and a prediction of its own from them.

What scikit-learn (libsvm) does for several classes is done here in a few lines: every two classes have a machine, each machine a vote.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.nail.published import columns, fit, histograms

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class HistogramModel:
    """A support vector machine on angle histograms.

    Parameters
    ----------
    names : tuple of str
        Of the classes.
    condition : str
        Which of the paper's nine sensor conditions.
    samples : int
        Readings of a window: raw counts mean something at this length alone.
    rate_hz : float
    gamma : float
        Of the kernel exp(-gamma |a - b|^2).
    vectors : (v, d) float
        Support vectors, class after class.
    dual : (k - 1, v) float
        Their coefficients, as libsvm stores them.
    intercept : (k (k - 1) / 2,) float
    counts : (k,) int
        Support vectors of each class.
    classes : (k,) int
        Which of the names each class of the machine is.
    """

    names: tuple[str, ...]
    condition: str
    samples: int
    rate_hz: float
    gamma: float
    vectors: FloatArray
    dual: FloatArray
    intercept: FloatArray
    counts: IntArray
    classes: IntArray

    @cached_property
    def _machines(self) -> FloatArray:
        """Coefficients of each pair's machine, (k (k - 1) / 2, v): those of its two classes, nothing elsewhere."""
        k, ends = len(self.classes), np.append(0, np.cumsum(self.counts))
        out = np.zeros((k * (k - 1) // 2, len(self.vectors)))
        pairs = ((i, j) for i in range(k) for j in range(i + 1, k))
        for row, (i, j) in enumerate(pairs):
            out[row, ends[i] : ends[i + 1]] = self.dual[j - 1, ends[i] : ends[i + 1]]
            out[row, ends[j] : ends[j + 1]] = self.dual[i, ends[j] : ends[j + 1]]
        return out

    def decide(self, values: FloatArray) -> IntArray:
        """Class (index into `names`) of each window (n, samples, 6); of classes with equally many votes the first.

        Raises
        ------
        InputError
            A reading is missing: an angle needs both of its channels.
        """
        features = histograms(values)[:, columns(self.condition)].astype(float)
        squared = (features**2).sum(axis=1)[:, None] - 2 * features @ self.vectors.T + (self.vectors**2).sum(axis=1)
        sides = np.exp(-self.gamma * np.maximum(squared, 0.0)) @ self._machines.T + self.intercept
        k = len(self.classes)
        votes = np.zeros((len(features), k), dtype=np.int64)
        pairs = ((i, j) for i in range(k) for j in range(i + 1, k))
        for row, (i, j) in enumerate(pairs):
            votes[:, i] += sides[:, row] > 0
            votes[:, j] += sides[:, row] <= 0
        out: IntArray = self.classes[votes.argmax(axis=1)]
        return out


def fit_histograms(
    names: Sequence[str], classes: IntArray, values: FloatArray, *, rate_hz: float, condition: str = "AxAyAzGxGyGz"
) -> HistogramModel:
    """Learn as published.

    Parameters
    ----------
    names : sequence of str
    classes : (n,) int
        Of each window.
    values : (n, samples, 6) float
    rate_hz : float
    condition : str
        One of `skinfab.fingertip.nail.published.CONDITIONS`.

    Raises
    ------
    InputError
        There is but one class, or a reading is missing.
    """
    found = fit(histograms(values)[:, columns(condition)], classes)
    coefficients, intercept = np.asarray(found.dual_coef_, dtype=float), np.asarray(found.intercept_, dtype=float)
    if len(found.classes_) == 2:
        # With two classes alone scikit-learn turns libsvm's signs round, so that the second is the positive one.
        coefficients, intercept = -coefficients, -intercept
    return HistogramModel(
        tuple(names),
        condition,
        values.shape[1],
        float(rate_hz),
        float(found._gamma),
        np.asarray(found.support_vectors_, dtype=float),
        coefficients,
        intercept,
        np.asarray(found.n_support_, dtype=np.int64),
        np.asarray(found.classes_, dtype=np.int64),
    )
