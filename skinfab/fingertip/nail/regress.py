"""Where the pattern lies on the pad, how it is turned and how hard it is pressed, as continuous numbers.

An edge has no place along itself, so its place is its foot: the point of it nearest to the middle of the pad. Its direction is known up
to half a turn, so what is learned is (cos 2a, sin 2a). A kernel ridge regression learns them from the trials of the classes, each
labelled with what was aimed at; since nearby features mean nearby contacts, it says more of where the finger really is than any class
does. Beside it stands what the authors propose: the classes' own numbers, weighted by how probable each class is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.fingertip.nail.classify import NailModel
from skinfab.fingertip.nail.labels import Label

FloatArray = NDArray[np.float64]

#: Columns of a target: cosine and sine of twice the direction, foot (mm), logarithm of the force (N).
TARGETS = ("cos2a", "sin2a", "foot_x_mm", "foot_y_mm", "log_force")
#: How far the kernel reaches, in scatters of trials (two trials of a class are some 5 apart). Simulated, half of it and twice of it are
#: worse by 4 to 20 %.
REACH = 10.0
#: Ridge, as large as it is because labels say what was aimed at, not what was hit. Anything from 0.03 to 0.1 is within 7 % of the best.
RIDGE = 0.05
#: Forces that span less cannot be told from the scatter of placing.
LEAST_SPAN = 1.5
#: A force within this factor of the largest or the smallest that was learned is told as at the end: regression draws towards the middle,
#: so that of touches of twice the largest force and more, simulated, the middle one is told as 0.96 of it.
AT_END = 1.25
#: Directions (as cosine and sine) and feet (mm) that differ by less are one: rounding of what a table says.
_ALIKE = 1e-6


@dataclass(frozen=True)
class Continuous:
    """What is said of one contact; NaN where it was not learned.

    Parameters
    ----------
    angle_deg : float
        Of an edge, from x towards y, 0 to 180.
    x_mm, y_mm : float
        Foot of an edge, or the pin's place.
    force_n : float
    force_end : str
        ``high`` or ``low`` where the force is told at that end of those that were learned: it may be any beyond. Empty otherwise.
    """

    angle_deg: float = math.nan
    x_mm: float = math.nan
    y_mm: float = math.nan
    force_n: float = math.nan
    force_end: str = ""


def foot(x_mm: ArrayLike, y_mm: ArrayLike, angle_deg: ArrayLike) -> FloatArray:
    """The point of an edge through (x, y) nearest to the middle of the pad, (..., 2) mm; (x, y) itself where the angle is NaN, as a pin's.

    Examples
    --------
    >>> foot(4.5, 3.0, 45.0).round(9).tolist(), foot(3.0, 6.0, np.nan).tolist()
    ([0.75, -0.75], [3.0, 6.0])
    """
    place = np.stack(np.broadcast_arrays(np.asarray(x_mm, dtype=float), np.asarray(y_mm, dtype=float)), axis=-1)
    angle = np.radians(np.asarray(angle_deg, dtype=float))[..., None]
    normal = np.concatenate([-np.sin(angle), np.cos(angle)], axis=-1)
    out: FloatArray = np.where(np.isnan(angle), place, (place * normal).sum(axis=-1, keepdims=True) * normal)
    return out


def targets_of(labels: Sequence[Label], *, true: bool = False) -> FloatArray:
    """What labels say of their contacts, (n, 5) in the order of `TARGETS`; NaN where they say nothing.

    Parameters
    ----------
    labels : sequence of Label
    true : bool
        Where the pattern really lay, which a simulator knows, instead of what was aimed at.
    """
    ahead = "true_" if true else ""
    x, y, angle = (np.array([getattr(each, ahead + name) for each in labels]) for name in ("x_mm", "y_mm", "angle_deg"))
    force = np.array([each.force_n for each in labels])
    twice = np.radians(2 * angle)
    log_force = np.log(np.where(force > 0, force, np.nan))
    return np.column_stack([np.cos(twice), np.sin(twice), foot(x, y, angle), log_force])


def continuous_of(target: FloatArray) -> Continuous:
    """A target (5,) as what it means."""
    c, s, x, y, log_force = target.tolist()
    return Continuous(math.degrees(math.atan2(s, c)) / 2 % 180, x, y, math.exp(log_force) if log_force == log_force else math.nan)


def target_of(found: Continuous) -> FloatArray:
    """What is said of a contact as a target (5,): the other way round than `continuous_of`."""
    twice = math.radians(2 * found.angle_deg)
    return np.array([math.cos(twice), math.sin(twice), found.x_mm, found.y_mm, math.log(found.force_n)])


def angle_apart(a_deg: ArrayLike, b_deg: ArrayLike) -> FloatArray:
    """How far two directions differ, 0 to 90 degrees: an edge has no front.

    Examples
    --------
    >>> angle_apart([179.0, 10.0], [2.0, 100.0]).tolist()
    [3.0, 90.0]
    """
    return np.abs((np.asarray(a_deg, dtype=float) - np.asarray(b_deg, dtype=float) + 90) % 180 - 90)


def off_by(found: FloatArray, target: FloatArray) -> tuple[float, float, float]:
    """How far what is told (5,) lies off a target (5,): degrees, mm, part of the force; NaN where either says nothing.

    Examples
    --------
    >>> told, so = np.array([1.0, 0.0, 3.0, 4.0, math.log(1.5)]), np.array([-1.0, 0.0, 0.0, 0.0, 0.0])
    >>> [round(each, 9) for each in off_by(told, so)]
    [90.0, 5.0, 0.5]
    """
    angle = float(angle_apart(continuous_of(found).angle_deg, continuous_of(target).angle_deg))
    return angle, float(np.linalg.norm(found[2:4] - target[2:4])), abs(math.exp(found[4] - target[4]) - 1)


class Regression:
    """Kernel ridge regression of targets on a model's features.

    Parameters
    ----------
    model : NailModel
    targets : (n, 5) float
        Of the model's trials; NaN where unknown. A column without any is not learned.
    """

    def __init__(self, model: NailModel, targets: FloatArray) -> None:
        if targets.shape != (len(model.classes), len(TARGETS)):
            raise InputError(f"targets have shape {targets.shape} for {len(model.classes)} trials; give {len(TARGETS)} a trial")
        self.targets = targets
        self._W = np.linalg.inv(np.linalg.cholesky(model.scatter)) / (REACH * math.sqrt(2))
        self._white = model.learned @ self._W.T
        force = targets[np.isfinite(targets[:, 4]), 4]
        self._ends = (float(force.min()), float(force.max())) if len(force) else (-math.inf, math.inf)
        self._alpha, self._mean = np.zeros_like(targets), np.full(len(TARGETS), np.nan)
        for k, column in enumerate(targets.T):
            if not (known := np.isfinite(column)).any():
                continue
            self._mean[k] = column[known].mean()
            K = np.exp(-((self._white[known, None] - self._white[None, known]) ** 2).sum(axis=2))
            self._alpha[known, k] = np.linalg.solve(K + RIDGE * np.eye(len(K)), column[known] - self._mean[k])

    def estimate(self, features: FloatArray) -> FloatArray:
        """Targets (..., 5) of features (..., d); NaN in columns that were not learned."""
        apart = (features @ self._W.T)[..., None, :] - self._white
        out: FloatArray = np.exp(-np.einsum("...nd,...nd->...n", apart, apart)) @ self._alpha + self._mean
        return out

    def continuous(self, features: FloatArray) -> Continuous:
        """Of one window's features (d,), what they mean."""
        target = self.estimate(features)
        low, high = self._ends
        log_force = float(target[4])
        end = "high" if log_force > high - math.log(AT_END) else "low" if log_force < low + math.log(AT_END) else ""
        return replace(continuous_of(target), force_end=end)

    def of(self, model: NailModel) -> Regression:
        """The same learned from the channels of another model of the same trials."""
        return Regression(model, self.targets)


