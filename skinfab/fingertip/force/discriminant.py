"""Linear discriminant analysis in plain arrays: few samples a class, a decision in microseconds, and a word on what fits no class.

Classes share one covariance, shrunk towards a multiple of the unit matrix by Ledoit and Wolf (2004), so that it can be
inverted however few samples there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: A sample whose distance to the nearest class is more than this part of the held-out ones' is of no class: one in a hundred
#: of the known materials is turned away too.
_FAR_QUANTILE = 0.99


@dataclass(frozen=True, eq=False)
class Discriminant:
    """A fitted model.

    Parameters
    ----------
    names : (c,) tuple of str
    centre, scale : (f,) float
        Features are taken off and divided by these.
    means : (c, f) float
        Of the scaled features.
    precision : (f, f) float
        Inverse of the shrunk covariance within classes.
    """

    names: tuple[str, ...]
    centre: FloatArray
    scale: FloatArray
    means: FloatArray
    precision: FloatArray

    def distances(self, features: FloatArray) -> FloatArray:
        """Squared Mahalanobis distance of each sample (n, f) to each class, (n, c)."""
        apart = ((features - self.centre) / self.scale)[:, None] - self.means
        out: FloatArray = np.einsum("ncf,fg,ncg->nc", apart, self.precision, apart)
        return out

    def probabilities(self, features: FloatArray) -> FloatArray:
        """Of each class, (n, c), all being equally frequent."""
        d = self.distances(features)
        weight = np.exp(-0.5 * (d - d.min(axis=1, keepdims=True)))
        out: FloatArray = weight / weight.sum(axis=1, keepdims=True)
        return out

    def says(self, features: FloatArray) -> list[str]:
        """The nearest class of each sample."""
        return [self.names[k] for k in self.distances(features).argmin(axis=1)]


def fit_discriminant(features: FloatArray, labels: Sequence[str]) -> Discriminant:
    """Fit to samples.

    Parameters
    ----------
    features : (n, f) float
    labels : sequence of n

    Raises
    ------
    InputError
        Fewer than two classes, one with fewer than two samples, or a feature that is not finite.

    Examples
    --------
    >>> X = np.array([[0.0, 0.1], [0.1, 0.0], [1.0, 0.9], [0.9, 1.0]])
    >>> model = fit_discriminant(X, ["smooth", "smooth", "rough", "rough"])
    >>> model.says(np.array([[0.2, 0.1], [0.8, 0.7]]))
    ['smooth', 'rough']
    """
    names = tuple(sorted(set(labels)))
    if len(names) < 2:
        raise InputError(f"there are logs of {', '.join(names) or 'nothing'} alone; give logs of two materials or more")
    if not np.isfinite(features).all():
        raise InputError("a feature is not finite; look at the logs")
    of = np.array([names.index(each) for each in labels])
    counts = np.bincount(of)
    if counts.min() < 2:
        raise InputError(f"there is one log of {names[int(counts.argmin())]}; give two or more of each material")
    centre, scale = features.mean(axis=0), features.std(axis=0)
    scale = np.where(scale > 0, scale, 1.0)  # a feature that never changes says nothing, and stays nothing
    scaled = (features - centre) / scale
    means = np.stack([scaled[of == k].mean(axis=0) for k in range(len(names))])
    from sklearn.covariance import ledoit_wolf

    covariance, _ = ledoit_wolf(scaled - means[of], assume_centered=True)
    covariance *= len(features) / max(len(features) - len(names), 1)
    # Where samples of a class are alike to the last digit there is no spread to measure distances by; any will do.
    floor = max(float(np.trace(covariance)) / len(covariance), np.finfo(float).tiny) * np.sqrt(np.finfo(float).eps)
    return Discriminant(names, centre, scale, means, np.linalg.inv(covariance + floor * np.eye(len(covariance))))


def far_limit(distances: FloatArray) -> float:
    """Beyond this squared distance to the nearest class a sample is of none; from held-out samples' distances (n,)."""
    return float(np.quantile(distances, _FAR_QUANTILE))
