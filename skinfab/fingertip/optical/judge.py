"""How far a model of an optical fingertip is off on images that it has not seen, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.regress import EdgeModel, Examples, learn
from skinfab.fingertip.splits import group_folds
from skinfab.rates import DRAWS

FloatArray = NDArray[np.float64]

#: What is judged, with its unit.
QUANTITIES = {"offset": "mm", "depth": "mm", "angle": "deg"}
#: Parts that groups are dealt out to.
FOLDS = 5
#: What is off by more than this part of what a guess is off by tells nothing.
CHANCE = 0.8
#: Called sure above this confidence.
SURE = 0.5


@dataclass(frozen=True)
class Error:
    """Absolute errors of one quantity.

    Parameters
    ----------
    quantity, unit : str
    mean, low, high : float
        And the mean's 95 % interval, by drawing whole groups anew.
    p95 : float
        Five in a hundred are worse.
    guess : float
        Mean error of saying the same of every image, without a look at it.
    sure : float or None
        Mean over the images that are called more than half sure; None where there are none.
    images : int
    """

    quantity: str
    unit: str
    mean: float
    low: float
    high: float
    p95: float
    guess: float
    sure: float | None
    images: int

    @property
    def chance(self) -> bool:
        """Is it no better than guessing?"""
        return self.mean > CHANCE * self.guess


def said(model: EdgeModel, examples: Examples) -> list[Edge]:
    """What a model says of images that were looked at already."""
    return [model.edge_of(examples.tracked(k)) for k in range(len(examples))]


def held_out(examples: Examples, groups: Sequence[Hashable]) -> list[Edge]:
    """What is said of each image by a model of the other folds' groups.

    Raises
    ------
    InputError
        There are fewer than five groups.
    """
    out: list[Edge] = [Edge(0.0, 0.0)] * len(examples)
    for inner, outer in group_folds(groups, k=FOLDS):
        model = learn(examples[inner], groups=[groups[k] for k in inner])
        for k, edge in zip(outer.tolist(), said(model, examples[outer]), strict=True):
            out[k] = edge
    return out


def off_by(edges: Sequence[Edge], truth: FloatArray) -> FloatArray:
    """Signed errors of offset (mm), depth (mm) and angle (degrees), (n, 3); NaN where a depth is not known.

    Parameters
    ----------
    edges : sequence of n Edge
    truth : (n, 3) or (n, 4) float
        As `Examples.truth`.

    Examples
    --------
    >>> turn = np.radians(-179)
    >>> off_by([Edge(1.0, np.radians(179), 2.0)], np.array([[0.5, np.cos(turn), np.sin(turn), 1.5]])).round(3).tolist()
    [[0.5, 0.5, -2.0]]
    """
    said_ = np.array([[e.offset_mm, e.angle_rad, e.depth_mm] for e in edges])
    turn = (said_[:, 1] - np.arctan2(truth[:, 2], truth[:, 1]) + math.pi) % math.tau - math.pi
    depth = said_[:, 2] - truth[:, 3] if truth.shape[1] == 4 else np.full(len(truth), np.nan)
    return np.c_[said_[:, 0] - truth[:, 0], depth, np.degrees(turn)]


def guessed(learned: FloatArray, truth: FloatArray) -> FloatArray:
    """What saying the mean of all that was learned of every image is off by: as `off_by`, which takes the same truths.

    Examples
    --------
    >>> learned = np.array([[1.0, 1.0, 0.0], [3.0, 1.0, 0.0]])
    >>> guessed(learned, np.array([[4.0, 0.0, 1.0]])).round(3).tolist()
    [[-2.0, nan, -90.0]]
    """
    mean = learned.mean(axis=0)
    depth = float(mean[3]) if len(mean) == 4 else math.nan
    return off_by([Edge(float(mean[0]), math.atan2(mean[2], mean[1]), depth)] * len(truth), truth)


def errors(off: FloatArray, groups: Sequence[Hashable], *, guess: FloatArray, confidence: Sequence[float], seed: int = 0) -> list[Error]:
    """Sum up signed errors (n, 3) beside those of `guessed`; what is known of no image is left out."""
    names = list(dict.fromkeys(groups))
    place = {name: k for k, name in enumerate(names)}
    of = np.array([place[each] for each in groups])
    count = np.bincount(of)
    drawn = np.random.default_rng(seed).integers(0, len(names), (DRAWS, len(names)))
    believed = np.array(confidence) > SURE
    out = []
    for k, (quantity, unit) in enumerate(QUANTITIES.items()):
        size = np.abs(off[:, k])
        if not np.isfinite(size).all():
            continue
        total = np.bincount(of, size)
        low, high = np.quantile(total[drawn].sum(axis=1) / count[drawn].sum(axis=1), (0.025, 0.975))
        means = (float(size.mean()), float(low), float(high), float(np.quantile(size, 0.95)), float(np.abs(guess[:, k]).mean()))
        out.append(Error(quantity, unit, *means, float(size[believed].mean()) if believed.any() else None, len(off)))
    return out