def by_probability(model: NailModel, targets: FloatArray, probability: FloatArray) -> FloatArray:
    """Mean targets of the classes, weighted by how probable each is: (n, k) to (n, 5).

    Parameters
    ----------
    model : NailModel
    targets : (m, 5) float
        Of the model's trials.
    probability : (n, k) float
        From `skinfab.fingertip.nail.classify.Decisions`.
    """
    own = np.array([targets[model.classes == k].mean(axis=0) for k in model.touched])
    out: FloatArray = probability @ own
    return out


def learnable(targets: FloatArray) -> tuple[FloatArray, list[str]]:
    """Targets without what cannot be learned from them, and why not, a sentence each.

    Directions or feet that are all one are left out, and forces that span less than a factor `LEAST_SPAN`.
    """
    kept, notes = targets.copy(), []
    for columns, what, differ in (
        ([0, 1], "edges lie in one direction", "turned otherwise"),
        ([2, 3], "patterns have their foot at one place", "to the side"),
    ):
        known = targets[np.isfinite(targets[:, columns]).all(axis=1)][:, columns]
        if len(known) and np.ptp(known, axis=0).max() < _ALIKE:
            kept[:, columns] = np.nan
            notes.append(f"all {what}, and no other can be learned from them; touch some {differ} too")
    force = targets[np.isfinite(targets[:, 4]), 4]
    if len(force) and np.ptp(force) < math.log(LEAST_SPAN):
        kept[:, 4] = np.nan
        notes.append(
            f"forces from {math.exp(force.min()):.3g} to {math.exp(force.max()):.3g} N are too much alike to learn a force from; press "
            f"{LEAST_SPAN:g} times harder than in others in some trials"
        )
    return kept, notes
