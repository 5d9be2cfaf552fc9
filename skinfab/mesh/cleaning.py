"""The harmless mendings, one function each: none moves a point of the surface.

Each takes vertices and faces and returns them with one sentence on what was done, or "" for nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.fans import components, corner_fans, forward_sides, surplus_faces, unbalanced_edges, winding
from skinfab.mesh.flat_faces import merge_flat_faces
from skinfab.mesh.stl import weld
from skinfab.mesh.topology import Topology

Points = NDArray[np.float64]
IntArray = NDArray[np.int64]
Mended = tuple[Points, IntArray, str]


def _several(count: int, what: str) -> str:
    plural = {"vertex": "vertices"}.get(what.split()[-1], what.split()[-1] + "s")
    return f"1 {what}" if count == 1 else f"{count} {' '.join([*what.split()[:-1], plural])}"


def drop_repeated_corners(V: Points, F: IntArray) -> Mended:
    """Drop faces that use a vertex twice."""
    bad = (F == np.roll(F, 1, axis=1)).any(axis=1)
    return V, F[~bad], f"dropped {_several(int(bad.sum()), 'degenerate face')} (first: face {np.argmax(bad)})" if bad.any() else ""


def drop_duplicates(V: Points, F: IntArray) -> Mended:
    """Of faces with the same corners keep the first (see `surplus_faces`)."""
    bad = surplus_faces(F)
    return V, F[~bad], f"dropped {_several(int(bad.sum()), 'duplicate face')} (first: face {np.argmax(bad)})" if bad.any() else ""


def weld_cracks(V: Points, F: IntArray) -> Mended:
    """Join vertices at the same place where that closes cracks and ties no knot."""
    place, index = weld(V)
    if len(place) == len(V) or not len(F):
        return V, F, ""
    before = Topology(F)
    if not before.is_boundary.any():
        return V, F, ""
    joined = index[F]
    _, proper, _ = drop_repeated_corners(place, joined)
    _, proper, _ = drop_duplicates(place, proper)
    after = Topology(proper)
    knots = int(unbalanced_edges(after, winding(after).turn).sum())
    knots_before = int(unbalanced_edges(before, winding(before).turn).sum())
    if not len(proper) or after.is_boundary.sum() >= before.is_boundary.sum() or knots > knots_before:
        return V, F, ""
    closed = int(before.is_boundary.sum() - after.is_boundary.sum())
    return place, proper, f"joined {_several(len(V) - len(place), 'coincident vertex')}, which closed {_several(closed, 'open edge')}"


def merge_flat(V: Points, F: IntArray) -> Mended:
    """Merge faces without area into their neighbours (see `merge_flat_faces`)."""
    F, merged = merge_flat_faces(V, F)
    return V, F, f"merged {_several(merged, 'face')} without area into the neighbours" if merged else ""


def wind_consistently(V: Points, F: IntArray) -> Mended:
    """Turn over the smaller part of each component so that neighbours agree, and closed shapes so that they face outward."""
    top = Topology(F)
    found = winding(top)
    turn = found.turn & ~found.one_sided
    F = np.where(turn[:, None], F[:, ::-1], F)
    said = [f"turned over {_several(int(turn.sum()), 'face')} so that neighbours agree"] if turn.any() else []
    inside_out = _inside_out(V, F)
    if inside_out.any():
        F = np.where(inside_out[:, None], F[:, ::-1], F)
        said.append(f"turned over {_several(int(inside_out.sum()), 'face')} of closed parts that faced inward")
    return V, np.ascontiguousarray(F), "; ".join(said)


def _inside_out(V: Points, F: IntArray) -> NDArray[np.bool_]:
    """(m,) faces of closed components with negative volume that lie in no other closed component's box (those are cavities)."""
    top = Topology(F)
    count, label = components(top)
    closed = np.ones(count, dtype=bool)
    closed[label[(top.edge_count[top.FE] != 2).any(axis=1)]] = False
    p = V[F] - V.mean(axis=0)
    volume = np.bincount(label, weights=np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])), minlength=count)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, label, p.min(axis=1))
    np.maximum.at(high, label, p.max(axis=1))
    turn = np.zeros(count, dtype=bool)
    for k in np.flatnonzero(closed & (volume < 0)):
        around = closed & (low <= low[k]).all(axis=1) & (high >= high[k]).all(axis=1)
        around[k] = False
        turn[k] = not around.any()
    return turn[label]


