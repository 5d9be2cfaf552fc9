"""Seam edges in words: as pairs of vertices, and as lines that a cuts file takes."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

#: So many edges are named; whoever reads a sentence looks the first ones up.
_NAMED = 3

#: A path is told by so many of its vertices: a cut joins them by the cheapest way, so few pin it down.
_POINTS = 8


def named_edges(mesh: Mesh, edges: IntArray, *, numbers: IntArray | None = None) -> str:
    """The first few of `edges` (k,) along their chains, as pairs of vertices.

    Parameters
    ----------
    mesh : Mesh
    edges : (k,) int64
    numbers : (n,) int64, optional
        What each vertex of `mesh` is called.

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> named_edges(square, np.array([0, 4, 2, 3]))
    '0-1, 1-2, 2-3 and 1 more'
    >>> named_edges(square, np.array([0, 1]), numbers=np.array([7, 8, 9, 10]))
    '8-7, 7-9'
    """
    pairs = [(a, b) for chain in chains(mesh, edges) for a, b in pairwise(chain)]
    called = _called(numbers)
    text = ", ".join(f"{called(a)}-{called(b)}" for a, b in pairs[:_NAMED])
    return text + (f" and {len(pairs) - _NAMED} more" if len(pairs) > _NAMED else "")


def as_paths(mesh: Mesh, edges: IntArray, *, numbers: IntArray | None = None) -> list[str]:
    """Lines of a cuts file that cut about along `edges`: each chain by a few of its vertices, the longest first.

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    >>> as_paths(square, np.array([0, 3]))
    ['0 1 2']
    """
    called = _called(numbers)
    lines = []
    for chain in sorted(chains(mesh, edges), key=len, reverse=True):
        few = np.unique(np.linspace(0, len(chain) - 1, _POINTS).round().astype(int))
        lines.append(" ".join(str(called(chain[k])) for k in few))
    return lines


def chains(mesh: Mesh, edges: IntArray) -> list[list[int]]:
    """`edges` (k,) as paths of vertices, parted where they branch; each edge once, a closed path ends where it began."""
    left: dict[int, list[int]] = {}
    for a, b in mesh.topology.E[edges].tolist():
        left.setdefault(a, []).append(b)
        left.setdefault(b, []).append(a)
    knots = [v for v in sorted(left) if len(left[v]) != 2]
    found = []
    for start in [*knots, *sorted(left)]:  # rings have no knots
        while left[start]:
            chain = [start]
            while left[chain[-1]]:
                a = chain[-1]
                b = min(left[a])
                left[a].remove(b)
                left[b].remove(a)
                chain.append(b)
                if b in knots or b == start:
                    break
            found.append(chain)
    return found


def bounds_of(mesh: Mesh, piece: OpenPiece, cut: BoolArray) -> IntArray:
    """Edges of `cut` (e,) that the piece's border runs along, without the mesh's own border."""
    topology = piece.topology
    edges = np.unique(mesh_edges(mesh, piece, np.flatnonzero(topology.is_boundary)))
    chosen: IntArray = edges[cut[edges] & ~mesh.topology.is_boundary[edges]]
    return chosen


def idle(mesh: Mesh, piece: OpenPiece, cut: BoolArray) -> IntArray:
    """Edges of `cut` (e,) that open nothing: alone inside the piece, between two vertices that stay one each."""
    inner = mesh_edges(mesh, piece, np.flatnonzero(~piece.topology.is_boundary))
    chosen: IntArray = np.sort(inner[cut[inner]])
    return chosen


def _called(numbers: IntArray | None) -> Callable[[int], int]:
    return (lambda v: v) if numbers is None else (lambda v: int(numbers[v]))
