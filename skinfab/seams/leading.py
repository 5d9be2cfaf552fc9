"""What the first pairs of unknowns of a system are worth, each number of them, from one factorisation."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.tolerances import NEWTON_RIDGE

FloatArray = NDArray[np.float64]


@numba.njit(cache=True)
def leading_energies(A: FloatArray, b: FloatArray) -> FloatArray:
    """Half of b^T A^-1 b for the first pair of unknowns, the first two, and so on: Cholesky, row by row.

    Parameters
    ----------
    A : (2 n, 2 n) float
        Symmetric but for rounding.
    b : (2 n,) float

    Returns
    -------
    (n,) float
        NaN from the pair on with which rounding hides that A is positive.

    Examples
    --------
    >>> leading_energies(np.diag([1.0, 1, 2, 2, -1, 1]), np.array([1.0, 1, 2, 0, 1, 1])).round(6).tolist()
    [1.0, 2.0, nan]
    """
    n = b.shape[0]
    ridge = NEWTON_RIDGE * np.trace(A) / n
    L, share, energy = np.zeros((n, n)), np.zeros(n), np.full(n // 2, np.nan)
    total = 0.0
    for i in range(n):
        for j in range(i + 1):
            x = (A[i, j] + A[j, i]) / 2
            for k in range(j):
                x -= L[i, k] * L[j, k]
            if j < i:
                L[i, j] = x / L[j, j]
            elif x + ridge > 0.0:
                L[i, i] = np.sqrt(x + ridge)
            else:
                return energy
        y = b[i]
        for k in range(i):
            y -= L[i, k] * share[k]
        share[i] = y / L[i, i]
        total += share[i] ** 2 / 2
        if i % 2:
            energy[i // 2] = total
    return energy
