"""Sphere, cylinder and cuboid that fit contact points and normals best, each weighed by how well it is known.

Least squares over both kinds of error at once (Levenberg-Marquardt, MINPACK): the paper takes the normals alone for the centre and
the points alone for the radius.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.force.grasp import CUBOID, CYLINDER, SPHERE

FloatArray = NDArray[np.float64]

#: Standard deviations of a contact's place along one axis, mm, and of a normal about one axis, rad: joints and sensor together.
POINT_SD_MM, NORMAL_SD_RAD = 2.0, math.radians(4.0)


@dataclass(frozen=True, eq=False)
class Fit:
    """One shape laid through the contacts.

    Parameters
    ----------
    shape : str
    centre : (3,) float, mm
        Of a cylinder: of its axis, next to the contacts; of a cuboid: the middle of the contacts (its centre is not known).
    turn : (3, 3) float
        Columns are the shape's own axes; a cylinder's last one is its axis.
    radius : float, mm
        NaN of a cuboid.
    residuals : (r,) float
        In standard deviations.
    free : int
        How many of them are more than was fitted.
    """

    shape: str
    centre: FloatArray
    turn: FloatArray
    radius: float
    residuals: FloatArray
    free: int

    @property
    def misfit(self) -> float:
        """Root of the squared residuals a degree of freedom: about 1 of the right shape."""
        return math.sqrt(float(self.residuals @ self.residuals) / self.free)


def fit_sphere(point: FloatArray, normal: FloatArray) -> Fit:
    """The sphere through contacts (k, 3) with outward normals (k, 3).

    Examples
    --------
    >>> out = np.array([[1.0, 0, 0], [0, 1, 0], [-0.6, 0, 0.8], [0, 0, 1]])
    >>> found = fit_sphere(45 * out + [1, 2, 3], out)
    >>> round(found.radius, 6), found.centre.round(6).tolist()
    (45.0, [1.0, 2.0, 3.0])
    """
    k = len(point)
    # p = c + R n is linear in both.
    system = np.hstack([np.tile(np.eye(3), (k, 1)), normal.reshape(-1, 1)])
    start = np.linalg.lstsq(system, point.ravel(), rcond=None)[0]

    def residuals(x: FloatArray) -> FloatArray:
        out = point - x[:3]
        far = np.linalg.norm(out, axis=1)
        return np.concatenate([(far - x[3]) / POINT_SD_MM, _angles(normal, out / far[:, None])])

    x, left = _least(residuals, np.asarray(start, dtype=float))
    return Fit(SPHERE, x[:3], np.eye(3), float(x[3]), left, 3 * k - 4)


def fit_cylinder(point: FloatArray, normal: FloatArray) -> Fit:
    """The cylinder through contacts (k, 3) on its curved side."""
    k = len(point)
    axis = np.linalg.svd(normal)[2][2]  # across all normals as far as that goes
    across = np.eye(3) - np.outer(axis, axis)
    system = np.hstack([np.tile(across, (k, 1)), (normal @ across).reshape(-1, 1)])
    start = np.linalg.lstsq(system, (point @ across).ravel(), rcond=None)[0]
    u, v = _across(axis)
    middle = point.mean(axis=0)
    first = middle + across @ (start[:3] - middle)

    def made(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        turned = axis + x[0] * u + x[1] * v
        return turned / np.linalg.norm(turned), first + x[2] * u + x[3] * v

    def residuals(x: FloatArray) -> FloatArray:
        along, centre = made(x)
        off = point - centre
        out = off - (off @ along)[:, None] * along
        far = np.linalg.norm(out, axis=1)
        return np.concatenate([(far - x[4]) / POINT_SD_MM, _angles(normal, out / far[:, None])])

    x, left = _least(residuals, np.array([0, 0, 0, 0, start[3]], dtype=float))
    along, centre = made(x)
    return Fit(CYLINDER, centre, np.column_stack([*_across(along), along]), float(x[4]), left, 3 * k - 5)


def fit_cuboid(point: FloatArray, normal: FloatArray) -> Fit:
    """The cuboid's axes that the contacts' normals follow; contacts on one face lie in it."""
    from scipy.spatial.transform import Rotation

    best: tuple[float, FloatArray, FloatArray] | None = None
    middle = point.mean(axis=0)
    for first, second in itertools.combinations(range(len(normal)), 2):
        start = _frame(normal[first], normal[second])
        # Which face each lies on stays as it is seen from the start.
        along = normal @ start
        face = np.argmax(np.abs(along), axis=1)
        sign = np.sign(along[np.arange(len(face)), face])
        same = [(i, j) for i, j in itertools.combinations(range(len(face)), 2) if face[i] == face[j] and sign[i] == sign[j]]

        def residuals(
            x: FloatArray,
            start: FloatArray = start,
            face: FloatArray = face,
            sign: FloatArray = sign,
            same: Sequence[tuple[int, int]] = same,
        ) -> FloatArray:
            turn = Rotation.from_rotvec(x).as_matrix() @ start
            out = sign[:, None] * turn[:, face].T
            flat = [out[i] @ (point[i] - point[j]) / (POINT_SD_MM * math.sqrt(2)) for i, j in same]
            return np.concatenate([_angles(normal, out), flat])

        rough = float(np.sum(residuals(np.zeros(3)) ** 2))
        if best is None or rough < best[0]:
            best = (rough, start, np.array([rough]))
            chosen = residuals
    assert best is not None
    x, left = _least(chosen, np.zeros(3))
    turn = Rotation.from_rotvec(x).as_matrix() @ best[1]
    return Fit(CUBOID, middle, turn, math.nan, left, max(len(left) - 3, 1))


FITS: dict[str, Callable[[FloatArray, FloatArray], Fit]] = {SPHERE: fit_sphere, CYLINDER: fit_cylinder, CUBOID: fit_cuboid}


def _least(residuals: Callable[[FloatArray], FloatArray], start: FloatArray) -> tuple[FloatArray, FloatArray]:
    from scipy.optimize import leastsq

    # MINPACK itself, differences included: `least_squares` spends four times as long around it on so few numbers.
    x, _, info, _, _ = leastsq(residuals, start, full_output=True)
    return x, info["fvec"]


def _angles(normal: FloatArray, wanted: FloatArray) -> FloatArray:
    """Two components of each normal's turn from what it should be, in standard deviations."""
    # The vector between them lies across, and is as long as the angle where that is small; all three components say the same.
    return ((normal - wanted) / NORMAL_SD_RAD).ravel()


def _across(axis: FloatArray) -> tuple[FloatArray, FloatArray]:
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    u /= np.linalg.norm(u)
    return u, np.cross(axis, u)


def _frame(a: FloatArray, b: FloatArray) -> FloatArray:
    """A right-handed frame whose first axis is a and whose second is b as far as it lies across."""
    across = b - (a @ b) * a
    size = np.linalg.norm(across)
    second = across / size if size > NORMAL_SD_RAD else _across(a)[0]
    return np.column_stack([a, second, np.cross(a, second)])
