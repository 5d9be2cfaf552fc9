"""Sphere, cylinder or cuboid, from the four contacts of one grasp; where that is not clear enough, grasp again.

Published: contact points and normals as they are, 24 numbers, into a 24-50-3 network. They change with every turn of the
object. Here: how badly the best sphere, cylinder and cuboid miss the contacts, three numbers that do not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.fits import FITS
from skinfab.fingertip.force.grasp import FINGERS, SHAPES, Grasp, Touches, touches
from skinfab.fingertip.force.network import Network, fit_network
from skinfab.fingertip.saved import load_model, save_model

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Less than this is no answer but a reason to grasp again: the paper's.
CONFIDENCE = 0.9
#: Grasps of one object after which the likeliest shape is said, however unclear it is.
MOST_GRASPS = 4
#: What `Decision.shape` is where the contacts are of none of the three.
NONE = "none of these"
#: So large a part of the grasps learned from fits some shape better than what is taken for none ...
KNOWN = 0.99
#: ... and one of a shape misses it by more than what is taken for none no oftener than this (or once in all of them and one more).
STRANGE_CHANCE = 0.05
#: Hidden sigmoids: the paper's, and what three features need (docs/force.md).
PUBLISHED_HIDDEN, HIDDEN = 50, 3
#: Weight decay of each: what serves its own features best.
PUBLISHED_DECAY, DECAY = 3e-3, 1e-3
#: A misfit is no smaller: exact contacts would have none, and no logarithm.
_LEAST_MISFIT = 1e-3

KIND, VERSION = "force shape", 2


def raw_features(found: Touches) -> FloatArray:
    """(24,) contact points (mm) and normals, finger after finger, in the hand's frame: the paper's."""
    return np.concatenate([found.point.ravel(), found.normal.ravel()])


def pose_free_features(found: Touches) -> FloatArray:
    """(17,) numbers that no turn or shift of the object changes: what the normals' products, spans and lines say."""
    P, N = found.point, found.normal
    products = np.sort(np.abs(N @ N.T)[np.triu_indices(FINGERS, 1)])
    across = np.eye(3) - N[:, :, None] * N[:, None, :]
    # Where nearly parallel normals leave the meeting point open it is the nearest to the contacts' middle.
    middle = P.mean(axis=0)
    meet = middle + np.linalg.lstsq(across.sum(axis=0), np.einsum("kij,kj->i", across, P - middle), rcond=1e-3)[0]
    off, far = np.linalg.norm(np.einsum("kij,kj->ki", across, meet - P), axis=1), np.linalg.norm(P - meet, axis=1)
    around = np.sort(np.linalg.norm(P - middle, axis=1))
    return np.concatenate([products, np.linalg.svd(N, compute_uv=False), [off.mean(), off.max(), far.std() / far.mean()], around])


def misfit_features(found: Touches) -> FloatArray:
    """(3,) logarithms of how badly the best sphere, cylinder and cuboid miss the contacts."""
    return np.log([max(FITS[shape](found.point, found.normal).misfit, _LEAST_MISFIT) for shape in SHAPES])


def misfit_limits(misfits: FloatArray, shape: IntArray) -> FloatArray:
    """(4,) limits of the misfit of a sphere, a cylinder and a cuboid, each by its own grasps, and of the best of the three by all.

    The first three are order statistics (split conformal prediction): one more grasp of a shape misses it by more than its limit with
    a probability of at most `STRANGE_CHANCE`, or of 1 / (n + 1) where there are too few.

    Parameters
    ----------
    misfits : (n, 3) float
        Logarithms, see `misfit_features`.
    shape : (n,) int

    Examples
    --------
    >>> own = np.log(np.arange(1.0, 40.0))
    >>> misfit_limits(np.column_stack([own, own + 9, own + 9]), np.zeros(39, dtype=int))[:2].round(6).tolist()
    [38.0, inf]
    """
    out = np.full(len(SHAPES) + 1, np.inf)
    for k in range(len(SHAPES)):
        own = np.sort(misfits[shape == k, k])
        if len(own):
            out[k] = own[-max(int(STRANGE_CHANCE * (len(own) + 1)), 1)]
    out[-1] = np.quantile(misfits.min(axis=1), KNOWN)
    return np.exp(out)


def is_strange(misfits: FloatArray, likely: IntArray, limits: FloatArray) -> NDArray[np.bool_]:
    """Which grasps (n,) are of none of the three: no shape fits, or not the one that they are said to be of."""
    own = misfits[np.arange(len(misfits)), likely]
    return np.asarray((np.exp(misfits.min(axis=1)) > limits[-1]) | (np.exp(own) > limits[likely]))


FEATURES: dict[str, Callable[[Touches], FloatArray]] = {
    "published": raw_features,
    "pose-free": pose_free_features,
    "misfits": misfit_features,
}


