"""Compiled kernels of the symmetric Dirichlet energy: value, gradient, projected Hessian, first collapse."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@numba.njit(cache=True)
def energies(u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray) -> float:
    """Weighted mean of d; infinite when a triangle is flipped or collapsed."""
    total = 0.0
    for f in range(F.shape[0]):
        a = b = c = d = 0.0
        for k in range(3):
            x, y = u[F[f, k], 0], u[F[f, k], 1]
            a += x * g[f, k, 0]
            b += x * g[f, k, 1]
            c += y * g[f, k, 0]
            d += y * g[f, k, 1]
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        total += weight[f] * (a * a + b * b + c * c + d * d) * (1.0 + 1.0 / (det * det))
    return total


@numba.njit(cache=True)
def assemble(u: FloatArray, F: IntArray, g: FloatArray, weight: FloatArray, slots: IntArray, nnz: int) -> tuple[FloatArray, FloatArray]:
    """Values of the lower projected Hessian (nnz,) and the gradient (2n,)."""
    data = np.zeros(nnz)
    gradient = np.zeros(2 * u.shape[0])
    modes = np.empty((4, 2, 2))
    value = np.empty(4)
    w = np.empty((4, 6))
    for f in range(F.shape[0]):
        a = b = c = d = 0.0
        for k in range(3):
            x, y = u[F[f, k], 0], u[F[f, k], 1]
            a += x * g[f, k, 0]
            b += x * g[f, k, 1]
            c += y * g[f, k, 0]
            d += y * g[f, k, 1]
        # Signed singular values: J = R(left) diag(s1, s2) R(right).
        q, r = np.hypot(a + d, c - b) / 2, np.hypot(a - d, c + b) / 2
        s1, s2 = q + r, q - r
        minus, plus = np.arctan2(c + b, a - d), np.arctan2(c - b, a + d)
        left, right = (plus + minus) / 2, (plus - minus) / 2
        cl, sl, cr, sr = np.cos(left), np.sin(left), np.cos(right), np.sin(right)
        det = s1 * s2
        cube = det * det * det
        # psi = s1^2 + s2^2 + s1^-2 + s2^-2: two scaling modes, twist, flip.
        value[0], value[1] = 2 + 6 / s1**4, 2 + 6 / s2**4
        value[2] = max(2 - 2 * (s1 * s1 - s1 * s2 + s2 * s2) / cube, 0.0)
        value[3] = 2 + 2 * (s1 * s1 + s1 * s2 + s2 * s2) / cube
        # U e_i e_j^T V^T for the four (i, j), with U = R(left), V^T = R(right).
        half = np.sqrt(0.5)
        for i in range(2):
            u0, u1 = (cl, -sl) if i == 0 else (sl, cl)
            for j in range(2):
                v0, v1 = (cr, sr) if j == 0 else (-sr, cr)
                modes[0, i, j], modes[1, i, j] = u0 * v0, u1 * v1
                modes[2, i, j], modes[3, i, j] = half * (u1 * v0 - u0 * v1), half * (u1 * v0 + u0 * v1)
        p1, p2 = 2 * s1 - 2 / s1**3, 2 * s2 - 2 / s2**3
        for k in range(3):
            for i in range(2):
                for m in range(4):
                    w[m, 2 * k + i] = modes[m, i, 0] * g[f, k, 0] + modes[m, i, 1] * g[f, k, 1]
                gradient[2 * F[f, k] + i] += weight[f] * (p1 * w[0, 2 * k + i] + p2 * w[1, 2 * k + i])
        slot = 0
        for i in range(6):
            for j in range(i + 1):
                h = value[0] * w[0, i] * w[0, j] + value[1] * w[1, i] * w[1, j]
                h += value[2] * w[2, i] * w[2, j] + value[3] * w[3, i] * w[3, j]
                data[slots[f, slot]] += weight[f] * h
                slot += 1
    return data, gradient


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
