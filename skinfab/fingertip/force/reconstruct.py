"""How large the held solid is and where it lies, from its contacts and its centre of gravity: as published, and by the best fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.fits import Fit, fit_cuboid, fit_cylinder, fit_sphere
from skinfab.fingertip.force.grasp import CUBOID, CYLINDER, SHAPES, SPHERE, Touches

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Solved:
    """A solid as its contacts show it.

    Parameters
    ----------
    shape : str
    size : tuple of float, mm
        Radius of a sphere or a cylinder; the three sides of a cuboid, in the order of `turn`. NaN where no finger touched.
    centre : (3,) float, mm
        In the hand's frame. Of a cylinder a point of its axis: how long it is nobody felt.
    turn : (3, 3) float
        Columns are its axes; a cylinder's is the last.
    """

    shape: str
    size: tuple[float, ...]
    centre: FloatArray
    turn: FloatArray


def reconstruct(found: Touches, shape: str, centre: FloatArray | None = None) -> Solved:
    """The solid that fits contacts and normals best.

    Parameters
    ----------
    found : Touches
    shape : str
        As `skinfab.fingertip.force.shape.decide` says, or as is known.
    centre : (3,) float, mm
        Centre of gravity, for a cuboid: which is taken to be homogeneous.

    Raises
    ------
    InputError
        The shape is none, or a cuboid has no centre.

    Examples
    --------
    >>> out = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    >>> box = reconstruct(Touches(out * [30, 40, 45], out, ""), "cuboid", np.zeros(3))
    >>> sorted(round(x, 6) for x in box.size)
    [60.0, 80.0, 90.0]
    """
    if shape == SPHERE:
        return _round(fit_sphere(found.point, found.normal))
    if shape == CYLINDER:
        return _round(fit_cylinder(found.point, found.normal))
    return _cuboid(found.point, fit_cuboid(found.point, found.normal).turn, found.normal, _require_centre(shape, centre))


def published(found: Touches, shape: str, centre: FloatArray | None = None) -> Solved:
    """As `reconstruct`, by the paper's section 6.2: normals alone for the centre, points alone for the size, each normal for itself."""
    P, N = found.point, found.normal
    if shape == SPHERE:
        meet = meeting_point(P, N)
        return Solved(SPHERE, (float(np.linalg.norm(P - meet, axis=1).mean()),), meet, np.eye(3))
    if shape == CYLINDER:
        turn = np.linalg.svd(N)[2].T  # its last column lies across the normals as far as that goes
        flat = turn[:, :2]
        meet = meeting_point(P @ flat, _units(N @ flat))
        radius = float(np.linalg.norm(P @ flat - meet, axis=1).mean())
        return Solved(CYLINDER, (radius,), flat @ meet + turn[:, 2] * (P @ turn[:, 2]).mean(), _right_handed(turn))
    middle = _require_centre(shape, centre)
    # Two parallel normals show one dimension, each of the others one of its own.
    i, j = np.unravel_index(np.argmin(N @ N.T), (len(N), len(N)))
    away = np.abs(np.einsum("kj,kj->k", P - middle, N))
    rest = [k for k in range(len(N)) if k not in (i, j)]
    size = (float(away[i] + away[j]), *(float(2 * away[k]) for k in rest))
    left, _, right = np.linalg.svd(np.column_stack([N[i] - N[j], *N[rest]]))
    return Solved(CUBOID, size, middle, _right_handed(left @ right))


def meeting_point(point: FloatArray, way: FloatArray) -> FloatArray:
    """The point (d,) nearest to all lines through points (k, d) along unit ways (k, d); of parallel ones the nearest to their middle."""
    d = point.shape[1]
    across = np.eye(d) - way[:, :, None] * way[:, None, :]
    middle = point.mean(axis=0)
    # Directions in which lines leave the point open by less than this part: nearly parallel ones would put it anywhere.
    return np.asarray(middle + np.linalg.lstsq(across.sum(axis=0), np.einsum("kij,kj->i", across, point - middle), rcond=1e-3)[0])


def _round(fit: Fit) -> Solved:
    return Solved(fit.shape, (fit.radius,), fit.centre, fit.turn)


def _cuboid(point: FloatArray, turn: FloatArray, normal: FloatArray, centre: FloatArray) -> Solved:
    facing = normal @ turn
    axis = np.argmax(np.abs(facing), axis=1)
    size, middle = [], centre.copy()
    for k in range(3):
        along = (point - centre) @ turn[:, k]
        plus, minus = (along[(axis == k) & (sign * facing[:, k] > 0)] for sign in (1, -1))
        if len(plus) and len(minus):  # from face to face: the centre of gravity says nothing that they do not
            size.append(float(plus.mean() - minus.mean()))
            middle = middle + turn[:, k] * (plus.mean() + minus.mean()) / 2
        elif len(plus) or len(minus):
            size.append(float(2 * np.abs(np.concatenate([plus, minus])).mean()))
        else:
            size.append(float("nan"))
    return Solved(CUBOID, tuple(size), middle, turn)


def _require_centre(shape: str, centre: FloatArray | None) -> FloatArray:
    if shape != CUBOID:
        raise InputError(f"{shape!r} is no shape; there are {', '.join(SHAPES)}")
    if centre is None:
        raise InputError("a cuboid needs its centre of gravity: hold it in several poses and give that")
    return np.asarray(centre, dtype=float)


def _units(rows: FloatArray) -> FloatArray:
    return np.asarray(rows / np.maximum(np.linalg.norm(rows, axis=1), np.finfo(float).tiny)[:, None])


def _right_handed(turn: FloatArray) -> FloatArray:
    return turn * np.array([1, 1, np.sign(np.linalg.det(turn))])