@dataclass(frozen=True, eq=False)
class ShapeModel:
    """A network over one kind of features.

    Parameters
    ----------
    features : str
        One of `FEATURES`.
    network : Network
    facts : mapping
        What it was learned from and how good it was.
    """

    features: str
    network: Network
    facts: dict[str, Any]

    def probability(self, found: Sequence[Touches]) -> FloatArray:
        """(n, 3) of each grasp being of each of `SHAPES`."""
        return self.network.probability(features_of(found, self.features))

    @property
    def limits(self) -> FloatArray:
        """See `misfit_limits`; infinite where the model has none, as one of version 1 has none of each shape."""
        default = [math.inf] * len(SHAPES) + [float(self.facts.get("misfit_limit", math.inf))]
        return np.array(self.facts.get("misfit_limits", default), dtype=float)

    def save(self, path: str | Path) -> None:
        """Write it as arrays and JSON."""
        net = self.network
        arrays = {"mean": net.mean, "scale": net.scale, "hidden": net.hidden, "output": net.output}
        facts = {**self.facts, "features": self.features, "shapes": list(SHAPES)}
        save_model(path, kind=KIND, version=VERSION, facts=facts, arrays=arrays)

    @classmethod
    def load(cls, path: str | Path) -> ShapeModel:
        """Read what `save` wrote.

        Raises
        ------
        InputError
            It is no such file, damaged, or of other shapes or features.
        """
        saved = load_model(path, kind=KIND, version=VERSION)
        facts = dict(saved.facts)
        try:
            features, shapes = str(facts.pop("features")), facts.pop("shapes")
            model = cls(features, Network(*(saved.arrays[name] for name in ("mean", "scale", "hidden", "output"))), facts)
            limits = model.limits
        except (KeyError, TypeError, ValueError) as fault:
            raise InputError(f"{path} lacks a part of a model of shapes ({fault}); train it again") from fault
        if limits.shape != (len(SHAPES) + 1,) or not (limits > 0).all():
            raise InputError(f"{path}: its limits of the misfit are {limits.tolist()}, which are none; train it again")
        if features not in FEATURES or shapes != list(SHAPES) or model.network.output.shape[1] != len(SHAPES):
            raise InputError(f"{path} is a model of {shapes} by {features!r} features, which are not known here; train it again")
        return model


def features_of(found: Sequence[Touches], features: str) -> FloatArray:
    """(n, d) of many grasps."""
    return np.array([FEATURES[features](each) for each in found])


def fit_shapes(X: FloatArray, y: IntArray, features: str, *, seed: int = 0) -> Network:
    """The network for features (n, d) and shapes (n,), numbers into `SHAPES`; the published ones get the published network."""
    hidden, decay = (PUBLISHED_HIDDEN, PUBLISHED_DECAY) if features == "published" else (HIDDEN, DECAY)
    return fit_network(X, y, classes=len(SHAPES), hidden=hidden, decay=decay, seed=seed)


@dataclass(frozen=True)
class Decision:
    """What is said of an object.

    Parameters
    ----------
    shape : str
        The likeliest, or `NONE`: it misses the contacts by more than those of 95 % of its own grasps, see `misfit_limits`.
    confidence : float
    grasps : int
        So many it took.
    sure : bool
        False where even the last grasp left it unclear.
    """

    shape: str
    confidence: float
    grasps: int
    sure: bool


def decide(model: ShapeModel, grasps: Sequence[Grasp], *, confidence: float = CONFIDENCE) -> Decision:
    """Grasp after grasp of one object until one shape is likely enough: their probabilities are multiplied.

    A grasp whose contacts are faulty says nothing, and one that no shape fits says that it is none of them; that is the answer
    where half of those taken or more say so.

    Raises
    ------
    InputError
        There is no grasp, or all are faulty.
    """
    weight, taken, strange = np.zeros(len(SHAPES)), 0, 0
    limits = model.limits
    probability = np.full(len(SHAPES), 1 / len(SHAPES))
    faults = []
    for each in grasps:
        found = touches(each)
        if found.fault:
            faults.append(found.fault)
            continue
        taken += 1
        said = model.probability([found])[0]
        if is_strange(misfit_features(found)[None], said.argmax(keepdims=True), limits)[0]:
            strange += 1
            continue
        weight = weight + np.log(np.maximum(said, np.finfo(float).tiny))
        probability = np.exp(weight - weight.max())
        probability /= probability.sum()
        if probability.max() >= confidence and 2 * strange < taken:
            break
    if not taken:
        raise InputError(f"no grasp can be read: {'; '.join(faults) or 'there is none'}; grasp again")
    if 2 * strange >= taken:
        return Decision(NONE, 0.0, taken, False)
    best = int(probability.argmax())
    return Decision(SHAPES[best], float(probability[best]), taken, bool(probability[best] >= confidence))
