"""Learning shapes and judging it: always on objects that were not learned from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.confusion import Confusion, grouped_accuracy
from skinfab.fingertip.force.grasp import SHAPES, Grasp, Touches, touches
from skinfab.fingertip.force.network import Network
from skinfab.fingertip.force.shape import ShapeModel, features_of, fit_shapes, is_strange, misfit_limits
from skinfab.fingertip.splits import leave_one_out
from skinfab.rates import Rate

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Examples:
    """Grasps that can be learned from: those whose contacts have no fault.

    Parameters
    ----------
    found : list of Touches
    shape : (n,) int
        Numbers into `SHAPES`.
    object : (n,) int
    notes : tuple of str
        What was left out.
    """

    found: list[Touches]
    shape: IntArray
    object: IntArray
    notes: tuple[str, ...]


def examples(grasps: Sequence[Grasp]) -> Examples:
    """The contacts of labelled grasps.

    Raises
    ------
    InputError
        A grasp does not say its shape, an object has two, or none can be read.
    """
    said: dict[int, str] = {}
    kept = []
    for k, each in enumerate(grasps):
        if each.solid is None:
            raise InputError(f"grasp {k} (object {each.object}) does not say its shape; fill in the column shape: 0, 1 or 2")
        if said.setdefault(each.object, each.solid.shape) != each.solid.shape:
            raise InputError(f"object {each.object} is a {said[each.object]} and a {each.solid.shape}; give each its own number")
        found = touches(each)
        if not found.fault:
            kept.append((found, SHAPES.index(each.solid.shape), each.object))
    if not kept:
        raise InputError("no grasp can be read: in none do all four fingers touch; look at the sensors")
    left = len(grasps) - len(kept)
    notes = (f"{left} of {len(grasps)} grasps were left out: a finger did not touch",) if left else ()
    return Examples([f for f, _, _ in kept], np.array([s for _, s, _ in kept]), np.array([o for _, _, o in kept]), notes)


@dataclass(frozen=True, eq=False)
class HeldOut:
    """What was said of each grasp by a model that had not learned from its object.

    Parameters
    ----------
    probability : (n, 3) float
    shape : (n,) int
    object : (n,) int
    strange : (n,) bool
        Taken for none of the three, whatever the probabilities are.
    """

    probability: FloatArray
    shape: IntArray
    object: IntArray
    strange: NDArray[np.bool_]

    @property
    def accuracy(self) -> Rate:
        """With an interval that draws whole objects anew."""
        return grouped_accuracy(self.probability.argmax(axis=1) == self.shape, self.object.tolist())

    @property
    def confusion(self) -> Confusion:
        """What was taken for what."""
        return Confusion.of([SHAPES[k] for k in self.shape], [SHAPES[k] for k in self.probability.argmax(axis=1)], SHAPES)

    def rejection(self, confidences: Sequence[float]) -> list[tuple[float, float]]:
        """For each least confidence: the part of the grasps that is answered, and of these the part that is right (NaN of none)."""
        right, sure = self.probability.argmax(axis=1) == self.shape, self.probability.max(axis=1)
        out = []
        for least in confidences:
            answered = (sure >= least) & ~self.strange
            out.append((float(answered.mean()), float(right[answered].mean()) if answered.any() else float("nan")))
        return out


def train_shapes(of: Examples, features: str, *, seed: int = 0) -> tuple[ShapeModel, HeldOut]:
    """A model of all examples, and how good one is on an object that it does not know: each object is held out in turn.

    Raises
    ------
    InputError
        A shape has fewer than two objects, so that none of it would be left to learn from.
    """
    for k, shape in enumerate(SHAPES):
        count = len(set(of.object[of.shape == k].tolist()))
        if count < 2:
            raise InputError(f"there {'is 1 object' if count else 'are 0 objects'} of the shape {shape}; two are needed to hold one out")
    X = features_of(of.found, features)
    out = np.empty((len(X), len(SHAPES)))
    for train, test in leave_one_out(of.object.tolist()):
        out[test] = fit_shapes(X[train], of.shape[train], features, seed=seed).probability(X[test])
    misfits = X if features == "misfits" else features_of(of.found, "misfits")
    limits = misfit_limits(misfits, of.shape)  # no fit learns, so that each grasp is judged by what hardly knows it
    held = HeldOut(out, of.shape, of.object, is_strange(misfits, out.argmax(axis=1), limits))
    rate = held.accuracy
    facts = {"grasps": len(X), "objects": len(set(of.object.tolist())), "seed": seed, "held_out": [rate.value, rate.low, rate.high]}
    facts["misfit_limits"] = limits.tolist()
    return ShapeModel(features, fit_shapes(X, of.shape, features, seed=seed), facts), held


def judged(network: Network, of: Examples, features: str, *, limits: FloatArray | None = None) -> HeldOut:
    """What a network says of other objects' grasps; where `misfit_limits` are given, strange ones are of none of the three."""
    X = features_of(of.found, features)
    said = network.probability(X)
    strange = np.zeros(len(X), dtype=bool)
    if limits is not None:
        strange = is_strange(X if features == "misfits" else features_of(of.found, "misfits"), said.argmax(axis=1), limits)
    return HeldOut(said, of.shape, of.object, strange)
