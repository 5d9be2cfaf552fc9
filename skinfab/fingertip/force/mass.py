"""A held object's mass, from forces that differ by their direction alone: they lie on a sphere about the sensor's offset."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import GRAVITY
from skinfab.fingertip.force.wrench import SensorNoise

FloatArray = NDArray[np.float64]

#: A mass is none that is known no better than to this part of itself.
_WORST_PART = 0.2
_STEPS, _SETTLED = 100, 1e-12


@dataclass(frozen=True, eq=False)
class Mass:
    """A mass.

    Parameters
    ----------
    kg, sd_kg : float
    offset_n : (3,) float, N
        Of the force: what the hand would read without the object, as far as it turns with the hand.
    """

    kg: float
    sd_kg: float
    offset_n: FloatArray


def fit_mass(force: ArrayLike, covariance: ArrayLike | None = None, *, worst_part: float = _WORST_PART) -> Mass:
    """Fit a sphere to the forces of poses, by least squares of their distances from it.

    Parameters
    ----------
    force : (n, 3) float, N
        A row a pose, from 4.
    covariance : (3, 3) or (n, 3, 3) float, N^2, optional
        Of a pose's force; that of `SensorNoise` where left out.
    worst_part : float
        The sphere is none where its radius is known no better than to this part of itself.

    Raises
    ------
    InputError
        Fewer than four poses, or shapes that do not fit.
    RefusedError
        The directions lie in one plane or so, so that the sphere's size is not known so well.

    Examples
    --------
    >>> F = 2 * np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, -0.8]]) + [0.1, 0.0, 0.0]
    >>> found = fit_mass(F)
    >>> round(found.kg, 3), round(float(found.offset_n[0]), 3)
    (0.204, 0.1)
    """
    F = np.array(force, dtype=float)
    if F.ndim != 2 or F.shape[1] != 3 or len(F) < 4:
        raise InputError(f"forces have the shape {F.shape}; a mass beside an offset needs (n, 3), from four poses")
    S = np.eye(3) * SensorNoise().force_n ** 2 if covariance is None else np.array(covariance, dtype=float)
    if S.shape not in ((3, 3), (len(F), 3, 3)):
        raise InputError(f"a covariance of the shape {S.shape} does not fit {len(F)} forces; give (3, 3) or ({len(F)}, 3, 3)")
    flat = RefusedError(f"the {len(F)} poses turn gravity in one plane or hardly at all, so the mass is not known; turn the hand farther")
    middle = F.mean(axis=0)
    linear = np.column_stack([2 * (F - middle), np.ones(len(F))])
    if np.linalg.matrix_rank(linear) < 4:
        raise flat
    start = np.linalg.lstsq(linear, np.einsum("ij,ij->i", F - middle, F - middle), rcond=None)[0]
    x = np.append(start[:3] + middle, np.sqrt(max(start[3] + start[:3] @ start[:3], 0.0)))
    information = np.zeros((4, 4))
    for _ in range(_STEPS):
        arm = F - x[:3]
        size = np.linalg.norm(arm, axis=1)
        design = np.column_stack([arm / size[:, None], np.ones(len(F))])
        weight = 1 / np.einsum("ni,nij,nj->n", design[:, :3], np.broadcast_to(S, (len(F), 3, 3)), design[:, :3])
        information = design.T @ (weight[:, None] * design)
        step = np.linalg.lstsq(information, design.T @ (weight * (size - x[3])), rcond=None)[0]
        x = x + step
        if np.abs(step).max() <= _SETTLED * x[3]:
            break
    with np.errstate(invalid="ignore"):
        sd = float(np.sqrt(np.linalg.pinv(information, hermitian=True)[3, 3])) if np.linalg.matrix_rank(information) == 4 else np.inf
    if not sd <= worst_part * x[3]:
        raise flat
    return Mass(float(x[3]) / GRAVITY, sd / GRAVITY, x[:3].copy())
