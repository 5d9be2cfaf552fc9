"""From the normal derivative of a function on the boundary of a disk to its values there (Neumann to Dirichlet).

The values solve the cotangent Laplacian of the whole disk with the slopes as its right-hand side. It leaves the
constant open; with one vertex pinned it is definite, and one sparse factorisation serves every set of slopes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.flatten.graph_laplacian import GraphLaplacian
from skinfab.linalg import Cholesky, NotPositiveDefiniteError

FloatArray = NDArray[np.float64]


class NeumannToDirichlet:
    """Boundary values from boundary slopes: one factorisation, then one solve each time.

    Parameters
    ----------
    L : GraphLaplacian, (n, n)
        Cotangent Laplacian of a connected mesh.
    boundary : (b,) int64
        Its boundary vertices, in the order in which slopes and values are given.

    Raises
    ------
    InputError
        A boundary vertex has triangles without area only: nothing follows from its slope.

    Examples
    --------
    >>> L = GraphLaplacian(np.array([[0, 1], [1, 2]]), np.ones(2), 3)  # a line of three vertices
    >>> NeumannToDirichlet(L, np.array([0, 2]))(np.array([1.0, -1.0])).round(9).tolist()
    [1.0, -1.0]
    """

    def __init__(self, L: GraphLaplacian, boundary: NDArray[np.int64]) -> None:
        pinned = boundary[0]
        kept = np.ones(L.n, dtype=bool)
        kept[pinned] = False
        self._rows = boundary[1:] - (boundary[1:] > pinned)
        try:
            self._cholesky = Cholesky(L.block(kept))
        except NotPositiveDefiniteError as fault:
            loose = int(boundary[np.argmin(L.diagonal[boundary])])
            raise InputError(
                f"boundary vertex {loose} hangs on triangles without area, which tie its scale to nothing; cut them off, "
                f"or leave the boundary free"
            ) from fault
        self._n = L.n - 1

    @property
    def factorisations(self) -> int:
        """How many sparse factorisations were done: 1."""
        return self._cholesky.factorisations

    @property
    def solves(self) -> int:
        """How many times the factor was used."""
        return self._cholesky.solves

    def __call__(self, slope: FloatArray) -> FloatArray:
        """(b,) values, of mean zero, for slopes (b,) integrated over each vertex's part of the boundary; their mean is left out."""
        u = self.pinned(slope - slope.mean())
        return u - u.mean()

    def pinned(self, slope: FloatArray) -> FloatArray:
        """(b,) values of which the first is 0, whatever its slope."""
        right = np.zeros(self._n)
        right[self._rows] = slope[1:]
        return np.concatenate([[0.0], self._cholesky.solve(right)[self._rows]])
