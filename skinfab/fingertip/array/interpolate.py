"""A continuous deflection f(x, y) through the tactels' readings: sums of one kernel along the finger times one around it.

x counts rings and y stripes, both in tactel spacings; y is closed. Beyond the first and the last ring there is nothing: those
terms are left out, as in the seed's equation 4.

The seed's window (its equation 5) is that of samples numbered from 0: used as it is printed, about each sample, it is zero at the
sample itself. Here it is centred: w(n) = (1 + cos(2 pi n / (N - 1))) / 2 for |n| <= (N - 1) / 2.
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

SINC, BSPLINE, GAUSSIAN = 0, 1, 2
#: The interpolators by name.
KERNELS = {"sinc": SINC, "bspline": BSPLINE, "gaussian": GAUSSIAN}
#: N of the window: the seed's 8 samples an axis, also where there are more.
WINDOW = 8
#: Standard deviation of the Gaussian kernel, in spacings: its ripple on a constant is that of the windowed sinc (0.13 %).
SIGMA = 0.6
#: So many samples count at most, on an axis.
_TAPS = 8
_REACH = (WINDOW - 1) / 2
#: Closer to a sample than this the series of sin(p) / p is used: quotients would lose digits.
_NEAR = 0.01


@numba.njit(cache=True)
def kernel(kind: int, u: float) -> tuple[float, float, float]:
    """The kernel at u spacings from its sample, its slope and its curvature."""
    if kind == BSPLINE:
        a = abs(u)
        sign = 1.0 if u > 0 else -1.0
        if a >= 2:
            return 0.0, 0.0, 0.0
        if a >= 1:
            return (2 - a) ** 3 / 6, -sign * (2 - a) ** 2 / 2, 2 - a
        return 2 / 3 - a * a + a**3 / 2, sign * (1.5 * a * a - 2 * a), 3 * a - 2
    if abs(u) > _REACH:
        return 0.0, 0.0, 0.0
    if kind == GAUSSIAN:
        v = u / SIGMA
        g = math.exp(-0.5 * v * v) / (SIGMA * math.sqrt(2 * math.pi))
        return g, -v / SIGMA * g, (v * v - 1) / SIGMA**2 * g
    p = math.pi * u
    if abs(u) < _NEAR:
        q = p * p
        s, ds = 1 - q / 6 * (1 - q / 20), -math.pi * p / 3 * (1 - q / 10 * (1 - q / 28))
        dds = math.pi**2 * (-1 / 3 + q / 10 * (1 - q / 16.8))
    else:
        s = math.sin(p) / p
        ds = (math.cos(p) - s) / u
        dds = -(math.pi**2) * s - 2 * ds / u
    q = 2 * math.pi / (WINDOW - 1)
    c, e = math.cos(q * u), math.sin(q * u)
    w, dw, ddw = (1 + c) / 2, -q * e / 2, -q * q * c / 2
    return s * w, ds * w + s * dw, dds * w + 2 * ds * dw + s * ddw


@numba.njit(cache=True)
def _weights(kind: int, x: float, out: FloatArray) -> int:
    """Kernel, slope and curvature (3, 8) of the samples around x; the first sample's number is returned."""
    first = math.floor(x) - _TAPS // 2 + 1
    if kind != SINC:
        for k in range(_TAPS):
            out[0, k], out[1, k], out[2, k] = kernel(kind, x - (first + k))
        return first
    # Sines and cosines of one sample, turned on to the next: four of them instead of 32.
    u = x - first
    q = 2 * math.pi / (WINDOW - 1)
    sp, cp, c, e = math.sin(math.pi * u), math.cos(math.pi * u), math.cos(q * u), math.sin(q * u)
    cq, sq = math.cos(q), math.sin(q)
    for k in range(_TAPS):
        v = u - k
        if abs(v) < _NEAR or abs(v) > _REACH:
            out[0, k], out[1, k], out[2, k] = kernel(SINC, v)
        else:
            s = sp / (math.pi * v)
            ds = (cp - s) / v
            dds = -(math.pi**2) * s - 2 * ds / v
            w, dw, ddw = (1 + c) / 2, -q * e / 2, -q * q * c / 2
            out[0, k], out[1, k], out[2, k] = s * w, ds * w + s * dw, dds * w + 2 * ds * dw + s * ddw
        sp, cp = -sp, -cp
        c, e = c * cq + e * sq, e * cq - c * sq
    return first


