"""Is a model of an empty hand one of the hand that holds? Another grasp has other offsets, and is wrong by millimetres without a sign.

Less the right offset all poses feel one weight, whichever way they are turned, and the centre is the one that the poses tell by
themselves, with an offset fitted beside it; less the wrong one neither is so.
"""

from __future__ import annotations

import numpy as np

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.gravity import MEET_CHANCE, Centre, centre_of_gravity
from skinfab.fingertip.force.gravity_model import HandModel
from skinfab.fingertip.force.poses import Poses

#: A sensor's gain differs between its axes by so much, one standard deviation: a weight is not felt alike from all sides.
_GAIN_PART = 0.005
#: Of another grasp's model all are refused from so many poses on (of 40 hands, three weighings; of three poses 38, of two 3).
TELLING = 4


def weights_alike(model: HandModel, poses: Poses) -> float:
    """Chance that the poses feel one weight, less the model's offset, as its drift and their noise let them; 1 where noise is not known.

    Examples
    --------
    >>> from skinfab.fingertip.force.gravity_fit import learn_hand
    >>> from skinfab.fingertip.force.gravity_simulator import hold
    >>> from skinfab.fingertip.force.poses import poses_of
    >>> model = learn_hand([poses_of(hold(seed=3, weighing=k).log) for k in range(2)])
    >>> weights_alike(model, poses_of(hold(seed=3).log)) > 0.01 > weights_alike(model, poses_of(hold(seed=4).log))
    True
    """
    if poses.covariance is None:
        return 1.0
    from scipy.stats import f

    _, _, g = model.less(poses.force, poses.moment)
    size = np.linalg.norm(poses.force - model.offset[:3], axis=1)
    spread = g @ model.covariance[:3, :3] @ g.T + np.diag(
        np.einsum("ni,nij,nj->n", g, poses.covariance[:, :3, :3], g) + (_GAIN_PART * size) ** 2
    )
    apart = np.diff(size)
    contrast = np.diff(np.eye(len(size)), axis=0)
    square = float(apart @ np.linalg.solve(contrast @ spread @ contrast.T, apart))
    return float(f.sf(square / len(apart), len(apart), poses.freedom))


def centres_alike(poses: Poses, centre: Centre) -> float:
    """Chance that the centre with a model is also the one that the poses tell by themselves; 1 where they tell none.

    The two would differ by less than their uncertainties together, since one is of a part of what the other is of (Hausman 1978).
    """
    from scipy.stats import chi2

    try:
        alone = centre_of_gravity(poses.force, poses.moment, poses.covariance, freedom=poses.freedom)
    except (InputError, RefusedError):  # too few poses or too narrow ones: nothing speaks against the model
        return 1.0
    apart = alone.point - centre.point
    return float(chi2.sf(apart @ np.linalg.solve(alone.covariance + centre.covariance, apart), 3))


def require_own_hand(model: HandModel, poses: Poses, centre: Centre) -> None:
    """Refuse a model that does not belong to what was read.

    Parameters
    ----------
    model : HandModel
    poses : Poses
    centre : Centre
        By the model.

    Raises
    ------
    RefusedError
        The poses feel weights that differ, or tell another centre by themselves.
    """
    if weights_alike(model, poses) < MEET_CHANCE:
        size = np.linalg.norm(poses.force - model.offset[:3], axis=1)
        why = f"less its offset the poses feel from {size.min():.3f} to {size.max():.3f} N"
    elif centres_alike(poses, centre) < MEET_CHANCE:
        why = "with their offset fitted, the poses tell another centre"
    else:
        return
    raise RefusedError(
        f"the model is not of this hand as it holds here, or its offsets drifted farther than the weighings show: {why}; weigh the hand "
        "empty, its fingers as they hold (train gravity), or leave --model out"
    )
