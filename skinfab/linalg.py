"""Sparse Cholesky with its symbolic analysis kept: analyse once, factor for every new set of values, solve many.

The factorisation is SuiteSparse's supernodal CHOLMOD as shipped in cvxopt's wheels.
"""

from __future__ import annotations

import numpy as np
from cvxopt import cholmod, matrix, spmatrix
from numpy.typing import NDArray
from scipy.sparse import csc_array, tril

from skinfab.errors import SkinfabError


class NotPositiveDefiniteError(SkinfabError):
    """A matrix that should be positive definite is not."""


class Cholesky:
    """Factor of a sparse symmetric positive definite matrix.

    Parameters
    ----------
    lower : (n, n) sparse
        Its lower triangle; anything above the diagonal is left out.

    Attributes
    ----------
    factorisations, solves : int
        How many were done: the counters that the tests pin.

    Raises
    ------
    NotPositiveDefiniteError
        The values are not positive definite.

    Examples
    --------
    >>> c = Cholesky(csc_array(np.array([[4.0, 0.0], [2.0, 3.0]])))
    >>> c.solve(np.array([8.0, 7.0])).round(12).tolist(), c.factorisations, c.solves
    ([1.25, 1.5], 1, 1)
    """

    def __init__(self, lower: csc_array) -> None:
        lower = csc_array(tril(lower, format="csc"))
        lower.sort_indices()
        n = lower.shape[0]
        columns = np.repeat(np.arange(n), np.diff(lower.indptr))
        self.factorisations = self.solves = 0
        self._matrix = spmatrix(matrix(lower.data), matrix(lower.indices.astype(np.int64)), matrix(columns.astype(np.int64)), (n, n))
        cholmod.options["supernodal"] = 2
        self._factor = cholmod.symbolic(self._matrix)
        self._numeric()

    def refactor(self, data: NDArray[np.float64]) -> None:
        """Factor again with new `data`, in the order of the lower triangle's sorted CSC entries."""
        self._matrix.V = matrix(np.ascontiguousarray(data))
        self._numeric()

    def solve(self, b: NDArray[np.float64]) -> NDArray[np.float64]:
        """x of A x = b; `b` is (n,) or (n, k)."""
        self.solves += 1
        x = matrix(np.asfortranarray(b.reshape(len(b), -1)))
        cholmod.solve(self._factor, x)
        return np.array(x).reshape(b.shape)

    def _numeric(self) -> None:
        self.factorisations += 1
        try:
            cholmod.numeric(self._matrix, self._factor)
        except ArithmeticError as fault:
            raise NotPositiveDefiniteError(f"the system is not positive definite (column {fault})") from fault