@numba.njit(cache=True)
def surface_at(Z: FloatArray, kind: int, x: float, y: float) -> tuple[float, float, float, float, float, float]:
    """f, fx, fy, fxx, fxy, fyy at a place, all in tactel spacings.

    Parameters
    ----------
    Z : (rings, stripes) float
        Coefficients, as `coefficients` gives them.
    kind : int
    x, y : float

    Examples
    --------
    >>> Z = np.zeros((8, 8)); Z[3, 7] = 2.0
    >>> surface_at(Z, SINC, 3.0, -1.0)[0]
    2.0
    """
    rings, stripes = Z.shape
    wx, wy = np.empty((3, _TAPS)), np.empty((3, _TAPS))
    first_i, first_j = _weights(kind, x, wx), _weights(kind, y, wy)
    f = fx = fy = fxx = fxy = fyy = 0.0
    for a in range(_TAPS):
        i = first_i + a
        if i < 0 or i >= rings:
            continue
        g = gy = gyy = 0.0
        for b in range(_TAPS):
            if wy[0, b] == 0.0 and wy[2, b] == 0.0:
                continue
            z = Z[i, (first_j + b) % stripes]
            g += wy[0, b] * z
            gy += wy[1, b] * z
            gyy += wy[2, b] * z
        f += wx[0, a] * g
        fx += wx[1, a] * g
        fxx += wx[2, a] * g
        fy += wx[0, a] * gy
        fxy += wx[1, a] * gy
        fyy += wx[0, a] * gyy
    return f, fx, fy, fxx, fxy, fyy


@numba.njit(cache=True)
def on_grid(Z: FloatArray, kind: int, x: FloatArray, y: FloatArray) -> FloatArray:
    """f at all pairs of x (p,) and y (q,): (p, q)."""
    out = np.empty((len(x), len(y)))
    for a in range(len(x)):
        for b in range(len(y)):
            out[a, b] = surface_at(Z, kind, x[a], y[b])[0]
    return out


def kind_of(name: str) -> int:
    """An interpolator's number.

    Raises
    ------
    InputError
        There is none of this name.
    """
    if name not in KERNELS:
        raise InputError(f"there is no interpolator {name!r}; there are {', '.join(KERNELS)}")
    return KERNELS[name]


class Coefficients:
    """What a kernel is multiplied with, so that f goes through the readings (sinc, B-spline) or smooths them (Gaussian).

    A B-spline goes through them only once they are filtered: closed around, nothing beyond the ends along; one linear map an axis.

    Examples
    --------
    >>> Z = np.random.default_rng(0).random((8, 8))
    >>> C = Coefficients("bspline", (8, 8))(Z)
    >>> bool(abs(surface_at(C, BSPLINE, 3.0, 7.0)[0] - Z[3, 7]) < 1e-12)
    True
    """

    def __init__(self, name: str, shape: tuple[int, int]) -> None:
        self.kind = kind_of(name)
        self._maps: tuple[FloatArray, FloatArray] | None = None
        if self.kind == BSPLINE:
            self._maps = _unspline(shape[0], closed=False), _unspline(shape[1], closed=True)

    def __call__(self, Z: FloatArray) -> FloatArray:
        """Of the readings (rings, stripes)."""
        if self._maps is None:
            return Z
        along, around = self._maps
        out: FloatArray = along @ Z @ around.T
        return out


def _unspline(n: int, *, closed: bool) -> FloatArray:
    """Readings to B-spline coefficients."""
    A = 2 / 3 * np.eye(n) + (np.eye(n, k=1) + np.eye(n, k=-1)) / 6
    if closed:
        A[0, -1] = A[-1, 0] = 1 / 6
    # What lies beyond the ends is left out of f (as for the other kernels), so nothing is mirrored in.
    return np.asarray(np.linalg.inv(A), dtype=float)
