"""Channels that stand still: a wire that is off, or a sensor that hangs, gives one number for ever, while the motor shakes the others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def without_frozen(window: FloatArray) -> FloatArray:
    """Readings (n, 6), NaN where a channel never changes: it is missing, and taken for a reading it would spoil all the others.

    A channel of which all but one reading are missing is left as it is.

    Examples
    --------
    >>> without_frozen(np.array([[1.0, 0.0], [2.0, 0.0], [1.0, 0.0]])).tolist()
    [[1.0, nan], [2.0, nan], [1.0, nan]]
    """
    # Most windows are done here, as no channel ends as it began; by plain numbers, as arrays as small as these cost ten times as much.
    ends = zip(window[0].tolist(), window[-1].tolist(), strict=True)
    if not any(alike := [a == b or a != a or b != b for a, b in ends]):
        return window
    there = np.isfinite(window)
    first = window[there.argmax(axis=0), np.arange(window.shape[1])]
    frozen = np.array(alike) & (there.sum(axis=0) > 1) & ((window == first) | ~there).all(axis=0)
    return np.where(frozen, np.nan, window) if frozen.any() else window
