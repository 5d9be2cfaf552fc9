"""A symmetric matrix with rows that sum to zero, held as the weights of a mesh's edges: no general sparse matrix is needed for it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.linalg import LowerTriangle

if TYPE_CHECKING:
    from scipy.sparse import csc_array

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class GraphLaplacian:
    """L with L_ij = -w_ij for every edge and the sums of weights on the diagonal.

    Parameters
    ----------
    E : (e, 2) int64
        Edges, smaller vertex first, sorted.
    weight : (e,) float64
    n : int
        Vertices.

    Examples
    --------
    >>> L = GraphLaplacian(np.array([[0, 1], [1, 2]]), np.array([1.0, 2.0]), 3)
    >>> (L @ np.array([1.0, 0.0, 0.0])).tolist(), L.to_sparse().toarray().tolist()
    ([1.0, -1.0, 0.0], [[1.0, -1.0, 0.0], [-1.0, 3.0, -2.0], [0.0, -2.0, 2.0]])
    """

    E: IntArray
    weight: FloatArray
    n: int

    @cached_property
    def diagonal(self) -> FloatArray:
        """(n,) sum of the weights at each vertex."""
        return self._gathered(self.E[:, 0], self.weight) + self._gathered(self.E[:, 1], self.weight)

    def __matmul__(self, x: FloatArray) -> FloatArray:
        """L x, for x (n,) or (n, k)."""
        i, j = self.E.T
        columns = []
        for column in x.reshape(self.n, -1).T:
            slope = self.weight * (column[i] - column[j])
            columns.append(self._gathered(i, slope) - self._gathered(j, slope))
        return np.stack(columns, axis=1).reshape(x.shape)

    def about(self, vertices: IntArray) -> GraphLaplacian:
        """The same on functions that vanish away from `vertices`, and at `vertices` on all: of the edges that touch them only."""
        chosen = np.zeros(self.n, dtype=bool)
        chosen[vertices] = True
        touch = chosen[self.E].any(axis=1)
        return GraphLaplacian(self.E[touch], self.weight[touch], self.n)

    def block(self, keep: NDArray[np.bool_]) -> LowerTriangle:
        """Lower triangle of the rows and columns where `keep` (n,) is true, in their order."""
        inside = keep[self.E].all(axis=1)
        # Renumbered in order, the edges are sorted as they were: by column, then row.
        number = np.cumsum(keep) - 1
        column, row = number[self.E[inside]].T
        size = int(keep.sum())
        above = np.bincount(column, minlength=size)
        start = np.cumsum(above + 1) - above - 1
        at = np.arange(len(column)) + column + 1  # behind the diagonal entries of all columns so far
        rows, data = np.empty(len(column) + size, dtype=np.int64), np.empty(len(column) + size)
        rows[start], rows[at] = np.arange(size), row
        data[start], data[at] = self.diagonal[keep], -self.weight[inside]
        return LowerTriangle(data, rows, np.repeat(np.arange(size), above + 1), size)

    def to_sparse(self) -> csc_array:
        """The whole matrix, for scipy."""
        from scipy.sparse import coo_array, csc_array

        (i, j), at = self.E.T, np.arange(self.n)
        data = np.concatenate([-self.weight, -self.weight, self.diagonal])
        return csc_array(coo_array((data, (np.concatenate([i, j, at]), np.concatenate([j, i, at]))), shape=(self.n, self.n)))

    def _gathered(self, vertex: IntArray, value: FloatArray) -> FloatArray:
        return np.asarray(np.bincount(vertex, weights=value, minlength=self.n), dtype=np.float64)
