"""The paper's pipeline: angle histograms of pairs of channels, a support vector machine, and the mode of ten estimates.

Source: Kon, Ushiyama, Mizoguchi, Kajimoto, "Bare finger tactile sensing for edge orientation and contact position using excitation
from fingernail", eq. 1 to 5. Its eq. 1 prints theta = arctan(y / x), which cannot tell opposite quadrants; the range of 0 to 360 degrees
that it gives is that of atan2.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

BINS = 36
#: Which channels each pair has, as (x, y); Ax, Ay, Az, Gx, Gy, Gz are 0 to 5.
PAIRS = {"AxAy": (0, 1), "AyAz": (1, 2), "AzAx": (2, 0), "GxGy": (3, 4), "GyGz": (4, 5), "GzGx": (5, 3)}
#: The paper's nine sensor conditions, and which pairs each uses.
CONDITIONS: dict[str, tuple[str, ...]] = {
    "AxAyAzGxGyGz": tuple(PAIRS),
    "AxAyAz": ("AxAy", "AyAz", "AzAx"),
    "GxGyGz": ("GxGy", "GyGz", "GzGx"),
    **{pair: (pair,) for pair in PAIRS},
}


def histograms(readings: FloatArray) -> IntArray:
    """How many points of each pair's scatter plot lie in each 10 degrees.

    The mean of each acceleration, which is gravity, is taken off; that of the angular velocities is left, as in the paper.

    Parameters
    ----------
    readings : (n, samples, 6) float
        Ax, Ay, Az, Gx, Gy, Gz, in any units.

    Returns
    -------
    (n, 216) int
        36 counts a pair, in the order of `PAIRS`.

    Examples
    --------
    >>> turn = np.arange(360) * np.pi / 180 + 0.001
    >>> circle = np.stack([np.cos(turn), np.sin(turn)] * 3, axis=-1)
    >>> histograms(circle[None])[0, :3].tolist()
    [10, 10, 10]
    """
    readings = np.asarray(readings, dtype=float)
    if readings.ndim != 3 or readings.shape[2] != 6 or readings.shape[1] == 0:
        raise InputError(f"readings have the shape {readings.shape}; give (windows, samples, 6), six channels a sample")
    if not np.isfinite(readings).all():
        raise InputError("a reading is missing or not finite, and an angle needs both of its channels; leave that window out")
    n = len(readings)
    moved = readings.copy()
    moved[..., :3] -= moved[..., :3].mean(axis=1, keepdims=True)
    out = np.empty((n, len(PAIRS), BINS), dtype=np.int64)
    shelf = BINS * np.arange(n)[:, None]
    for k, (x, y) in enumerate(PAIRS.values()):
        # atan2 gives -pi to pi, and a tiny negative angle mod 2 pi rounds up to 2 pi itself: hence the last mod.
        turn = np.arctan2(moved[..., y], moved[..., x]) / (2 * np.pi) % 1.0
        sector = (turn * BINS).astype(np.int64) % BINS
        out[:, k] = np.bincount((sector + shelf).ravel(), minlength=n * BINS).reshape(n, BINS)
    return out.reshape(n, -1)


def columns(condition: str) -> IntArray:
    """Which of the 216 values a sensor condition uses.

    Examples
    --------
    >>> columns("AyAz")[[0, -1]].tolist(), len(columns("GxGyGz"))
    ([36, 71], 108)
    """
    if condition not in CONDITIONS:
        raise InputError(f"there is no sensor condition {condition!r}; there are {', '.join(CONDITIONS)}")
    order = list(PAIRS)
    return np.concatenate([np.arange(BINS) + BINS * order.index(pair) for pair in CONDITIONS[condition]])


def fit(features: IntArray, classes: IntArray) -> Any:
    """A support vector machine on raw counts, with scikit-learn's defaults: the paper names none.

    Parameters
    ----------
    features : (n, d) int
        From `histograms`.
    classes : (n,) int

    Returns
    -------
    sklearn.svm.SVC
        Fitted.

    Raises
    ------
    InputError
        There is but one class.
    """
    from sklearn.svm import SVC

    if len(np.unique(classes)) < 2:
        raise InputError("all trials are of one class; record the others too, and no contact")
    return SVC(kernel="rbf", C=1.0, gamma="scale").fit(features, classes)


def modes(estimates: IntArray) -> IntArray:
    """The most frequent of each row's estimates, (n, k) to (n,); of several the one that came first.

    Examples
    --------
    >>> modes(np.array([[1, 2, 2], [3, 1, 2]])).tolist()
    [2, 3]
    """
    counts = (estimates[:, :, None] == estimates[:, None, :]).sum(axis=2)
    first: IntArray = np.take_along_axis(estimates, counts.argmax(axis=1)[:, None], axis=1)[:, 0]
    return first
