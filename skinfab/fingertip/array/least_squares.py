"""The linear algebra of small fits, compiled: normal equations with Marquardt's damping, solved by Cholesky."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

# Loops, not array expressions: numba takes seconds to compile each of those.


@numba.njit(cache=True)
def normal_equations(J: FloatArray, r: FloatArray, damping: float, A: FloatArray, b: FloatArray) -> None:
    """A = J J^T with its diagonal times 1 + damping, b = J r; of J (n, m) and r (m,)."""
    n, m = J.shape
    for i in range(n):
        s = 0.0
        for e in range(m):
            s += J[i, e] * r[e]
        b[i] = s
        for j in range(i + 1):
            s = 0.0
            for e in range(m):
                s += J[i, e] * J[j, e]
            A[i, j] = A[j, i] = s
    for i in range(n):
        A[i, i] = A[i, i] * (1 + damping) + 1e-300


@numba.njit(cache=True)
def solve(A: FloatArray, b: FloatArray, x: FloatArray) -> None:
    """A x = b for a positive definite A, whose lower half is overwritten; x is zero where A is none."""
    n = len(b)
    for i in range(n):
        x[i] = 0.0
    for k in range(n):
        for i in range(k, n):
            s = A[i, k]
            for m in range(k):
                s -= A[i, m] * A[k, m]
            if i == k:
                if s <= 0.0:
                    return
                A[k, k] = math.sqrt(s)
            else:
                A[i, k] = s / A[k, k]
    for i in range(n):
        s = b[i]
        for m in range(i):
            s -= A[i, m] * x[m]
        x[i] = s / A[i, i]
    for i in range(n - 1, -1, -1):
        s = x[i]
        for m in range(i + 1, n):
            s -= A[m, i] * x[m]
        x[i] = s / A[i, i]
