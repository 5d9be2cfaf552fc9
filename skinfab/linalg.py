"""Sparse Cholesky with its symbolic analysis kept: analyse once, factor for every new set of values, solve many.

The factorisation is SuiteSparse's supernodal CHOLMOD as shipped in cvxopt's wheels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from cvxopt import cholmod, matrix, spmatrix
from numpy.typing import NDArray

from skinfab.errors import SkinfabError

if TYPE_CHECKING:
    from scipy.sparse import csc_array


class NotPositiveDefiniteError(SkinfabError):
    """A matrix that should be positive definite is not."""


@dataclass(frozen=True, eq=False)
class LowerTriangle:
    """Entries of a symmetric matrix on and below its diagonal, column by column, each column by row.

    Parameters
    ----------
    data : (k,) float64
    rows, columns : (k,) int64
    n : int
        Rows and columns of the matrix.
    """

    data: NDArray[np.float64]
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    n: int

    @classmethod
    def of(cls, matrix: csc_array) -> LowerTriangle:
        """Of a scipy matrix (n, n); anything above its diagonal is left out."""
        if not matrix.has_canonical_format:
            matrix = matrix.copy()
            matrix.sum_duplicates()
        n = matrix.shape[0]
        columns = np.repeat(np.arange(n), np.diff(matrix.indptr))
        kept = matrix.indices >= columns  # of pieces with some hundred vertices in a quarter of the time that scipy takes for its tril
        return cls(matrix.data[kept], matrix.indices[kept].astype(np.int64), columns[kept], n)


class Cholesky:
    """Factor of a sparse symmetric positive definite matrix.

    Parameters
    ----------
    lower : LowerTriangle or (n, n) csc_array

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
    >>> c = Cholesky(LowerTriangle(np.array([4.0, 2.0, 3.0]), np.array([0, 1, 1]), np.array([0, 0, 1]), 2))
    >>> c.solve(np.array([8.0, 7.0])).round(12).tolist(), c.factorisations, c.solves
    ([1.25, 1.5], 1, 1)
    """

    def __init__(self, lower: LowerTriangle | csc_array) -> None:
        if not isinstance(lower, LowerTriangle):
            lower = LowerTriangle.of(lower)
        self.factorisations = self.solves = 0
        self._matrix = spmatrix(matrix(lower.data), matrix(lower.rows), matrix(lower.columns), (lower.n, lower.n))
        cholmod.options["supernodal"] = 2
        self._factor = None
        self._numeric()

    def refactor(self, data: NDArray[np.float64]) -> None:
        """Factor again with new `data`, in the order of the lower triangle's sorted CSC entries."""
        self._matrix.V = matrix(np.ascontiguousarray(data))
        self._numeric()

    def solve(self, b: NDArray[np.float64]) -> NDArray[np.float64]:
        """x of A x = b; `b` is (n,) or (n, k)."""
        if self._factor is None:
            raise SkinfabError("the factor was taken apart; factor again before solving")
        self.solves += 1
        x = matrix(np.asfortranarray(b.reshape(len(b), -1)))
        cholmod.solve(self._factor, x)
        return np.array(x).reshape(b.shape)

    def taken_apart(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """The factor itself, which must be made anew before this solves again: the order (n,) in which the unknowns were taken,
        and the lower triangle L of the matrix in that order, L L^T: where columns begin (n + 1,), rows and values, in columns by row."""
        order = matrix(np.arange(self._matrix.size[0], dtype=np.float64))
        cholmod.solve(self._factor, order, sys=7)  # permutes, no more
        indptr, rows, values = cholmod.getfactor(self._factor).CCS
        self._factor = None
        return np.array(order).ravel().astype(np.int64), np.array(indptr).ravel(), np.array(rows).ravel(), np.array(values).ravel()

    def _numeric(self) -> None:
        self.factorisations += 1
        if self._factor is None:
            self._factor = cholmod.symbolic(self._matrix)
        try:
            cholmod.numeric(self._matrix, self._factor)
        except ArithmeticError as fault:
            raise NotPositiveDefiniteError(f"the system is not positive definite (column {fault})") from fault
