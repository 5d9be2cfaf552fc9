"""A line and a point that touch at once: a rod that is held between a finger and something else.

Points alone make up such a frame too, two or three of them in the place of the line, and none of these is a contact. The line and the
point are found in turn, each in what the other leaves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.array.line_fit import Line, LineFinder
from skinfab.fingertip.array.matched import Contact, Matcher
from skinfab.tolerances import SEVERAL_NEAR, SEVERAL_TACTELS

FloatArray = NDArray[np.float64]

#: How often each is found anew.
_ROUNDS = 3


def line_beside(
    Z: FloatArray, points: Sequence[Contact], matcher: Matcher, lines: LineFinder, *, explained: bool, allowed: float
) -> tuple[Line, Contact] | None:
    """The line and the point that make up a frame; None where they do not.

    Parameters
    ----------
    Z : (rings, stripes) float
    points : sequence of Contact
        By which the frame was to be explained: one that lies apart may be the point, and all others the line's.
    matcher : Matcher
    lines : LineFinder
    explained : bool
        Whether they explain it: then some of those that are the line's must lie near each other.
    allowed : float
        Sum of squares that may be left.

    Examples
    --------
    >>> from skinfab.fingertip.array.geometry import Geometry
    >>> from skinfab.fingertip.array.matched import ArrayModel
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> seed = Geometry()
    >>> Z = Skin(seed).lined(2.0, axial_mm=8.0, angle_rad=0.0, line_rad=0.9) + Skin(seed).pressed(1.0, axial_mm=19.0, angle_rad=2.0)
    >>> matcher, lines = Matcher(ArrayModel.nominal(seed)), LineFinder(ArrayModel.nominal(seed))
    >>> line, point = line_beside(Z, matcher.several(Z), matcher, lines, explained=False, allowed=4e-3 * float((Z**2).sum()))
    >>> [round(value, 2) for value in (line.line_rad, line.force_n, point.force_n)]
    [0.9, 2.0, 1.0]
    """
    tried = []
    for one in points:
        others = [two for two in points if two is not one]
        if not others or any(matcher.tactels(one, two) < SEVERAL_TACTELS for two in others):
            continue
        near = any(matcher.tactels(two, three) < SEVERAL_NEAR for two in others for three in others if two is not three)
        if (near or not explained) and (found := _refined(Z, one, matcher, lines, 1)) is not None:
            tried.append(found)
    if not tried or (best := _refined(Z, min(tried, key=lambda each: each[0])[2], matcher, lines, _ROUNDS - 1)) is None:
        return None
    left, line, point = best
    return (line, point) if left <= allowed and line.force_n > 0 and point.force_n > 0 else None


def _refined(Z: FloatArray, point: Contact, matcher: Matcher, lines: LineFinder, rounds: int) -> tuple[float, Line, Contact] | None:
    """The line in what the point leaves and the point in what the line leaves, so often; and the sum of squares that is left."""
    found = None
    for _ in range(rounds):
        if (line := lines(Z - matcher.predicted((point,)))) is None:
            return None
        of_line = lines.predicted(line)
        point = matcher.point(Z - of_line)
        found = float(np.nansum((Z - of_line - matcher.predicted((point,))) ** 2)), line, point
    return found
