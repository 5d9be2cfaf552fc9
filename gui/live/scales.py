"""The range of values that each strip shows: wide enough at once, narrower only where most of it lies idle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: Room above and below what was read, as a part of its span.
MARGIN = 0.08
#: A range is narrowed where less than this part of it is used: not with every wave that leaves the picture.
USED = 0.5
#: A channel that stands still gets so much of its value as a range, so that its last digit does not fill the strip.
STILL = 1e-3


class Scales:
    """Ranges of the channels of one stream.

    Examples
    --------
    >>> scales = Scales(1)
    >>> scales.fit(np.array([0.0]), np.array([1.0])); scales.low.round(2).tolist(), scales.high.round(2).tolist()
    ([-0.08], [1.08])
    >>> scales.fit(np.array([0.2]), np.array([0.9])); scales.high.round(2).tolist()  # most of it is used: it stays
    [1.08]
    """

    def __init__(self, columns: int) -> None:
        self.low, self.high = np.full(columns, np.nan), np.full(columns, np.nan)

    def fit(self, least: FloatArray, most: FloatArray) -> None:
        """Take what is shown (c,), NaN where a channel shows nothing, into account."""
        known = np.isfinite(least)
        span = np.maximum(most - least, STILL * np.maximum(np.abs(least), np.abs(most)))
        span = np.where(span > 0, span, 1.0)
        middle = (most + least) / 2
        with np.errstate(invalid="ignore"):
            fits = (least >= self.low) & (most <= self.high) & (span >= USED * (self.high - self.low) / (1 + 2 * MARGIN))
        change = known & ~fits
        half = (0.5 + MARGIN) * span
        self.low = np.where(change, middle - half, self.low)
        self.high = np.where(change, middle + half, self.high)
