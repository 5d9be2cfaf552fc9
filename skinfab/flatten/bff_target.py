"""Target shapes for BFF: scale factors and turning angles of the boundary, in turn, until the boundary lies on the shape.

Turning angles read off the shape at the present edge lengths give new scale factors, those new lengths
(Sawhney and Crane 2017, section 6). Both functions take the boundary's edge lengths and the Neumann-to-Dirichlet
map of a solver, and give the boundary's places.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff_curve import along, scaled_lengths, turning_of
from skinfab.tolerances import TARGET_MOVE

FloatArray = NDArray[np.float64]
ScaleOf = Callable[[FloatArray], FloatArray]

#: The circle's error halves every round (harmonic n of it falls to 1 / n): 1e-10 is 34 rounds away.
_CIRCLE_ROUNDS = 60

#: A general curve settles to what the mesh resolves within a few rounds; the paper uses 10.
_CURVE_ROUNDS = 30


def fit_circle(length: FloatArray, scale_of: ScaleOf) -> FloatArray:
    """Places (b, 2) of the boundary vertices on the unit circle.

    Parameters
    ----------
    length : (b,) float, mm
        Of the boundary edges.
    scale_of : function
        From turning angles (b,) to log scale factors (b,).
    """
    u = np.zeros(len(length))
    span = _spans(length, u)
    for _ in range(_CIRCLE_ROUNDS):
        u = _balanced(scale_of((span + np.roll(span, 1)) / 2), span)
        before, span = span, _spans(length, u)
        if np.abs(span - before).sum() <= TARGET_MOVE * 2 * np.pi:
            break
    at = _around(span)
    return np.column_stack([np.cos(at), np.sin(at)])


def fit_curve(length: FloatArray, scale_of: ScaleOf, target: FloatArray) -> FloatArray:
    """Places (b, 2) mm of the boundary vertices on the closed polygon `target` (k, 2) mm, the first on its first point.

    The round that moved the boundary least is kept: where the target's corners fall between the mesh's
    vertices the rounds end in a small to and fro.
    """
    size = np.linalg.norm(np.ptp(target, axis=0))
    points = best = along(target, length)
    least = np.inf
    for _ in range(_CURVE_ROUNDS):
        before, points = points, along(target, scaled_lengths(length, scale_of(turning_of(points))))
        moved = float(np.abs(points - before).max())
        if moved < least:
            best, least = points, moved
        if moved <= TARGET_MOVE * size:
            break
    return best


def _spans(length: FloatArray, u: FloatArray) -> FloatArray:
    """(b,) rad: what each edge spans of the circle."""
    scaled = scaled_lengths(length, u)
    return scaled * (2 * np.pi / scaled.sum())


def _around(span: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(span)[:-1]])


def _balanced(u: FloatArray, span: FloatArray) -> FloatArray:
    """u without its first harmonic around the circle, which is a Moebius transformation that the rounds leave open."""
    at, weight = _around(span), (span + np.roll(span, 1)) / 2
    basis = np.stack([np.cos(at), np.sin(at)])
    return u - np.linalg.solve((basis * weight) @ basis.T, basis @ (weight * u)) @ basis
