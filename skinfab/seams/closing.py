"""What closing the end of a seam would cost, at every length of it, told without closing.

The counterpart of `release`: the gap between the two sides of a seam is closed by forces, and how far a layout gives way
to such forces is told by its factored Hessian. The pivots of the Cholesky factor of that flexibility, taken from the
seam's end on, give the rise of d for every shorter closure as well, and the least displacement that closes the gap.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.seams.leading import leading_energies
from skinfab.seams.sheet import Sheet
from skinfab.tolerances import NEWTON_RIDGE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Fringe:
    """A seam from its free end backwards.

    Parameters
    ----------
    edges : (k,) int64
        Of the surface.
    pairs : (k, 2) int64
        Vertices of the sheet that become one when the first, the first two, ... edges are closed.
    """

    edges: IntArray
    pairs: IntArray


def fringes(sheet: Sheet, *, most: int) -> list[Fringe]:
    """Every free end of a seam, with up to `most` edges, as far as the seam runs without branching."""
    topology = sheet.surface.mesh.topology
    start, pairs = _fringes(sheet.loop, sheet.origin, min(most, (len(sheet.loop) - 4) // 2))
    found = []
    for k in range(len(start) - 1):
        own = pairs[start[k] : start[k + 1]]
        path = sheet.origin[np.r_[own[0, 0], own[1:, 0]]]
        edges = topology.edge_ids(np.stack([path[:-1], path[1:]], axis=1))
        if (edges >= 0).all() and sheet.cut[edges].all():
            found.append(Fringe(edges, own[1:]))
    return found


def closing_costs(sheet: Sheet, ends: Sequence[Fringe]) -> list[FloatArray]:
    """By how much the mean d rises, to second order, when each seam's end is closed: (k,), for every number of edges."""
    found = []
    for end in ends:
        gap = (sheet.UV[end.pairs[:, 0]] - sheet.UV[end.pairs[:, 1]]).ravel()
        rises = leading_energies(sheet.flexibility.energy(*_loads(end.pairs)), gap)
        found.append(np.where(np.isnan(rises), np.inf, rises))  # held so stiffly that rounding hides how much it gives
    return found


def closing_step(sheet: Sheet, end: Fringe, count: int) -> FloatArray:
    """The layout moved so that the first `count` edges of a seam's end are closed, at the least rise of d, (p, 2) mm."""
    pairs = end.pairs[:count]
    at, loads = _loads(pairs)
    gap = (sheet.UV[pairs[:, 0]] - sheet.UV[pairs[:, 1]]).ravel()
    flexibility = sheet.flexibility.energy(at, loads)
    flexibility[np.diag_indices(2 * count)] += NEWTON_RIDGE * np.trace(flexibility) / (2 * count)
    return sheet.UV - sheet.flexibility.displacement(at, loads @ np.linalg.solve(flexibility, gap)).reshape(-1, 2)


@numba.njit(cache=True)
def _fringes(loop: IntArray, origin: IntArray, most: int) -> tuple[IntArray, IntArray]:
    """For each end on the loop: its vertex twice, then the pairs that are one on the surface, going back from it."""
    b = loop.shape[0]
    start = np.zeros(b + 1, dtype=np.int64)
    pairs = np.empty((2 * b + 2, 2), dtype=np.int64)
    ends = filled = 0
    for i in range(b):
        if most < 1 or origin[loop[i - 1]] != origin[loop[(i + 1) % b]]:
            continue
        pairs[filled, 0] = pairs[filled, 1] = loop[i]
        filled += 1
        for j in range(1, most + 1):
            one, two = loop[(i + j) % b], loop[(i - j) % b]
            if origin[one] != origin[two] or one == two or filled == pairs.shape[0]:
                break
            pairs[filled, 0], pairs[filled, 1] = one, two
            filled += 1
        ends += 1
        start[ends] = filled
    return start[: ends + 1], pairs[:filled]


def _loads(pairs: IntArray) -> tuple[IntArray, FloatArray]:
    """Rows, and on them forces that draw each pair together, along x and along y."""
    vertices, which = np.unique(pairs, return_inverse=True)
    loads = np.zeros((2 * len(vertices), 2 * len(pairs)))
    one, other = which.reshape(-1, 2).T
    k = 2 * np.arange(len(pairs))
    for x in range(2):
        loads[2 * one + x, k + x] += 1.0
        loads[2 * other + x, k + x] -= 1.0
    return np.stack([2 * vertices, 2 * vertices + 1], axis=1).ravel(), loads
