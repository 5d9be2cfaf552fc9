"""What a layout with a prescribed boundary is checked for before it is given out: closed as asked, every triangle upright."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.flatten.bff_curve import turning_of
from skinfab.flatten.distortion import shaped_areas
from skinfab.tolerances import CLOSED_LENGTH, DEGENERATE_HEIGHT, SHRUNK, TURNING_SUM_RAD

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def require_lengths(length: FloatArray, whose: str) -> None:
    """Lengths (b,) mm of which a polygon can be made.

    Raises
    ------
    InputError
        One is not positive, or longer than all the others together.
    """
    if not (length > 0).all():
        k = int(np.argmin(length > 0))
        raise InputError(f"boundary edge {k} has length {length[k]:g} mm in {whose}; every length must be positive")
    k = int(np.argmax(length))
    rest = float(np.delete(length, k).sum())
    if not length[k] < rest:
        raise InputError(
            f"boundary edge {k} has length {length[k]:g} mm in {whose}, the others together {rest:g} mm; no closed curve has such an edge"
        )


def require_closed(curve: FloatArray, turning: FloatArray, *, length: FloatArray | None = None) -> None:
    """Refuse a closed curve (b, 2) mm that had to give up the turning (b,) rad or the edge lengths (b,) mm it was to have.

    Raises
    ------
    RefusedError
    """
    off = np.abs(np.angle(np.exp(1j * (turning_of(curve) - turning))))
    if (off > 2 * TURNING_SUM_RAD).any():
        raise RefusedError(
            f"with these {'turning angles' if length is None else 'lengths'} the boundary closes only with edges that run backwards: its "
            f"turning is off by {off.max():.3g} rad; ask for less at once, or keep it free"
        )
    if length is None:
        return
    off = np.abs(np.linalg.norm(np.roll(curve, -1, axis=0) - curve, axis=1) / length - 1)
    if off.max() > CLOSED_LENGTH:
        raise RefusedError(
            f"the boundary closes only with edge {int(np.argmax(off))} {100 * off.max():.0f} % off its length; "
            f"change neighbouring edges alike, or keep it free"
        )


def require_upright(V: FloatArray, F: IntArray, uv: FloatArray, where: str, *, face_of: IntArray | None = None) -> None:
    """Refuse a layout (n, 2) mm in which a triangle that has area on the object is turned over or has none.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
    uv : (n, 2) float64, mm
    where : str
        "inside the disk", or whatever it was laid by.
    face_of : (m,) int64, optional
        The user's triangle that each is a part of.

    Raises
    ------
    RefusedError
    """
    face_of = np.arange(len(F)) if face_of is None else face_of
    _, shaped = shaped_areas(V, F)
    own, n = face_of[shaped], int(face_of[-1]) + 1
    p, q, r = (uv[corner] for corner in F[shaped].T)
    sides = np.stack([q - p, r - q, p - r])
    longest_square = (sides**2).sum(axis=2).max(axis=0)
    # What has shrunk to rounding has no side up.
    sized = longest_square > (SHRUNK * np.linalg.norm(np.ptp(uv, axis=0))) ** 2
    twice_area = sides[0, :, 0] * sides[1, :, 1] - sides[0, :, 1] * sides[1, :, 0]
    height = np.divide(twice_area, longest_square, out=np.zeros(len(own)), where=sized)
    if over := len(np.unique(own[height < -DEGENERATE_HEIGHT])):
        raise RefusedError(
            f"{over} of {n} triangles come out upside down {where}; give a rounder shape or a finer mesh, or keep the boundary free"
        )
    flat = np.unique(own[~(height > DEGENERATE_HEIGHT)])
    if len(flat):
        raise RefusedError(
            f"{len(flat)} of {n} triangles come out without area {where}, first triangle {flat[0]}, where the border has sharp teeth or "
            f"the shape no room for what it turns by; cut the teeth off, give another shape, or keep the boundary free"
        )