def part_sheets(V: Points, F: IntArray) -> Mended:
    """Double vertices so that every edge has two faces at most and every vertex one fan.

    Where an even number of sheets touch along an edge they are parted in pairs that enclose the solid
    between them; edges whose faces do not pair off are left for `repair`.
    """
    top = Topology(F)
    side = np.arange(3 * len(F))
    balanced = top.is_nonmanifold & ~unbalanced_edges(top, np.zeros(len(F), dtype=bool))
    plain = ~balanced[top.FE.ravel()]
    first = np.full(len(top.E), -1)
    edge = top.FE.ravel()
    first[edge[::-1]] = side[::-1]
    joined = [np.column_stack([first[edge[plain]], side[plain]])]
    if balanced.any():
        joined.append(_enclosing_pairs(V, top, balanced))
    pairs = np.vstack(joined)
    count, fan = corner_fans(top, np.column_stack([pairs[:, 0] // 3, pairs[:, 0] % 3, pairs[:, 1] // 3, pairs[:, 1] % 3]))
    source = np.empty(count, dtype=np.int64)
    source[fan.ravel()] = F.ravel()
    # The first fan of a vertex keeps its place in the list, so that an intact mesh stays as it is.
    order = np.argsort(source, kind="stable")
    again = np.zeros(count, dtype=bool)
    again[order[1:]] = source[order][1:] == source[order][:-1]
    if not again.any():
        return V, F, ""
    number = source.copy()
    number[again] = len(V) + np.arange(int(again.sum()))
    said = f"doubled {_several(int(again.sum()), 'vertex')} where sheets touch (first: vertex {source[again].min()})"
    return np.vstack([V, V[source[again]]]), number[fan], said


def split_touching(V: Points, F: IntArray) -> Mended:
    """Give sheets that touch along an edge, and hang together at both of its ends, a point of their own in its middle.

    No doubled vertex parts these, as around either end all faces are one fan: a surface folded onto itself at a single edge, as
    decimation leaves them.
    """
    split: list[str] = []
    F = F.copy()
    while True:
        top = Topology(F)
        balanced = top.is_nonmanifold & ~unbalanced_edges(top, np.zeros(len(F), dtype=bool))
        pairs = _enclosing_pairs(V, top, balanced) if balanced.any() else np.empty((0, 2), dtype=np.int64)
        chosen: list[tuple[int, list[int]]] = []
        busy: set[int] = set()
        edges: set[int] = set()
        for pair in pairs.tolist():
            faces = {side // 3 for side in pair}
            edge = int(top.FE.ravel()[pair[0]])
            apexes = {int(F[side // 3, (side % 3 + 2) % 3]) for side in pair}
            # One pair of an edge at a time, so that the last one keeps it; a flap of no thickness would only be split on and on.
            if edge not in edges and not faces & busy and len(apexes) == 2:
                chosen.append((edge, pair))
                busy |= faces
                edges.add(edge)
        if not chosen:
            break
        more = []
        for edge, pair in chosen:
            u, w = top.E[edge].tolist()
            split.append(f"{u}-{w}")
            middle = len(V)
            V = np.vstack([V, (V[u] + V[w]) / 2])
            for side in pair:
                a, b, c = np.roll(F[side // 3], -(side % 3)).tolist()
                F[side // 3] = a, middle, c
                more.append((middle, b, c))
        F = np.vstack([F, more])
    if not split:
        return V, F, ""
    V, F, turned = wind_consistently(V, F)  # only now parts may be closed, and face inward
    said = f"split {_several(len(split), 'edge')} at which sheets touch that hang together at both ends (first: edge {split[0]})"
    return V, F, said + (f"; {turned}" if turned else "")


def _enclosing_pairs(V: Points, top: Topology, balanced: NDArray[np.bool_]) -> IntArray:
    """Sides (face * 3 + side) that belong together at each edge of four faces or more, (k, 2)."""
    flat_edge = top.FE.ravel()
    forward = forward_sides(top, np.zeros(len(top.F), dtype=bool)).ravel()
    sides = np.flatnonzero(balanced[flat_edge])
    sides = sides[np.argsort(flat_edge[sides], kind="stable")]
    out: list[tuple[int, int]] = []
    for group in np.split(sides, np.flatnonzero(np.diff(flat_edge[sides])) + 1):
        u, w = top.E[flat_edge[group[0]]]
        axis = V[w] - V[u]
        apex = V[top.F[group // 3, (group % 3 + 2) % 3]] - V[u]
        across = np.eye(3)[np.argmin(np.abs(axis))]
        x = np.cross(axis, across)
        y = np.cross(axis, x)
        x, y = x / max(np.linalg.norm(x), 1e-300), y / max(np.linalg.norm(y), 1e-300)
        turn = np.arctan2(apex @ y, apex @ x)
        # A face that runs along the edge has the solid on its clockwise side: match it with the next
        # face that way which runs back, as brackets match; twice round, since a circle has no start.
        order = group[np.argsort(-turn, kind="stable")].tolist()
        waiting: list[int] = []
        seen: set[int] = set()
        for s in order + order:
            if s in seen or not (forward[s] or waiting):
                continue
            seen.add(s)
            if forward[s]:
                waiting.append(s)
            else:
                out.append((waiting.pop(), s))
    return np.array(out, dtype=np.int64).reshape(-1, 2)


def drop_unreferenced(V: Points, F: IntArray) -> Mended:
    """Drop vertices that no face uses."""
    used = np.zeros(len(V), dtype=bool)
    used[F] = True
    if used.all():
        return V, F, ""
    number = np.cumsum(used) - 1
    said = f"dropped {_several(int((~used).sum()), 'unreferenced vertex')} (first: vertex {np.argmin(used)})"
    return V[used], number[F], said
