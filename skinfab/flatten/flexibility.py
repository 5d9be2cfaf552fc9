"""How far a layout gives way to forces at a few places, told with the factor of its Hessian.

With A = L L^T a load b costs b^T A^-1 b = |L^-1 b|^2: half a solve. Where b is not zero in a few rows only, no more of L is
met than the way from these up its elimination tree (Davis 2006, "Direct Methods for Sparse Linear Systems", section 3.2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.linalg import Cholesky

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Flexibility:
    """Inverse of a positive definite (n, n) matrix, by its factor.

    Parameters
    ----------
    place : (n,) int64
        Of each unknown in the order of the factor.
    indptr, rows, values
        The lower triangle L of the reordered matrix, columns by row.

    Examples
    --------
    >>> from skinfab.linalg import LowerTriangle
    >>> A = LowerTriangle(np.array([4.0, 2.0, 3.0]), np.array([0, 1, 1]), np.array([0, 0, 1]), 2)
    >>> gives = Flexibility.of(Cholesky(A))
    >>> gives.energy(np.array([0]), np.array([[8.0]])).round(12).tolist()
    [[24.0]]
    >>> gives.displacement(np.array([1]), np.array([8.0])).round(12).tolist()
    [-2.0, 4.0]
    """

    place: IntArray
    indptr: IntArray
    rows: IntArray
    values: FloatArray

    @classmethod
    def of(cls, factor: Cholesky) -> Flexibility:
        """Of what was factored; the factor itself is taken apart."""
        order, indptr, rows, values = factor.taken_apart()
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        return cls(place, indptr, rows, values)

    def energy(self, at: IntArray, loads: FloatArray) -> FloatArray:
        """loads^T A^-1 loads, (k, k), of loads (r, k) in the rows `at`, each once."""
        half = _forward(self.indptr, self.rows, self.values, self.place[at], np.ascontiguousarray(loads))[1]
        product: FloatArray = half.T @ half
        return product

    def displacement(self, at: IntArray, load: FloatArray) -> FloatArray:
        """A^-1 load, (n,), of a load (r,) in the rows `at`, each once."""
        reach, half = _forward(self.indptr, self.rows, self.values, self.place[at], np.ascontiguousarray(load[:, None]))
        x = np.zeros(len(self.place))
        x[reach] = half[:, 0]
        _backward(self.indptr, self.rows, self.values, x)
        return x[self.place]


@numba.njit(cache=True)
def _forward(indptr: IntArray, rows: IntArray, values: FloatArray, at: IntArray, loads: FloatArray) -> tuple[IntArray, FloatArray]:
    """The rows of L^-1 loads that are not zero, and these, (q, k)."""
    n = indptr.shape[0] - 1
    number = np.full(n, -1)
    count = 0
    for start in at:
        j = start
        while j >= 0 and number[j] < 0:
            number[j] = 0
            count += 1
            # The first entry below the diagonal is the parent.
            j = rows[indptr[j] + 1] if indptr[j + 1] > indptr[j] + 1 else -1
    reach = np.empty(count, dtype=np.int64)
    count = 0
    for j in range(n):
        if number[j] == 0:
            reach[count], number[j] = j, count
            count += 1
    k = loads.shape[1]
    y = np.zeros((count, k))
    for r in range(at.shape[0]):
        y[number[at[r]]] += loads[r]
    for i in range(count):
        first, last = indptr[reach[i]], indptr[reach[i] + 1]
        own = y[i]
        pivot = 1.0 / values[first]
        for c in range(k):
            own[c] *= pivot
        for p in range(first + 1, last):
            x, other = values[p], y[number[rows[p]]]
            for c in range(k):
                other[c] -= x * own[c]
    return reach, y


@numba.njit(cache=True)
def _backward(indptr: IntArray, rows: IntArray, values: FloatArray, x: FloatArray) -> None:
    """L^-T x, in place."""
    for j in range(indptr.shape[0] - 2, -1, -1):
        total = x[j]
        for p in range(indptr[j] + 1, indptr[j + 1]):
            total -= values[p] * x[rows[p]]
        x[j] = total / values[indptr[j]]
