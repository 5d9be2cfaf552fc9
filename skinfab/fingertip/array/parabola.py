"""The cheapest peak: a parabola through the logarithms of three tactels, along and around. Exact where the answer is a Gaussian."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

#: A neighbour that reads nothing, or less, counts as this part of the highest: its logarithm would be none.
_LEAST = 1e-3


@numba.njit(cache=True)
def log_parabola(Z: FloatArray) -> tuple[float, float]:
    """Ring and stripe of the peak, in tactel spacings; NaN where nothing reads above zero.

    At the first and the last ring there is no third tactel: the place along is then that ring's.

    Examples
    --------
    >>> i, j = np.arange(8.0)[:, None], np.arange(8.0)
    >>> x, y = log_parabola(np.exp(-((i - 3.3) ** 2 + (j - 4.2) ** 2)))
    >>> round(x, 6), round(y, 6)
    (3.3, 4.2)
    """
    rings, stripes = Z.shape
    top, bi, bj = 0.0, -1, -1
    for i in range(rings):
        for j in range(stripes):
            if Z[i, j] > top:
                top, bi, bj = Z[i, j], i, j
    if bi < 0:
        return math.nan, math.nan
    x = float(bi)
    if 0 < bi < rings - 1:
        x += _offset(Z[bi - 1, bj] / top, Z[bi + 1, bj] / top)
    return x, bj + _offset(Z[bi, (bj - 1) % stripes] / top, Z[bi, (bj + 1) % stripes] / top)


@numba.njit(cache=True)
def _offset(before: float, after: float) -> float:
    a = math.log(before) if before > _LEAST else math.log(_LEAST)
    c = math.log(after) if after > _LEAST else math.log(_LEAST)
    return 0.5 * (a - c) / (a + c) if a + c < 0 else 0.0
