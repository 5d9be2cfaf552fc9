"""A mesh with fewer triangles, and which of its vertices each of the fine ones went into."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: The collapses are ordered by error in bounds of fixed size: on an object of this diagonal they are fine enough that a finer
#: order gains nothing, and the result does not depend on the unit. At a diagonal of 1 the carried layout loses three times as much.
_DIAGONAL = 1000.0


@dataclass(frozen=True, eq=False)
class Decimated:
    """Fewer triangles of the same surface.

    Parameters
    ----------
    V : (k, 3) float64, mm
    F : (c, 3) int64
        Every vertex in use.
    onto : (n,) int64
        The vertex of `V` that each vertex of the fine mesh was collapsed into.
    """

    V: FloatArray
    F: IntArray
    onto: IntArray


def decimate(V: FloatArray, F: IntArray, *, faces: int) -> Decimated:
    """About `faces` triangles of least quadric error (Garland and Heckbert 1997).

    Whether the surface still hangs together as it did is for the caller to look at.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
        Every vertex in use.
    faces : int
        Fewer than m.

    Raises
    ------
    InputError
        The mesh cannot be brought down: nothing is left of some part of it.

    Examples
    --------
    >>> s, t = np.meshgrid(np.arange(9.0), np.arange(9.0))
    >>> V = np.stack([s.ravel(), t.ravel(), 0 * s.ravel()], axis=1)
    >>> a = (9 * np.arange(8)[:, None] + np.arange(8)).ravel()
    >>> F = np.concatenate([np.stack([a, a + 1, a + 10], axis=1), np.stack([a, a + 10, a + 9], axis=1)])
    >>> few = decimate(V, F, faces=40)
    >>> len(few.F) <= 40, few.onto.shape, len(np.unique(few.onto)) == len(few.V)
    (True, (81,), True)
    """
    import fast_simplification

    centre, size = V.mean(axis=0), float(np.linalg.norm(np.ptp(V, axis=0)))
    scale = _DIAGONAL / size if size > 0 else 1.0
    points, _, collapses = fast_simplification.simplify(
        (V - centre) * scale, F.astype(np.int32), target_count=faces, agg=7.0, return_collapses=True
    )
    root = _roots(collapses.astype(np.int64).reshape(-1, 2), len(V))
    G = root[F]
    left = G[(G[:, 0] != G[:, 1]) & (G[:, 1] != G[:, 2]) & (G[:, 2] != G[:, 0])]
    kept = np.zeros(len(V), dtype=bool)
    kept[left] = True
    root = _joined(root, kept, G)
    if kept.sum() != len(points) or not kept[root].all():
        raise InputError(f"{len(F)} triangles cannot be brought down to {faces}: parts of the surface vanish; ask for more of them")
    number = np.cumsum(kept) - 1
    return Decimated(points / scale + centre, number[left], number[root])


@numba.njit(cache=True)
def _roots(collapses: IntArray, n: int) -> IntArray:
    """Where each vertex ends when every row (stays, goes) is done in turn."""
    root = np.arange(n)
    for k in range(collapses.shape[0] - 1, -1, -1):
        root[collapses[k, 1]] = root[collapses[k, 0]]
    return root


def _joined(root: IntArray, kept: NDArray[np.bool_], G: IntArray) -> IntArray:
    """`root` with vertices that lost all their triangles joined to a neighbour that has some, where there is one."""
    lone = ~kept
    lone[root != np.arange(len(root))] = False
    if not lone.any():
        return root
    edges = np.concatenate([G[:, [0, 1]], G[:, [1, 2]], G[:, [2, 0]]])
    edges = np.concatenate([edges, edges[:, ::-1]])
    edges = edges[lone[edges[:, 0]] & (edges[:, 0] != edges[:, 1])]
    onto = np.arange(len(root))
    while lone.any():
        good = edges[lone[edges[:, 0]] & ~lone[edges[:, 1]]]
        if not len(good):
            break
        onto[good[:, 0]] = onto[good[:, 1]]
        lone[good[:, 0]] = False
    return onto[root]
