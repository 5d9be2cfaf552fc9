"""Target shapes for BFF: scale factors and turning angles of the boundary, in turn, until the boundary lies on the shape.

Turning angles read off the shape at the present edge lengths give new scale factors, those new lengths
(Sawhney and Crane 2017, section 6). The functions take the boundary's edge lengths and a solver's maps between
boundary values, turning and slopes, and give the boundary's places.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bff_curve import scaled_lengths, turning_of
from skinfab.flatten.bff_descent import SlidingCurve, conformal_energy, slide
from skinfab.tolerances import TARGET_MOVE, TARGET_SETTLED

FloatArray = NDArray[np.float64]
Linear = Callable[[FloatArray], FloatArray]

#: The plain rounds halve the circle's error (harmonic n of it falls to 1 / n): 34 to 1e-10. Anderson's take half as many.
_CIRCLE_ROUNDS = 60

#: Rounds that Anderson's acceleration looks back on; more gain nothing and lose their independence.
_LOOK_BACK = 5

#: A general curve settles to what the mesh resolves within a few rounds; the paper uses 10.
_CURVE_ROUNDS = 30

#: A boundary edge of the target is no shorter, for its length on the object, than this fraction of both its neighbours: the descent
#: may leave two vertices on one spot.
_PINCHED = 0.05

#: Rounds without a better boundary, after which no more are tried.
_PATIENCE = 5


def fit_circle(length: FloatArray, scale_of: Linear) -> FloatArray:
    """Places (b, 2) of the boundary vertices on the unit circle.

    The rounds are a fixed-point iteration, quickened as Anderson (1965) does: the next scale factors are the
    combination of the last few whose changes cancel best. The round that moved the boundary least is kept.

    Parameters
    ----------
    length : (b,) float, mm
        Of the boundary edges.
    scale_of : function
        From turning angles (b,) to log scale factors (b,).
    """
    u = np.zeros(len(length))
    given: list[FloatArray] = []
    changed: list[FloatArray] = []
    best, least = _spans(length, u), np.inf
    for _ in range(_CIRCLE_ROUNDS):
        span = _spans(length, u)
        after = _balanced(scale_of((span + np.roll(span, 1)) / 2), span)
        following = _spans(length, after)
        moved = float(np.abs(following - span).sum())
        if moved < least:
            best, least = following, moved
        if moved <= TARGET_MOVE * 2 * np.pi:
            break
        given, changed = [*given, after][-_LOOK_BACK - 1 :], [*changed, after - u][-_LOOK_BACK - 1 :]
        u = _accelerated(given, changed)
    at = _around(best)
    return np.column_stack([np.cos(at), np.sin(at)])


def fit_curve(length: FloatArray, target: FloatArray, *, scale_of: Linear, slope_of: Linear, values_of: Linear) -> FloatArray:
    """Places (b, 2) mm of the boundary vertices on the closed polygon `target` (k, 2) mm, the first on its first point.

    Where the target's or the border's corners fall between the mesh's vertices the rounds end in a to and fro.
    Then the boundary slides on from the round of the least conformal energy until that energy is least.

    Parameters
    ----------
    length : (b,) float, mm
        Of the boundary edges.
    target : (k, 2) float, mm
    scale_of : function
        From turning angles (b,) to log scale factors (b,).
    slope_of, values_of : function
        From boundary values (b, 2) to the slopes of their harmonic extension; and back, (b,) with the first value 0.
    """
    curve = SlidingCurve(target)
    size = float(np.linalg.norm(np.ptp(target, axis=0)))
    at = best = _ways(curve, length)
    points = curve.point(at)
    lowest = _energy(points, slope_of)
    least, waited = np.inf, 0
    for _ in range(_CURVE_ROUNDS):
        at = _ways(curve, scaled_lengths(length, scale_of(turning_of(points))))
        before, points = points, curve.point(at)
        moved = float(np.abs(points - before).max())
        if moved <= TARGET_MOVE * size:
            return points
        energy = _energy(points, slope_of)
        waited = 0 if moved < least or energy < lowest else waited + 1
        if waited > _PATIENCE:
            break
        if energy < lowest:
            lowest, best = energy, at
        if moved < least:
            least, calmest = moved, points
    if least <= TARGET_SETTLED * size:
        return calmest
    slid = curve.point(_unpinched(slide(curve, best, slope_of=slope_of, values_of=values_of), length, curve.total_mm))
    return slid if _energy(slid, slope_of) < lowest else curve.point(best)


def _energy(points: FloatArray, slope_of: Linear) -> float:
    energy, _, area = conformal_energy(points, slope_of)
    return energy / area if area > 0 else np.inf


def _ways(curve: SlidingCurve, length: FloatArray) -> FloatArray:
    """(b,) mm along the curve, in proportion to the edge lengths."""
    return np.concatenate([[0.0], np.cumsum(length)[:-1]]) * (curve.total_mm / length.sum())


def _unpinched(at: FloatArray, length: FloatArray, total: float) -> FloatArray:
    """Ways (b,) mm with single pinched edges opened; edges that are short along with a neighbour stay."""
    gap = np.diff(np.append(at, total))
    scale = gap / length
    wide = np.maximum(gap, _PINCHED * length * np.minimum(np.roll(scale, 1), np.roll(scale, -1)))
    return np.concatenate([[0.0], np.cumsum(wide)[:-1]]) * (total / wide.sum())


def _accelerated(given: list[FloatArray], changed: list[FloatArray]) -> FloatArray:
    """The next guess of a fixed-point iteration from what its last rounds gave and how that differed from what they got."""
    if len(given) == 1:
        return given[0]
    share = np.linalg.lstsq(np.diff(changed, axis=0).T, changed[-1], rcond=None)[0]
    following: FloatArray = given[-1] - share @ np.diff(given, axis=0)
    return following


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
