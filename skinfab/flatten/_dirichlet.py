"""Compiled kernels of the symmetric Dirichlet energy: value, gradient, projected Hessian, first collapse."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@numba.njit(cache=True)
def _jacobian(u: FloatArray, F: IntArray, g: FloatArray, f: int) -> tuple[float, float, float, float]:
    a = b = c = d = 0.0
    for k in range(3):
        x, y = u[F[f, k], 0], u[F[f, k], 1]
        a += x * g[f, k, 0]
        b += x * g[f, k, 1]
        c += y * g[f, k, 0]
        d += y * g[f, k, 1]
    return a, b, c, d


@numba.njit(cache=True)
def energies(u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray) -> float:
    """Weighted mean of d; infinite when a triangle is flipped or collapsed."""
    total = 0.0
    for f in range(F.shape[0]):
        a, b, c, d = _jacobian(u, F, g, f)
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        total += weight[f] * (a * a + b * b + c * c + d * d) * (1.0 + 1.0 / (det * det))
    return total


@numba.njit(cache=True)
def distortions(UV: FloatArray, F: IntArray, gradients: FloatArray) -> FloatArray:
    """(m,) |J|^2 + |J^-1|^2 of each triangle's Jacobian."""
    d = np.empty(F.shape[0])
    J = np.empty((2, 2))
    for f in range(F.shape[0]):
        J[:] = 0.0
        for k in range(3):
            for c in range(2):
                for e in range(2):
                    J[c, e] += UV[F[f, k], c] * gradients[f, k, e]
        square = J[0, 0] ** 2 + J[0, 1] ** 2 + J[1, 0] ** 2 + J[1, 1] ** 2
        d[f] = square + square / (J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]) ** 2
    return d


@numba.njit(cache=True)
def extremes(u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray) -> tuple[float, float, float, float]:
    """Weighted sums of |J|^2 and of |J^-1|^2 over the triangles that are not flipped, the least singular value (negative
    where a triangle is flipped) and the largest; the last two are NaN where a coordinate is not a number."""
    stretch = squash = 0.0
    least, largest = np.inf, 0.0
    for f in range(F.shape[0]):
        a, b, c, d = _jacobian(u, F, g, f)
        q, r = np.hypot(a + d, c - b) / 2, np.hypot(a - d, c + b) / 2
        if not np.isfinite(q + r):
            return stretch, squash, np.nan, np.nan
        least, largest = min(least, q - r), max(largest, q + r)
        if q > r:
            square = weight[f] * (a * a + b * b + c * c + d * d)
            stretch += square
            squash += square / (a * d - b * c) ** 2
    return stretch, squash, least, largest


@numba.njit(cache=True)
def gradient_of(u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray) -> FloatArray:
    """The gradient alone, (2n,), where no triangle is flipped: of |J|^2 (1 + det^-2)."""
    gradient = np.zeros(2 * u.shape[0])
    for f in range(F.shape[0]):
        a, b, c, d = _jacobian(u, F, g, f)
        det = a * d - b * c
        along = 2.0 * weight[f] * (1.0 + 1.0 / (det * det))
        across = -2.0 * weight[f] * (a * a + b * b + c * c + d * d) / (det * det * det)
        pa, pb, pc, pd = along * a + across * d, along * b - across * c, along * c - across * b, along * d + across * a
        for k in range(3):
            gx, gy = g[f, k, 0], g[f, k, 1]
            gradient[2 * F[f, k]] += pa * gx + pb * gy
            gradient[2 * F[f, k] + 1] += pc * gx + pd * gy
    return gradient


