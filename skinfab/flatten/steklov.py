"""From the normal derivative of a function on the boundary of a disk to its values there (Neumann to Dirichlet).

The Dirichlet-to-Neumann matrix is the Schur complement S = L_bb - L_bf L_ff^-1 L_fb of the Laplacian's inner
block. It is made with the factor that BFF has anyway and inverted densely: b x b for b boundary vertices. Making
it costs b right-hand sides, once: 5 s for 60 000 triangles with 600 boundary vertices, 35 s for 194 000 with 1080.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csc_array

from skinfab.linalg import Cholesky

FloatArray = NDArray[np.float64]

#: Right-hand sides a solve: enough for the level 3 BLAS, few enough to take little memory on large meshes.
_BLOCK = 64


class NeumannToDirichlet:
    """Boundary values from boundary slopes: build once (b / 64 solves, rounded up), apply many times without a solve.

    Parameters
    ----------
    L_bb : (b, b) sparse
    L_bf : (b, f) sparse
        Blocks of the cotangent Laplacian.
    inner : Cholesky or None
        Factor of its inner block; None without inner vertices.
    """

    def __init__(self, L_bb: csc_array, L_bf: csc_array, inner: Cholesky | None) -> None:
        S = L_bb.toarray()
        if inner is not None:
            coupling = csc_array(L_bf.T)
            for k in range(0, len(S), _BLOCK):
                S[:, k : k + _BLOCK] -= L_bf @ inner.solve(coupling[:, k : k + _BLOCK].toarray())
        # Constants have no slope; S is made definite by giving them one, which sound right-hand sides never meet.
        self._factor = cho_factor((S + S.T) / 2 + np.trace(S) / len(S) ** 2, lower=True)

    def __call__(self, slope: FloatArray) -> FloatArray:
        """(b,) values, of mean zero, for slopes (b,) integrated over each vertex's part of the boundary; their mean is left out."""
        u: FloatArray = cho_solve(self._factor, slope - slope.mean())
        return u - u.mean()
