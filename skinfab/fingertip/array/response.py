"""What a tactel of finite size reads of a force on the skin: the strain of an elastic half space, averaged over the tactel exactly.

A force (normal P, tangential Q) at the origin of the surface strains the medium at depth z, in its direction, by

    e = (1 + nu) / (2 pi E) (P z + Q . r) (3 z^2 / R^5 - 2 nu / R^3),   R^2 = r^2 + z^2

(Boussinesq and Cerruti; K. L. Johnson, Contact Mechanics, 1985, sections 3.2 and 3.6). Both parts have closed integrals over a
rectangle, so a tactel's reading needs no quadrature. Lengths in mm, E in N/mm^2 (MPa), forces in N.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@numba.njit(cache=True)
def _normal(x: float, y: float, z: float, nu: float) -> float:
    """Integral of z (3 z^2 / R^5 - 2 nu / R^3) over the rectangle from 0 to (x, y)."""
    a, b = x * x + z * z, y * y + z * z
    R = math.sqrt(a + y * y)
    solid = (1 - 2 * nu) * math.atan(x * y / (z * R)) if nu != 0.5 else 0.0
    return x * y * z / R * (1 / a + 1 / b) + solid


@numba.njit(cache=True)
def _normal_with_slopes(x: float, y: float, z: float, nu: float) -> tuple[float, float, float]:
    """The same, and differentiated by x and by y."""
    zz = z * z
    a, b = x * x + zz, y * y + zz
    R = math.sqrt(a + y * y)
    ia, ib, iR = 1 / a, 1 / b, 1 / R
    value = x * y * z * iR * (ia + ib)
    if nu != 0.5:
        value += (1 - 2 * nu) * math.atan(x * y * iR / z)
    common = zz * iR * iR - 2 * nu
    return value, z * y * ia * iR * (common + 2 * zz * ia), z * x * ib * iR * (common + 2 * zz * ib)


@numba.njit(cache=True)
def _tangential(x: float, y: float, z: float, nu: float) -> float:
    """Integral of x (3 z^2 / R^5 - 2 nu / R^3), the part of a force along x, up to what no rectangle sees."""
    a = x * x + z * z
    return 2 * nu * math.asinh(y / math.sqrt(a)) - z * z * y / (a * math.sqrt(a + y * y))


@numba.njit(cache=True)
def add_force(
    out: FloatArray,
    force: tuple[float, float, float],
    at: tuple[float, float],
    pitch: tuple[float, float],
    half: tuple[float, float],
    z: float,
    nu: float,
) -> None:
    """Add the readings times E of a force (normal, axial, around; N) at (axial, around; mm) to `out` (rings, stripes).

    The second axis is closed: a tactel feels the force by the shorter way round. `pitch` are distances of tactels, `half` half of
    their sizes, mm.
    """
    rings, stripes = out.shape
    P, Q, S = force
    turn = stripes * pitch[1]
    scale = (1 + nu) / (2 * math.pi) / (4 * half[0] * half[1])
    for j in range(stripes):
        y = j * pitch[1] - at[1]
        y -= turn * math.floor(y / turn + 0.5)
        for i in range(rings):
            x = i * pitch[0] - at[0]
            total = 0.0
            for u in (-1, 1):
                for v in (-1, 1):
                    cx, cy = x + u * half[0], y + v * half[1]
                    part = P * _normal(cx, cy, z, nu)
                    if Q != 0.0:
                        part += Q * _tangential(cx, cy, z, nu)
                    if S != 0.0:
                        part += S * _tangential(cy, cx, z, nu)
                    total += u * v * part
            out[i, j] += scale * total


@numba.njit(cache=True)
def normal_window(
    out: FloatArray,
    window: tuple[int, int, int, int],
    at: tuple[float, float],
    pitch: tuple[float, float],
    half: tuple[float, float],
    z: float,
    nu: float,
) -> None:
    """Readings times E of 1 N, and their derivatives by its place, of the tactels of a window.

    Parameters
    ----------
    out : (3, p, q) float
        Reading, derivative by the axial place and by that around, per mm.
    window : tuple of int
        First ring, number p of rings, first stripe (may be negative or beyond the last: the axis is closed), number q of stripes.
    at, pitch, half, z, nu
        As in `add_force`; `at` on the branch of the closed axis that is next to the window's stripes.
    """
    first_i, p, first_j, q = window
    scale = (1 + nu) / (2 * math.pi) / (4 * half[0] * half[1])
    for b in range(q):
        y = (first_j + b) * pitch[1] - at[1]
        for a in range(p):
            x = (first_i + a) * pitch[0] - at[0]
            n = dx = dy = 0.0
            for u in (-1, 1):
                for v in (-1, 1):
                    value, along, around = _normal_with_slopes(x + u * half[0], y + v * half[1], z, nu)
                    n, dx, dy = n + u * v * value, dx - u * v * along, dy - u * v * around
            out[0, a, b], out[1, a, b], out[2, a, b] = scale * n, scale * dx, scale * dy