@numba.njit(cache=True)
def assemble(
    u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray, place: IntArray, indptr: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Values of the lower projected Hessian (nnz,) in the pattern of `vertex_pattern`, and the gradient (2n,)."""
    data = np.zeros(indptr[-1])
    gradient = np.zeros(2 * u.shape[0])
    modes = np.empty((4, 2, 2))
    value = np.empty(4)
    w = np.empty((4, 3, 2))
    half = np.sqrt(0.5)
    for f in range(F.shape[0]):
        a, b, c, d = _jacobian(u, F, g, f)
        # Signed singular values: J = R(left) diag(s1, s2) R(right), of the turns by left + right and left - right.
        plus, minus = np.hypot(a + d, c - b), np.hypot(a - d, c + b)
        s1, s2 = (plus + minus) / 2, (plus - minus) / 2
        pc, ps = (a + d) / plus, (c - b) / plus
        mc, ms = ((a - d) / minus, (c + b) / minus) if minus > 0.0 else (1.0, 0.0)
        # Half of their sum; either half will do, as the other turn then has the same sign.
        double_c, double_s = pc * mc - ps * ms, ps * mc + pc * ms
        if double_c >= 0.0:
            cl = np.sqrt((1.0 + double_c) / 2)
            sl = double_s / (2 * cl)
        else:
            sl = np.sqrt((1.0 - double_c) / 2)
            cl = double_s / (2 * sl)
        cr, sr = pc * cl + ps * sl, ps * cl - pc * sl
        i1, i2 = 1.0 / (s1 * s1), 1.0 / (s2 * s2)
        cube = 1.0 / (s1 * s2) ** 3
        # psi = s1^2 + s2^2 + s1^-2 + s2^-2: two scaling modes, twist, flip.
        value[0], value[1] = 2 + 6 * i1 * i1, 2 + 6 * i2 * i2
        value[2] = max(2 - 2 * (s1 * s1 - s1 * s2 + s2 * s2) * cube, 0.0)
        value[3] = 2 + 2 * (s1 * s1 + s1 * s2 + s2 * s2) * cube
        # U e_i e_j^T V^T for the four (i, j), with U = R(left), V^T = R(right).
        for i in range(2):
            u0, u1 = (cl, -sl) if i == 0 else (sl, cl)
            for j in range(2):
                v0, v1 = (cr, sr) if j == 0 else (-sr, cr)
                modes[0, i, j], modes[1, i, j] = u0 * v0, u1 * v1
                modes[2, i, j], modes[3, i, j] = half * (u1 * v0 - u0 * v1), half * (u1 * v0 + u0 * v1)
        p1, p2 = weight[f] * (2 * s1 - 2 * i1 / s1), weight[f] * (2 * s2 - 2 * i2 / s2)
        for k in range(3):
            for i in range(2):
                for m in range(4):
                    w[m, k, i] = modes[m, i, 0] * g[f, k, 0] + modes[m, i, 1] * g[f, k, 1]
                gradient[2 * F[f, k] + i] += p1 * w[0, k, i] + p2 * w[1, k, i]
        for m in range(4):
            value[m] *= weight[f]
        for k in range(3):
            v = F[f, k]
            xx = xy = yy = 0.0
            for m in range(4):
                xx += value[m] * w[m, k, 0] * w[m, k, 0]
                xy += value[m] * w[m, k, 0] * w[m, k, 1]
                yy += value[m] * w[m, k, 1] * w[m, k, 1]
            data[indptr[2 * v]] += xx
            data[indptr[2 * v] + 1] += xy
            data[indptr[2 * v + 1]] += yy
            low, high = (k, (k + 1) % 3) if v < F[f, (k + 1) % 3] else ((k + 1) % 3, k)
            for i in range(2):
                x = y = 0.0
                for m in range(4):
                    x += value[m] * w[m, low, i] * w[m, high, 0]
                    y += value[m] * w[m, low, i] * w[m, high, 1]
                slot = indptr[2 * F[f, low] + i] + 2 - i + 2 * place[f, k]
                data[slot] += x
                data[slot + 1] += y
    return data, gradient


@numba.njit(cache=True)
def vertex_pattern(F: IntArray, n: int) -> tuple[IntArray, IntArray, IntArray]:
    """Lower CSC pattern of a (2n, 2n) matrix whose 2 x 2 blocks join the vertices of each triangle: indptr, indices, and
    (m, 3) which of the lower vertex's neighbours each triangle's edge k, k + 1 leads to."""
    count = np.zeros(n + 1, dtype=np.int64)
    for f in range(F.shape[0]):
        for k in range(3):
            count[min(F[f, k], F[f, (k + 1) % 3]) + 1] += 1
    first = np.cumsum(count)
    bucket = np.empty(3 * F.shape[0], dtype=np.int64)
    filled = first[:-1].copy()
    for f in range(F.shape[0]):
        for k in range(3):
            a, b = F[f, k], F[f, (k + 1) % 3]
            low = min(a, b)
            bucket[filled[low]] = max(a, b)
            filled[low] += 1
    indptr = np.zeros(2 * n + 1, dtype=np.int64)
    distinct = np.zeros(n, dtype=np.int64)
    for v in range(n):
        near = bucket[first[v] : first[v + 1]]
        near.sort()
        for k in range(near.shape[0]):
            if k == 0 or near[k] != near[k - 1]:
                near[distinct[v]] = near[k]
                distinct[v] += 1
        indptr[2 * v + 1] = indptr[2 * v] + 2 + 2 * distinct[v]
        indptr[2 * v + 2] = indptr[2 * v + 1] + 1 + 2 * distinct[v]
    indices = np.empty(indptr[-1], dtype=np.int64)
    for v in range(n):
        for i in range(2):
            slot = indptr[2 * v + i]
            for row in range(2 * v + i, 2 * v + 2):
                indices[slot] = row
                slot += 1
            for k in range(distinct[v]):
                indices[slot], indices[slot + 1] = 2 * bucket[first[v] + k], 2 * bucket[first[v] + k] + 1
                slot += 2
    place = np.empty(F.shape, dtype=np.int64)
    for f in range(F.shape[0]):
        for k in range(3):
            a, b = F[f, k], F[f, (k + 1) % 3]
            low, high = min(a, b), max(a, b)
            place[f, k] = np.searchsorted(bucket[first[low] : first[low] + distinct[low]], high)
    return indptr, indices, place


@numba.njit(cache=True)
def first_collapse(u: FloatArray, step: FloatArray, F: IntArray) -> float:
    """The smallest t > 0 at which a triangle of u + t step has no area; infinite if none has."""
    least = np.inf
    for f in range(F.shape[0]):
        i, j, k = F[f, 0], F[f, 1], F[f, 2]
        ax, ay = u[j, 0] - u[i, 0], u[j, 1] - u[i, 1]
        bx, by = u[k, 0] - u[i, 0], u[k, 1] - u[i, 1]
        px, py = step[j, 0] - step[i, 0], step[j, 1] - step[i, 1]
        qx, qy = step[k, 0] - step[i, 0], step[k, 1] - step[i, 1]
        # Twice the area along the step: c + b t + a t^2.
        a = px * qy - py * qx
        b = ax * qy + px * by - ay * qx - py * bx
        c = ax * by - ay * bx
        # The stable pair of roots, without cancellation.
        disc = b * b - 4 * a * c
        if disc < 0.0:
            continue
        h = -(b + np.sqrt(disc)) / 2 if b >= 0 else -(b - np.sqrt(disc)) / 2
        if a != 0.0 and 0.0 < h / a < least:
            least = h / a
        if h != 0.0 and 0.0 < c / h < least:
            least = c / h
    return least
