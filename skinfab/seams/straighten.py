"""Seams that came from other triangles zigzag: between their branches and ends they are drawn along the cheapest ways near by."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from skinfab.mesh.model import Mesh
from skinfab.seams.graph import edge_graph, trace

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


def straightened(mesh: Mesh, cut: BoolArray, weight: FloatArray, *, reach: float, fixed: BoolArray | None = None) -> BoolArray:
    """Each unbranched run of seam replaced by the cheapest way between its ends that stays near it and clear of all others.

    Parameters
    ----------
    mesh : Mesh
    cut : (e,) bool
    weight : (e,) float
        Cost of cutting each edge.
    reach : float, mm
        No new seam is farther from the run that it replaces.
    fixed : (e,) bool, optional
        Stay cut.

    Returns
    -------
    (e,) bool

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(4.0), np.arange(4.0))
    >>> a = np.array([0, 1, 2, 4, 5, 6, 8, 9, 10])
    >>> F = np.concatenate([np.column_stack([a, a + 1, a + 5]), np.column_stack([a, a + 5, a + 4])])
    >>> mesh = Mesh(np.column_stack([x.ravel(), y.ravel(), np.zeros(16)]), F)
    >>> cut = np.zeros(len(mesh.topology.E), dtype=bool)
    >>> cut[mesh.topology.edge_ids(np.array([[5, 9], [9, 10]]))] = True
    >>> mesh.topology.E[straightened(mesh, cut, mesh.edge_lengths, reach=1.0)].tolist()
    [[5, 10]]
    """
    topology = mesh.topology
    stay = np.zeros_like(cut) if fixed is None else cut & fixed
    taken = np.zeros(len(mesh.V), dtype=bool)
    taken[topology.E[cut]] = True
    graph = edge_graph(topology, weight, len(mesh.V))
    result = cut.copy()
    for run in _runs(mesh, cut & ~stay, stay):
        inner = run[1:-1]
        taken[inner] = False
        near = np.isfinite(cKDTree(mesh.V[run]).query(mesh.V, distance_upper_bound=reach)[0]) & ~taken
        near[run] = True
        allowed = np.flatnonzero(near)
        start, end = np.searchsorted(allowed, run[[0, -1]])
        _, before = dijkstra(graph[allowed][:, allowed], indices=start, return_predecessors=True)
        way = allowed[trace(before.astype(np.int64), int(end))]
        old, new = topology.edge_ids(np.stack([run[:-1], run[1:]], axis=1)), topology.edge_ids(way)
        # Within rounding the old run is as cheap: seams stay where they are.
        if len(new) and weight[new].sum() < weight[old].sum() * (1 - 1e-9):
            result[old] = False
            result[new] = True
            taken[way] = True
        else:
            taken[inner] = True
    return result


def _runs(mesh: Mesh, cut: BoolArray, stay: BoolArray) -> list[IntArray]:
    """Vertices along each unbranched run of cut edges with two different ends."""
    topology = mesh.topology
    E = topology.E[cut]
    is_node = np.bincount(E.ravel(), minlength=len(mesh.V)) != 2
    is_node[topology.E[stay]] = True
    is_node[topology.E[topology.is_boundary]] = True
    at: dict[int, list[tuple[int, int]]] = {}
    for k, (a, b) in enumerate(E.tolist()):
        at.setdefault(a, []).append((k, b))
        at.setdefault(b, []).append((k, a))
    done, runs = np.zeros(len(E), dtype=bool), []
    for start in [v for v in at if is_node[v]]:
        for k, v in at[start]:
            run = [start]
            while not done[k]:
                done[k] = True
                run.append(v)
                if not is_node[v]:
                    k, v = next((other, w) for other, w in at[v] if other != k)
            if len(run) > 2 and run[0] != run[-1]:
                runs.append(np.array(run))
    return runs
