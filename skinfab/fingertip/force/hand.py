"""A hand whose fingertips each have a six-axis sensor: what all of them read together, in the hand's own frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: A matrix whose columns are this far from unit length and right angles is no rotation; encoders and forward kinematics are better.
_ROTATION = 1e-6


@dataclass(frozen=True, eq=False)
class Finger:
    """Where a fingertip's sensor is.

    Parameters
    ----------
    rotation : (3, 3) float
        Its axes as columns, in the hand's frame.
    position : (3,) float, mm
        Its origin.

    Raises
    ------
    InputError
        The rotation is none.
    """

    rotation: FloatArray
    position: FloatArray

    def __post_init__(self) -> None:
        R, p = np.array(self.rotation, dtype=float), np.array(self.position, dtype=float)
        if R.shape != (3, 3) or p.shape != (3,) or not np.isfinite(p).all():
            raise InputError(f"a finger has a rotation of the shape {R.shape} and a position of {p.shape}; give (3, 3) and (3,)")
        if not np.abs(R.T @ R - np.eye(3)).max() < _ROTATION or np.linalg.det(R) < 0:
            raise InputError("a finger's rotation is none; its columns must be unit vectors at right angles, and right-handed")
        object.__setattr__(self, "rotation", R)
        object.__setattr__(self, "position", p)

    @property
    def transform(self) -> FloatArray:
        """What takes the sensor's force and moment (6,) to the hand's, (6, 6)."""
        out = np.zeros((6, 6))
        out[:3, :3] = out[3:, 3:] = self.rotation
        out[3:, :3] = np.cross(self.position, self.rotation, axisb=0, axisc=0)
        return out


def hand_wrench(fingers: list[Finger], wrenches: ArrayLike) -> FloatArray:
    """Force and moment of the whole hand, (n, 6), from those of each finger.

    Parameters
    ----------
    fingers : list of k Finger
    wrenches : (k, n, 6) float
        Fx, Fy, Fz (N), Mx, My, Mz (N mm) of each sensor in its own frame.

    Raises
    ------
    InputError
        There are not as many wrenches as fingers.

    Examples
    --------
    >>> finger = Finger(np.eye(3), np.array([100.0, 0.0, 0.0]))
    >>> hand_wrench([finger], [[[0.0, 0.0, -1.0, 0.0, 0.0, 0.0]]]).tolist()
    [[0.0, 0.0, -1.0, 0.0, 100.0, 0.0]]
    """
    w = np.asarray(wrenches, dtype=float)
    if w.ndim != 3 or w.shape[0] != len(fingers) or w.shape[2] != 6:
        raise InputError(f"wrenches have the shape {w.shape}, and {len(fingers)} fingers need ({len(fingers)}, n, 6)")
    out: FloatArray = sum((w[k] @ finger.transform.T for k, finger in enumerate(fingers)), np.zeros(w.shape[1:]))
    return out
