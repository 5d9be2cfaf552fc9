"""The matrix that touches at known places tell, and which of the touches were not made where they are said to be.

Least squares believe every place as much as any other, so two that were exchanged in the table spoil the matrix and what it is
judged by. Places are therefore first weighed by how far off they are found, as Cauchy errors are (iteratively reweighted least
squares; Holland and Welsch 1977). Who is then far from his place by all the others is apart, and the rest is fitted plainly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.contact import Hemisphere, locate
from skinfab.fingertip.force.gravity import cross_matrices
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.fingertip.splits import leave_one_out

if TYPE_CHECKING:
    from skinfab.fingertip.force.contact_mesh import TipMesh

FloatArray = NDArray[np.float64]

#: How far a mark on the fingertip is from where it is thought to be, mm along each axis.
PLACE_SD_MM = 0.3
#: What is believed of a sensor before it was touched, as standard deviations: how far its origin lies off, mm, ...
_MOUNT_MM = 2.0
#: ... and how far it is turned, or one of its axes reads others of the same kind, as a part: 3 degrees, or 5 %.
_PART = 0.05
#: An arm at which a moment counts as a force, mm: the fingertip's size.
_ARM_MM = 20.0
#: A touch is not where it is said to be that is farther off than so many times the median of all, ...
_APART = 5.0
#: ... and than so many times the mark's own error along an axis: the median of a sensor without noise is nearly nothing.
_APART_SD = 6.0
#: Rounds of weighing: exchanged places have no weight left after half of them.
_ROUNDS = 10
#: A median over this is a standard deviation along one axis, of an error across the surface (Rayleigh's distribution).
_RAYLEIGH = 1.1774
_NUMBERS = 36


@dataclass(frozen=True, eq=False)
class Touch:
    """What one touch says.

    Parameters
    ----------
    name : str
    place : (3,) float, mm
        Where it is said to be.
    wrench : (n, 6) float, N and N mm
        Means of short times.
    information : (39, 39) float
        Of the matrix's departure from the unit one, row by row, and of the place's error, mm.
    towards : (39,) float
        Right side of the normal equations.
    """

    name: str
    place: FloatArray
    wrench: FloatArray
    information: FloatArray
    towards: FloatArray


def touch_of(name: str, place: FloatArray, wrench: FloatArray, noise: SensorNoise) -> Touch:
    """The normal equations of m + E_m w - p x (f + E_f w) - d x f = 0, for E's rows one after another and the place's error d."""
    arm = cross_matrices(place[None])[0]
    take = np.hstack([-arm, np.eye(3)])
    # A little more, so that a sensor without any noise has a weight too.
    little = np.eye(3) * (1e-6 + 1e-6 * noise.moment_nmm**2)
    weight = np.linalg.inv(noise.force_n**2 * arm @ arm.T + noise.moment_nmm**2 * np.eye(3) + little)
    design = np.concatenate(
        [(take[None, :, :, None] * wrench[:, None, None, :]).reshape(len(wrench), 3, _NUMBERS), cross_matrices(wrench[:, :3])], axis=2
    )
    weighed = np.einsum("ij,njk->nik", weight, design)
    information = np.tensordot(design, weighed, axes=([0, 1], [0, 1]))
    return Touch(name, place, wrench, information, -np.tensordot(weighed, wrench @ take.T, axes=([0, 1], [0, 1])))


def fit_matrix(touches: Sequence[Touch], place_sd: Sequence[float] | None = None) -> tuple[FloatArray, FloatArray]:
    """The most likely matrix (6, 6) and the covariance (36, 36) of its numbers, row by row.

    Departures from the unit matrix and errors of the places, `place_sd` mm along each axis, are weighed as they are believed.
    """
    believed = np.full((6, 6), _PART)
    believed[3:, :3] = _MOUNT_MM
    believed[:3, 3:] = _PART / _ARM_MM
    sd = believed.ravel()
    information, towards = np.eye(_NUMBERS), np.zeros(_NUMBERS)
    for touch, own in zip(touches, place_sd or [PLACE_SD_MM] * len(touches), strict=True):
        H, b = touch.information, touch.towards
        # The place's error has no more to say once it is integrated over.
        through = np.linalg.solve(H[_NUMBERS:, _NUMBERS:] + np.eye(3) / own**2, H[_NUMBERS:]).T[:_NUMBERS]
        information += np.outer(sd, sd) * (H[:_NUMBERS, :_NUMBERS] - through @ H[_NUMBERS:, :_NUMBERS])
        towards += sd * (b[:_NUMBERS] - through @ b[_NUMBERS:])
    spread = np.linalg.inv(information)
    spread = (spread + spread.T) / 2
    return np.eye(6) + (sd * (spread @ towards)).reshape(6, 6), spread * np.outer(sd, sd)


def found_at(matrix: FloatArray, touch: Touch, surface: Hemisphere | TipMesh) -> tuple[FloatArray, float]:
    """Where a touch is found, (3,), and its median distance from its place, mm."""
    acts = np.ascontiguousarray(touch.wrench @ matrix.T)
    found = locate(acts[:, :3], acts[:, 3:], surface, least_force=0.0)
    return np.median(found.point, axis=0), float(np.median(np.linalg.norm(found.point - touch.place, axis=1)))


def held_out(touches: Sequence[Touch], surface: Hemisphere | TipMesh) -> list[float]:
    """How far from its place each touch is found by the matrix of all the others, mm."""
    out = [0.0] * len(touches)
    for train, (k,) in leave_one_out(list(range(len(touches)))):
        out[k] = found_at(fit_matrix([touches[j] for j in train])[0], touches[k], surface)[1]
    return out


def touches_apart(touches: Sequence[Touch], surface: Hemisphere | TipMesh) -> list[int]:
    """Which touches are far from their places by a matrix of those that agree, the farthest first.

    Examples
    --------
    >>> from skinfab.fingertip.force.touch_model import touches_of
    >>> from skinfab.fingertip.force.touch_simulator import simulate_touches
    >>> logs, places = simulate_touches(9, seed=1)
    >>> places["touch-2.csv"], places["touch-7.csv"] = places["touch-7.csv"], places["touch-2.csv"]
    >>> touches, _ = touches_of(logs, places, Hemisphere())
    >>> sorted(touches[k].name for k in touches_apart(touches, Hemisphere()))
    ['touch-2.csv', 'touch-7.csv']
    """
    off = np.array([found_at(np.eye(6), touch, surface)[1] for touch in touches])
    for _ in range(_ROUNDS):
        # As it is, the width follows the errors down: far ones lose their weight one after another.
        width = max(PLACE_SD_MM, float(np.median(off)) / _RAYLEIGH)
        matrix, _ = fit_matrix(touches, np.sqrt((width**2 + off**2) / 2).tolist())
        off = np.array([found_at(matrix, touch, surface)[1] for touch in touches])
    kept = [k for k in range(len(touches)) if off[k] <= _limit(off)]
    # Once more without them, each by the others alone: it may agree after all, or only have seemed to because it was among them.
    while True:
        own = held_out([touches[k] for k in kept], surface)
        worst = int(np.argmax(own))
        if own[worst] <= _limit(np.array(own)) or len(kept) <= 2:
            break
        del kept[worst]
    matrix, _ = fit_matrix([touches[k] for k in kept])
    limit = _limit(np.array(own))
    far = {k: found_at(matrix, touches[k], surface)[1] for k in range(len(touches)) if k not in kept}
    return sorted((k for k, distance in far.items() if distance > limit), key=lambda k: -far[k])


def _limit(off: FloatArray) -> float:
    return max(_APART_SD * PLACE_SD_MM, _APART * float(np.median(off)))
