"""Compiled kernels that keep a flat piece's boundary from crossing itself: barrier and first crossing."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@numba.njit(cache=True)
def _nearest(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> tuple[float, float, float, float]:
    """Distance from p to segment ab, the unit normal towards p, and where on the segment."""
    ex, ey = bx - ax, by - ay
    length2 = ex * ex + ey * ey
    t = min(max(((px - ax) * ex + (py - ay) * ey) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    dx, dy = px - ax - t * ex, py - ay - t * ey
    distance = np.sqrt(dx * dx + dy * dy)
    if distance == 0.0:
        return 0.0, 0.0, 0.0, t
    return distance, dx / distance, dy / distance, t


@numba.njit(cache=True)
def barrier_energy(u: FloatArray, loop: IntArray, reach: float) -> float:
    """Sum over vertices and edges of the loop that are not neighbours of (reach / distance - 1)^2 within reach."""
    n = loop.shape[0]
    total = 0.0
    for j in range(n):
        a, b = loop[j], loop[(j + 1) % n]
        low_x, high_x = min(u[a, 0], u[b, 0]) - reach, max(u[a, 0], u[b, 0]) + reach
        low_y, high_y = min(u[a, 1], u[b, 1]) - reach, max(u[a, 1], u[b, 1]) + reach
        for i in range(n):
            p = loop[i]
            x, y = u[p, 0], u[p, 1]
            if x < low_x or x > high_x or y < low_y or y > high_y or p in (a, b):
                continue
            distance = _nearest(x, y, u[a, 0], u[a, 1], u[b, 0], u[b, 1])[0]
            if distance <= 0.0:
                return np.inf
            if distance < reach:
                total += (reach / distance - 1.0) ** 2
    return total


@numba.njit(cache=True)
def near_pairs(u: FloatArray, loop: IntArray, within: float) -> IntArray:
    """Vertices of the loop with the edges that they do not bound and are nearer to than `within`: (k, 3) vertex, edge's ends."""
    n = loop.shape[0]
    found = np.empty((4 * n, 3), dtype=np.int64)
    count = 0
    for j in range(n):
        a, b = loop[j], loop[(j + 1) % n]
        low_x, high_x = min(u[a, 0], u[b, 0]) - within, max(u[a, 0], u[b, 0]) + within
        low_y, high_y = min(u[a, 1], u[b, 1]) - within, max(u[a, 1], u[b, 1]) + within
        for i in range(n):
            p = loop[i]
            x, y = u[p, 0], u[p, 1]
            if x < low_x or x > high_x or y < low_y or y > high_y or p in (a, b):
                continue
            if _nearest(x, y, u[a, 0], u[a, 1], u[b, 0], u[b, 1])[0] >= within:
                continue
            if count == found.shape[0]:
                found = np.concatenate((found, np.empty_like(found)))
            found[count, 0], found[count, 1], found[count, 2] = p, a, b
            count += 1
    return found[:count].copy()


@numba.njit(cache=True)
def barrier_gradient(u: FloatArray, pairs: IntArray, reach: float, weight: float, gradient: FloatArray) -> None:
    """Add the barrier's gradient; `pairs` are all that are within reach, others do no harm."""
    for q in range(pairs.shape[0]):
        p, a, b = pairs[q]
        distance, nx, ny, t = _nearest(u[p, 0], u[p, 1], u[a, 0], u[a, 1], u[b, 0], u[b, 1])
        if not 0.0 < distance < reach:
            continue
        near = reach / distance
        first = -2.0 * (near - 1.0) * near / distance * weight
        for v, c in ((p, 1.0), (a, t - 1.0), (b, -t)):
            gradient[2 * v] += first * c * nx
            gradient[2 * v + 1] += first * c * ny


@numba.njit(cache=True)
def barrier_hessian(
    u: FloatArray, pairs: IntArray, place: IntArray, reach: float, weight: float, indptr: IntArray, data: FloatArray
) -> None:
    """Add its Gauss-Newton Hessian to the values of a pattern that joins each pair's vertices as `vertex_pattern` does.

    The couplings count: without them two sides in contact would not slide or move together.
    """
    coefficient = np.empty(3)
    for q in range(pairs.shape[0]):
        p, a, b = pairs[q]
        distance, nx, ny, t = _nearest(u[p, 0], u[p, 1], u[a, 0], u[a, 1], u[b, 0], u[b, 1])
        if not 0.0 < distance < reach:
            continue
        near = reach / distance
        second = (2.0 * near * near + 4.0 * (near - 1.0) * near) / (distance * distance) * weight
        coefficient[0], coefficient[1], coefficient[2] = 1.0, t - 1.0, -t
        for k in range(3):
            v, w = pairs[q, k], pairs[q, (k + 1) % 3]
            h = second * coefficient[k] ** 2
            data[indptr[2 * v]] += h * nx * nx
            data[indptr[2 * v] + 1] += h * nx * ny
            data[indptr[2 * v + 1]] += h * ny * ny
            h = second * coefficient[k] * coefficient[(k + 1) % 3]
            for i, n in ((0, nx), (1, ny)):
                slot = indptr[2 * min(v, w) + i] + 2 - i + 2 * place[q, k]
                data[slot] += h * n * nx
                data[slot + 1] += h * n * ny


@numba.njit(cache=True)
def first_crossing(u: FloatArray, step: FloatArray, loop: IntArray, most: float) -> float:
    """The smallest t in (0, most] at which a vertex of the loop meets an edge that it does not bound; infinite if none."""
    n = loop.shape[0]
    least = np.inf
    for j in range(n):
        a, b = loop[j], loop[(j + 1) % n]
        ax, ay, bx, by = u[a, 0], u[a, 1], u[b, 0], u[b, 1]
        sax, say, sbx, sby = step[a, 0], step[a, 1], step[b, 0], step[b, 1]
        reach = min(least, most)
        low_x = min(min(ax, bx), min(ax + reach * sax, bx + reach * sbx))
        high_x = max(max(ax, bx), max(ax + reach * sax, bx + reach * sbx))
        low_y = min(min(ay, by), min(ay + reach * say, by + reach * sby))
        high_y = max(max(ay, by), max(ay + reach * say, by + reach * sby))
        for i in range(n):
            p = loop[i]
            px, py, sx, sy = u[p, 0], u[p, 1], step[p, 0], step[p, 1]
            if max(px, px + reach * sx) < low_x or min(px, px + reach * sx) > high_x:
                continue
            if max(py, py + reach * sy) < low_y or min(py, py + reach * sy) > high_y or p in (a, b):
                continue
            # Twice the area of (a, b, p) along the step: c + q t + r t^2.
            ex, ey, dx, dy = bx - ax, by - ay, px - ax, py - ay
            gx, gy, hx, hy = sbx - sax, sby - say, sx - sax, sy - say
            r = gx * hy - gy * hx
            q = ex * hy + gx * dy - ey * hx - gy * dx
            c = ex * dy - ey * dx
            disc = q * q - 4.0 * r * c
            if disc < 0.0:
                continue
            root = -(q + np.sqrt(disc)) / 2 if q >= 0 else -(q - np.sqrt(disc)) / 2
            for k in range(2):
                over, under = (root, r) if k == 0 else (c, root)
                t = over / under if under != 0.0 else np.inf
                if not 0.0 < t < least or t > most:
                    continue
                fx, fy, wx, wy = ex + t * gx, ey + t * gy, dx + t * hx, dy + t * hy
                along = wx * fx + wy * fy
                if 0.0 <= along <= fx * fx + fy * fy:
                    least = t
    return least
