"""Boundary curves of BFF: the closing of a polygon, and its turning angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def scaled_lengths(length: FloatArray, u: FloatArray) -> FloatArray:
    """(b,) mm: edges from vertex k to k + 1 under the log scale factors u (b,) of the vertices (section 4.3)."""
    scaled: FloatArray = length * np.exp((u + np.roll(u, -1)) / 2)
    return scaled


def vertex_scale(length: FloatArray, target: FloatArray) -> FloatArray:
    """(b,) log scale factors of the vertices that take edges of `length` to `target`, both (b,) mm: the edges' mean, by target length.

    Examples
    --------
    >>> vertex_scale(np.ones(3), np.full(3, 2.0)).round(6).tolist()
    [0.693147, 0.693147, 0.693147]
    """
    u = np.log(target / length)
    before = np.roll(target, 1)
    mean: FloatArray = (before * np.roll(u, 1) + target * u) / (before + target)
    return mean


def close_curve(length: FloatArray, turning: FloatArray) -> FloatArray:
    """The closed polygon with these turning angles whose edge lengths are nearest to the given ones (section 4.3).

    Parameters
    ----------
    length : (b,) float, mm
        Of the edge from vertex k to k + 1.
    turning : (b,) float, rad
        At vertex k, 2 pi together. The first edge runs along x.

    Returns
    -------
    (b, 2) float, mm
        The first vertex at the origin.

    Examples
    --------
    >>> close_curve(np.array([2.0, 1, 2, 1]), np.full(4, np.pi / 2)).round(9)[2].tolist()
    [2.0, 1.0]
    """
    direction = np.cumsum(turning) - turning[0]
    T = np.stack([np.cos(direction), np.sin(direction)])
    # Weighted least squares: a long edge takes its share of the closing error.
    weighted = T * length
    closed = length - length * (T.T @ np.linalg.solve(weighted @ T.T, T @ length))
    steps = closed * T
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=1).T[:-1]])


def turning_of(curve: FloatArray) -> FloatArray:
    """(k,) rad in (-pi, pi]: how far a closed polygon (k, 2) turns at each vertex.

    Examples
    --------
    >>> np.degrees(turning_of(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))).tolist()
    [90.0, 90.0, 90.0, 90.0]
    """
    z = curve[:, 0] + 1j * curve[:, 1]
    after = np.roll(z, -1) - z
    turned: FloatArray = np.angle(after * np.conj(np.roll(after, 1)))
    return turned
