"""Poses of a log: each one's mean force and moment, and how exact these are by what scatters within the poses."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.wrench import WRENCH

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
    freedom : float
        Independent samples, all together, that the covariance was estimated from; infinite where it is not an estimate.
    """

    force: FloatArray
    moment: FloatArray
    covariance: FloatArray | None
    samples: NDArray[np.int64]
    notes: tuple[str, ...] = ()
    freedom: float = math.inf


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
    # A pose lasts until the number changes: one that comes again later is another one, since nothing says that the hand is back.
    of = np.cumsum(np.diff(numbers[kept], prepend=numbers[kept][:1]) != 0)
    wrench = wrench[kept]
    poses = int(of[-1]) + 1 if len(of) else 0
    if poses < 2:
        raise InputError(f"{log.name} holds one pose; turn the hand and read again")
    count = np.bincount(of)
    mean = np.stack([np.bincount(of, wrench[:, j]) for j in range(6)], axis=1) / count[:, None]
    apart = wrench - mean[of]
    notes = [] if kept.all() else [f"{log.name}: {int((~kept).sum())} rows are of no pose and were left out"]
    again = poses - len(np.unique(numbers[kept]))
    notes += [f"{log.name}: {again} pose numbers come again later, and count as poses of their own"] * bool(again)
    free = len(wrench) - poses
    if free < _ENOUGH:
        return Poses(mean[:, :3], mean[:, 3:], None, count, (*notes, f"{log.name} has too few samples a pose to show its noise"))
    correlated = _correlated(apart, of)
    within = apart.T @ apart / free * correlated
    if not np.linalg.eigvalsh(within)[0] > 0:
        return Poses(mean[:, :3], mean[:, 3:], None, count, (*notes, f"{log.name}: a component never changes within a pose"))
    return Poses(mean[:, :3], mean[:, 3:], within / count[:, None, None], count, tuple(notes), free / correlated)


def require_alive(log: WrenchLog) -> None:
    """Refuse a log in which a component reads the same all the time: its wire is off, or it is not measured.

    Raises
    ------
    InputError
        Which one is said.

    Examples
    --------
    >>> try:
    ...     require_alive(WrenchLog("a.csv", np.arange(3.0), np.eye(3), np.zeros((3, 3))))
    ... except InputError as fault:
    ...     print(fault)
    a.csv: Mx, My, Mz read 0, 0, 0 all the time, so nothing measures them; look at the sensor and the log's columns
    """
    wrench = np.concatenate([log.force, log.moment], axis=1)
    if len(log) > 1 and (dead := np.flatnonzero(np.ptp(wrench, axis=0) == 0).tolist()):
        names, values = ", ".join(WRENCH[k] for k in dead), ", ".join(f"{wrench[0, k]:g}" for k in dead)
        one = len(dead) == 1
        raise InputError(
            f"{log.name}: {names} {'reads' if one else 'read'} {values} all the time, so nothing measures {'it' if one else 'them'}; "
            "look at the sensor and the log's columns"
        )


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
