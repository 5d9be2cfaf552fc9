"""How faces hang together: around a vertex (fans), over the surface (components), by winding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.joined import joined
from skinfab.mesh.topology import Topology

IntArray = NDArray[np.int64]


def components(top: Topology) -> tuple[int, IntArray]:
    """Groups of faces joined over edges, non-manifold ones too, and the group of each face (m,)."""
    m, e = len(top.F), len(top.E)
    face = np.repeat(np.arange(m), 3)
    # Faces and edges are the nodes, so that three faces at one edge all join.
    _, label = joined(face, m + top.FE.ravel(), m + e)
    found, label = np.unique(label[:m], return_inverse=True)
    return len(found), label


def corner_fans(top: Topology, pairs: IntArray | None = None) -> tuple[int, IntArray]:
    """Group the corners of faces that are joined around their vertex.

    Parameters
    ----------
    top : Topology
    pairs : (k, 4) int64, optional
        Face and side, face and side: which sides are joined. By default each edge joins all its faces.

    Returns
    -------
    count : int
    fan : (m, 3) int64
        The fan of each corner. A vertex with more than one fan is a bow-tie.
    """
    F, m = top.F, len(top.F)
    if pairs is None:
        side = np.arange(3 * m)
        first = np.full(len(top.E), -1)
        edge = top.FE.ravel()
        first[edge[::-1]] = side[::-1]
        pairs = np.column_stack([first[edge] // 3, first[edge] % 3, side // 3, side % 3])
    f, i, g, j = pairs.T
    a0, a1 = 3 * f + i, 3 * f + (i + 1) % 3
    b0, b1 = 3 * g + j, 3 * g + (j + 1) % 3
    flat = F.ravel()
    same = flat[a0] == flat[b0]  # sides that run the same way (inconsistent winding)
    count, fan = joined(np.concatenate([a0, a1]), np.concatenate([np.where(same, b0, b1), np.where(same, b1, b0)]), 3 * m)
    return count, fan.reshape(m, 3)


@dataclass(frozen=True, eq=False)
class Winding:
    """Which faces to turn so that neighbours agree.

    Parameters
    ----------
    turn : (m,) bool
        Faces to turn; the smaller part of each component.
    one_sided : (m,) bool
        Faces of components that cannot be wound consistently (a Moebius band).
    """

    turn: NDArray[np.bool_]
    one_sided: NDArray[np.bool_]


def winding(top: Topology) -> Winding:
    """Make the faces on both sides of each two-face edge run along it in opposite directions.

    Every face is two nodes, as it is and turned over; an edge joins the nodes that agree. A component
    whose two sides come out joined is one-sided.
    """
    m = len(top.F)
    two = np.flatnonzero(top.edge_count == 2)
    (f, g), (i, j) = top.EF[two].T, top.EC[two].T
    same = top.F[f, i] == top.F[g, j]
    a = np.concatenate([f, f + m])
    b = np.concatenate([np.where(same, g + m, g), np.where(same, g, g + m)])
    _, label = joined(a, b, 2 * m)
    as_is, turned = label[:m], label[m:]
    # Of the two ways to wind a component take the one that keeps more faces as they are.
    kept = np.bincount(as_is, minlength=label.max(initial=-1) + 1)
    turn = kept[turned] > kept[as_is]
    tie = (kept[turned] == kept[as_is]) & (turned < as_is)
    return Winding(turn | tie, as_is == turned)


def bowties(top: Topology, vertex_count: int) -> NDArray[np.bool_]:
    """(n,) vertices at which more than one fan of faces meets."""
    count, fan = corner_fans(top)
    vertex = np.empty(count, dtype=np.int64)
    vertex[fan.ravel()] = top.F.ravel()
    return np.bincount(vertex, minlength=vertex_count) > 1


def forward_sides(top: Topology, turn: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(m, 3) sides that run from the smaller to the larger vertex, once the faces in `turn` are turned over."""
    return (top.F < np.roll(top.F, -1, axis=1)) ^ turn[:, None]


def unbalanced_edges(top: Topology, turn: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(e,) edges of more than two faces that do not pair off, as many running one way as the other."""
    sign = np.where(forward_sides(top, turn), 1, -1).ravel()
    balance = np.bincount(top.FE.ravel(), weights=sign, minlength=len(top.E))
    return top.is_nonmanifold & (balance != 0)


def surplus_faces(F: IntArray) -> NDArray[np.bool_]:
    """(m,) faces that repeat another one with the same three corners, whichever way they are wound.

    All but the first of a group; but of two that face opposite ways both, where the surface is whole
    without them (a flap of no thickness): leaving one would make edges of three faces.
    """
    ordered = np.sort(F, axis=1)
    order = np.lexsort(ordered.T)
    again = (ordered[order][1:] == ordered[order][:-1]).all(axis=1)
    surplus = np.zeros(len(F), dtype=bool)
    surplus[order[1:][again]] = True
    if not again.any():
        return surplus
    group = np.empty(len(F), dtype=np.int64)
    group[order] = np.concatenate([[0], np.cumsum(~again)])
    size = np.bincount(group)
    odd = (F[:, 0] < F[:, 1]) ^ (F[:, 1] < F[:, 2]) ^ (F[:, 0] < F[:, 2])
    opposed = (np.bincount(group, weights=np.where(odd, 1, -1)) == 0) & (size > 1)
    top = Topology(F)
    others = top.edge_count[top.FE] - size[group][:, None]
    return surplus | (opposed[group] & (others != 1).all(axis=1) & (others > 0).any(axis=1))


def relative_heights(V: NDArray[np.float64], F: IntArray) -> NDArray[np.float64]:
    """(m,) smallest height of each face over its longest side; 0.87 equilateral, 0 flat."""
    p = V[F]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        sides = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2)
        longest = sides.max(axis=1)
        # Scaled before the product: mm^2 of a 1e-160 mm triangle would underflow.
        a, b = (p[:, 1] - p[:, 0]) / longest[:, None], (p[:, 2] - p[:, 0]) / longest[:, None]
        return np.nan_to_num(np.linalg.norm(np.cross(a, b), axis=1))
