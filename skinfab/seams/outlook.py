"""Where darts may go: bad spots of a sheet, and the cheapest way from each to its boundary."""

from __future__ import annotations

import heapq
from itertools import pairwise

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.seams.release import Way
from skinfab.seams.sheet import Sheet

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: A single needle triangle must not draw every dart to itself.
_WORST_D = 50.0

#: Beyond this part of the root of the area a spot is no better for lying farther from the boundary.
_FAR = 0.5

#: An angle defect of 1 rad makes a spot so many times more worth ending at, and one.
_POINTED = 4.0


def dart_ways(sheet: Sheet, *, count: int, apart: float) -> list[Way]:
    """Up to `count` ways for a dart, each from the boundary to another bad spot.

    In turn by excess of d, curvature and distance to the boundary; by excess alone; by excess and distance.

    Parameters
    ----------
    sheet : Sheet
    count : int
    apart : float, mm
        No two of the spots are nearer to each other.

    Returns
    -------
    list of Way
        Vertices of the sheet, edges of the surface.
    """
    surface = sheet.surface
    mesh, topology = surface.mesh, surface.mesh.topology
    is_source = np.zeros(len(mesh.V), dtype=bool)
    is_source[topology.E[sheet.cut | topology.is_boundary]] = True
    if is_source.all():
        return []
    distance, before, by = _nearest_source(*surface.neighbours, surface.weight, is_source)
    area, corner, n = mesh.face_areas, mesh.F.ravel(), len(mesh.V)
    around = np.maximum(np.bincount(corner, np.repeat(area, 3), n), np.finfo(float).tiny)
    excess = np.bincount(corner, np.repeat((np.minimum(sheet.d, _WORST_D) - 4) * area, 3), n) / around
    reach = np.minimum(distance / surface.size, _FAR)
    scores = np.stack([excess * reach * (1 + _POINTED * surface.curvature), excess, excess * distance])
    scores[:, is_source | ~np.isfinite(distance)] = -np.inf
    tips = _apart_tips(scores, mesh.V, count, apart)
    of_vertex = np.empty(n, dtype=np.int64)
    of_vertex[sheet.origin] = np.arange(len(sheet.origin))
    start, vertices, edges = _walks(tips, before, by)
    path = of_vertex[vertices]
    # On the boundary a vertex of the surface may be several of the sheet: the one that the first edge begins at.
    first = start[:-1]
    face = sheet.EF[edges[first], 0]
    path[first] = sheet.F[face][mesh.F[face] == vertices[first, None]]
    return [Way(path[a:b], edges[a : b - 1]) for a, b in pairwise(start.tolist())]


@numba.njit(cache=True)
def _walks(tips: IntArray, before: IntArray, by: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """From the boundary to each tip: where each begins, the vertices, and the edge after each (-1 after a tip)."""
    start = np.zeros(tips.shape[0] + 1, dtype=np.int64)
    for k in range(tips.shape[0]):
        start[k + 1] = start[k] + 1
        v = tips[k]
        while before[v] >= 0:
            v = before[v]
            start[k + 1] += 1
    vertices, edges = np.empty(start[-1], dtype=np.int64), np.full(start[-1], -1)
    for k in range(tips.shape[0]):
        at = start[k + 1] - 1
        vertices[at] = tips[k]
        while before[vertices[at]] >= 0:
            vertices[at - 1], edges[at - 1] = before[vertices[at]], by[vertices[at]]
            at -= 1
    return start, vertices, edges


@numba.njit(cache=True)
def _nearest_source(
    first: IntArray, near: IntArray, edge: IntArray, weight: FloatArray, is_source: BoolArray
) -> tuple[FloatArray, IntArray, IntArray]:
    """Dijkstra from all sources at once: distance, the vertex before each (-1 at a source) and the edge to it."""
    n = is_source.shape[0]
    distance, before, by = np.full(n, np.inf), np.full(n, -1), np.full(n, -1)
    heap = [(0.0, -1)]
    for v in range(n):
        if is_source[v]:
            distance[v] = 0.0
            heapq.heappush(heap, (0.0, v))
    while heap:
        reached, v = heapq.heappop(heap)
        if v < 0 or reached > distance[v]:
            continue
        for k in range(first[v], first[v + 1]):
            w = near[k]
            further = reached + weight[edge[k]]
            if further < distance[w]:
                distance[w], before[w], by[w] = further, v, edge[k]
                heapq.heappush(heap, (further, w))
    return distance, before, by


@numba.njit(cache=True)
def _apart_tips(scores: FloatArray, V: FloatArray, count: int, apart: float) -> IntArray:
    """The best vertex by each score in turn, none nearer than `apart` to another."""
    tips = np.empty(count, dtype=np.int64)
    for k in range(count):
        score = scores[k % scores.shape[0]]
        tip = np.argmax(score)
        if not np.isfinite(score[tip]):
            return tips[:k].copy()
        tips[k] = tip
        for v in range(V.shape[0]):
            if v == tip or (V[v, 0] - V[tip, 0]) ** 2 + (V[v, 1] - V[tip, 1]) ** 2 + (V[v, 2] - V[tip, 2]) ** 2 < apart**2:
                scores[:, v] = -np.inf
    return tips
