"""Ears: triangles with two boundary edges, whose corners all come to lie on the border of any layout."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.mesh.topology import Topology

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cut_ears(V: FloatArray, F: IntArray) -> tuple[FloatArray, IntArray, IntArray]:
    """The mesh without its ears, for a target curve with straight sides on which an ear has no room.

    What becomes an ear by the cut is cut too, until there is none.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        Every vertex in use.

    Returns
    -------
    V : (k, 3) float64, mm
    F : (l, 3) int64
    kept : (k,) int64
        Which of the given vertices they are.

    Raises
    ------
    InputError
        Nothing is left: every triangle hangs on the border.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 0], [3, 1, 0]])
    >>> F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 5, 2]])
    >>> W, G, kept = cut_ears(V, F)
    >>> len(G), kept.tolist()
    (4, [0, 1, 2, 3, 4])
    """
    left = F
    while len(left):
        topology = Topology(left)
        ear = topology.is_boundary[topology.FE].sum(axis=1) > 1
        if not ear.any():
            break
        left = left[~ear]
    if not len(left):
        raise InputError(f"each of the {len(F)} triangles hangs on the border by two edges, one after the other; refine the mesh first")
    kept = np.unique(left)
    return V[kept], np.searchsorted(kept, left).astype(np.int64), kept
