"""Poses of a log: each one's mean force and moment, and how exact these are by what scatters within the poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog

FloatArray = NDArray[np.float64]

COLUMN = "pose"
#: So many samples beyond one a pose, all poses together, show a covariance of six components.
_ENOUGH = 30
#: A correlation below this is none: that of a thousand samples of six components scatters by a third of it.
_FADED = 0.04


@dataclass(frozen=True, eq=False)
class Poses:
    """What was read in each pose.

    Parameters
    ----------
    force, moment : (n, 3) float, N and N mm
        Means.
    covariance : (n, 6, 6) float or None
        Of the means; None where there are too few samples to tell.
    samples : (n,) int
    notes : tuple of str
    """

    force: FloatArray
    moment: FloatArray
    covariance: FloatArray | None
    samples: NDArray[np.int64]
    notes: tuple[str, ...] = ()


def poses_of(log: WrenchLog) -> Poses:
    """Poses by the column ``pose``, whose numbers change when the hand is turned; without it each row is a pose.

    Samples within a pose are taken for independent but for those that follow one another: their correlation is counted, so that
    a filtered log does not promise more than it holds.

    Raises
    ------
    InputError
        The log has a single pose.

    Examples
    --------
    >>> from skinfab.fingertip.force.gravity_simulator import hold
    >>> found = poses_of(hold().log)
    >>> found.force.shape, found.samples[0]
    ((10, 3), np.int64(100))
    """
    wrench = np.concatenate([log.force, log.moment], axis=1)
    if COLUMN not in log.others:
        if len(log) < 2:
            raise InputError(f"{log.name} holds one pose; turn the hand and read again")
        return Poses(log.force, log.moment, None, np.ones(len(log), dtype=np.int64), (f"{log.name} has no column pose: each row is one",))
    numbers = log.others[COLUMN]
    kept = np.isfinite(numbers)
    names, of = np.unique(numbers[kept], return_inverse=True)
    wrench = wrench[kept]
    if len(names) < 2:
        raise InputError(f"{log.name} holds one pose; turn the hand and read again")
    count = np.bincount(of)
    mean = np.stack([np.bincount(of, wrench[:, j]) for j in range(6)], axis=1) / count[:, None]
    apart = wrench - mean[of]
    notes = [] if kept.all() else [f"{log.name}: {int((~kept).sum())} rows are of no pose and were left out"]
    free = len(wrench) - len(names)
    if free < _ENOUGH:
        return Poses(mean[:, :3], mean[:, 3:], None, count, (*notes, f"{log.name} has too few samples a pose to show its noise"))
    within = apart.T @ apart / free * _correlated(apart, of)
    if not np.linalg.eigvalsh(within)[0] > 0:
        return Poses(mean[:, :3], mean[:, 3:], None, count, (*notes, f"{log.name}: a component never changes within a pose"))
    return Poses(mean[:, :3], mean[:, 3:], within / count[:, None, None], count, tuple(notes))


def _correlated(apart: FloatArray, of: NDArray[np.int64]) -> float:
    """By how much the variance of a mean is larger than of independent samples: 1 + 2 (correlations of all lags)."""
    size = (apart**2).sum(axis=0)
    used = size > 0
    total = 1.0
    for lag in range(1, len(apart) // len(np.unique(of)) // 2):
        same = of[lag:] == of[:-lag]
        both = (apart[lag:] * apart[:-lag])[same].sum(axis=0)[used] / size[used]
        mean = float(both.mean()) if used.any() else 0.0
        # Where they have faded, what is left is chance, and adding it up would add nothing but that.
        if mean < _FADED:
            break
        total += 2 * mean
    return total
