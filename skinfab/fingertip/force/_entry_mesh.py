"""Where the lines of forces enter a triangle mesh: a tree of boxes, and triangles seen along the force. Compiled.

Seen along the force the line is a point, and each corner has one image: a line through an edge has the same sign of area
towards both triangles there, so that none slips through between them.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from skinfab.fingertip.force._entry import AMBIGUOUS, MISSED, NO_CONTACT, describe, state

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
FlagArray = NDArray[np.uint8]

#: Triangles in a leaf.
_LEAF = 4
#: Deeper than any tree of halves.
_DEPTH = 64
#: Entries closer than this part of the mesh's size are one: a line through an edge enters both its triangles.
_SAME = 1e-9


def build_tree(corners: FloatArray) -> tuple[IntArray, FloatArray, FloatArray, IntArray, IntArray]:
    """Halves of halves, by the triangles' middles along the longest side of their box. Not compiled: that would take longer.

    Returns
    -------
    order : (m,) int
        Of the triangles.
    lo, hi : (k, 3) float, mm
        Boxes of the nodes.
    child : (k,) int
        First of the two children, -1 at a leaf.
    first : (k, 2) int
        The leaf's triangles in that order, from and up to.
    """
    least, most, middle = corners.min(axis=1), corners.max(axis=1), corners.mean(axis=1)
    order = np.arange(len(corners))
    lo, hi, child, first = [], [], [], [(0, len(corners))]
    for node, (a, b) in enumerate(first):  # it grows meanwhile
        of = order[a:b]
        lo.append(least[of].min(axis=0))
        hi.append(most[of].max(axis=0))
        child.append(-1)
        if b - a > _LEAF:
            half = (b - a) // 2
            order[a:b] = of[np.argpartition(middle[of, np.argmax(hi[node] - lo[node])], half)]
            child[node] = len(first)
            first += [(a, a + half), (a + half, b)]
    return order, np.array(lo), np.array(hi), np.array(child), np.array(first)


@njit(cache=True)
def _apart(lo: FloatArray, hi: FloatArray, q: FloatArray, d: FloatArray) -> float:
    """At least so far is a node's box from the line, mm: by the ball about it."""
    along, square, radius2 = 0.0, 0.0, 0.0
    for j in range(3):
        off = 0.5 * (lo[j] + hi[j]) - q[j]
        along += off * d[j]
        square += off * off
        radius2 += 0.25 * (hi[j] - lo[j]) * (hi[j] - lo[j])
    return math.sqrt(max(square - along * along, 0.0)) - math.sqrt(radius2)


@njit(cache=True)
def _seen(x: FloatArray, q: FloatArray, u: FloatArray, v: FloatArray) -> tuple[float, float]:
    """A point's image along the force, with the line at the origin."""
    ax, ay, az = x[0] - q[0], x[1] - q[1], x[2] - q[2]
    return ax * u[0] + ay * u[1] + az * u[2], ax * v[0] + ay * v[1] + az * v[2]


@njit(cache=True)
def _across(d: FloatArray, u: FloatArray, v: FloatArray) -> None:
    """Two unit vectors across d, right-handed with it (Duff et al. 2017)."""
    sign = math.copysign(1.0, d[2])
    a = -1.0 / (sign + d[2])
    b = d[0] * d[1] * a
    u[0], u[1], u[2] = 1.0 + sign * d[0] * d[0] * a, sign * b, -sign * d[0]
    v[0], v[1], v[2] = b, sign + d[1] * d[1] * a, -d[1]


@njit(cache=True)
def _entries(
    q: FloatArray,
    d: FloatArray,
    u: FloatArray,
    v: FloatArray,
    corners: FloatArray,
    lo: FloatArray,
    hi: FloatArray,
    child: IntArray,
    first: IntArray,
    same: float,
    stack: IntArray,
    point: FloatArray,
) -> tuple[int, bool]:
    """The triangle where the line first goes in (-1: none), its point, and whether it goes in elsewhere too."""
    best, least, most = -1, math.inf, -math.inf
    stack[0], top = 0, 1
    while top:
        top -= 1
        node = stack[top]
        if _apart(lo[node], hi[node], q, d) > 0.0:
            continue
        if child[node] >= 0:
            stack[top], stack[top + 1] = child[node], child[node] + 1
            top += 2
            continue
        for t in range(first[node, 0], first[node, 1]):
            ax, ay = _seen(corners[t, 0], q, u, v)
            bx, by = _seen(corners[t, 1], q, u, v)
            cx, cy = _seen(corners[t, 2], q, u, v)
            wa, wb, wc = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
            area = wa + wb + wc
            if wa > 0.0 or wb > 0.0 or wc > 0.0 or not area < 0.0:  # seen from outside it turns clockwise
                continue
            depth = 0.0
            for j in range(3):
                depth += (wa * corners[t, 0, j] + wb * corners[t, 1, j] + wc * corners[t, 2, j]) / area * d[j]
            most = max(most, depth)
            if depth < least:
                best, least = t, depth
                for j in range(3):
                    point[j] = (wa * corners[t, 0, j] + wb * corners[t, 1, j] + wc * corners[t, 2, j]) / area
    return best, most - least > same


@njit(cache=True)
def _nearest(
    q: FloatArray,
    d: FloatArray,
    u: FloatArray,
    v: FloatArray,
    corners: FloatArray,
    lo: FloatArray,
    hi: FloatArray,
    child: IntArray,
    first: IntArray,
    stack: IntArray,
    point: FloatArray,
) -> tuple[int, float]:
    """The triangle nearest to a line that enters none, its nearest point, and how far that is, mm: on an edge, seen along the line."""
    best, least = 0, math.inf
    stack[0], top = 0, 1
    while top:
        top -= 1
        node = stack[top]
        if _apart(lo[node], hi[node], q, d) >= least:
            continue
        if child[node] >= 0:
            near, far = child[node], child[node] + 1
            if _apart(lo[far], hi[far], q, d) < _apart(lo[near], hi[near], q, d):
                near, far = far, near
            stack[top], stack[top + 1] = far, near
            top += 2
            continue
        for t in range(first[node, 0], first[node, 1]):
            for c in range(3):
                a, b = corners[t, c], corners[t, (c + 1) % 3]
                ax, ay = _seen(a, q, u, v)
                bx, by = _seen(b, q, u, v)
                ex, ey = bx - ax, by - ay
                square = ex * ex + ey * ey
                part = min(max(-(ax * ex + ay * ey) / square, 0.0), 1.0) if square > 0.0 else 0.0
                far2 = math.hypot(ax + part * ex, ay + part * ey)
                if far2 < least:
                    best, least = t, far2
                    for j in range(3):
                        point[j] = a[j] + part * (b[j] - a[j])
    return best, least


@njit(cache=True)
def enter_mesh(
    F: FloatArray,
    M: FloatArray,
    corners: FloatArray,
    normals: FloatArray,
    lo: FloatArray,
    hi: FloatArray,
    child: IntArray,
    first: IntArray,
    size: float,
    least_force: float,
    force_sd: float,
    moment_sd: float,
    torsion_sd: float,
    out: FloatArray,
    flags: FlagArray,
) -> None:
    """Fill `out` (n, COLUMNS) and `flags` (n,), as `_entry.enter_hemisphere`."""
    stack = np.empty(_DEPTH, dtype=np.int64)
    q, d, u, v, point = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for k in range(len(F)):
        fx, fy, fz = F[k, 0], F[k, 1], F[k, 2]
        flag, force, q[0], q[1], q[2], torsion = state(fx, fy, fz, M[k, 0], M[k, 1], M[k, 2], least_force, force_sd, moment_sd, torsion_sd)
        row = out[k]
        if flag & NO_CONTACT:
            for j in range(3):
                row[j], row[3 + j] = corners[0, 0, j], -normals[0, j]
            row[6] = force
            row[7] = row[8] = row[9] = 0.0
            row[10] = size
            flags[k] = flag
            continue
        d[0], d[1], d[2] = fx / force, fy / force, fz / force
        _across(d, u, v)
        face, several = _entries(q, d, u, v, corners, lo, hi, child, first, _SAME * size, stack, point)
        miss = 0.0
        if face < 0:
            flag |= MISSED
            face, miss = _nearest(q, d, u, v, corners, lo, hi, child, first, stack, point)
        elif several:
            flag |= AMBIGUOUS
        for j in range(3):
            row[j], row[3 + j] = point[j], -normals[face, j]
        describe(row, fx, fy, fz, force, torsion, miss, size, force_sd, moment_sd)
        flags[k] = flag
