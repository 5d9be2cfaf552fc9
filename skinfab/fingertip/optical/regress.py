"""From pins to the edge: offset, angle and depth by kernel ridge regression on the principal components of how the pins moved.

The components keep their size: whitened, the last ones' noise would count as much as the first ones' movement. The angle is learned as
cosine and sine, so it has no seam. Width of the kernel and ridge are chosen on whole groups that are held out for it. (Saunders,
Gammerman and Vovk 1998.)

How sure it is has two parts. Is the image like those that were learned: as near to them as held-out ones are, also for how close
they lie to each other there? (Light touches all move the pins little and lie close; one depth more is far by that measure and near by
the plain one.) And was what is like it read rightly when it was held out itself?
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.pins import Image, Pins, Tracked, require_image
from skinfab.fingertip.splits import group_folds
from skinfab.tolerances import EDGE_RIGHT_DEG, EDGE_RIGHT_MM, EDGE_SIMILAR, EDGE_SPACING, PIN_COMPONENTS

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Widths (for features of a mean square of 1) and ridges that are tried.
GAMMAS, RIDGES = (0.3, 0.6, 1.2, 2.4, 4.8), (3e-3, 1e-2, 3e-2)
#: How the image that is judged differs from all that was learned is measured by what this part of held-out images reach.
_USUAL = 0.99
#: Groups that settings are chosen on: a fifth.
_PARTS = 5
#: Fewer images tell nothing.
LEAST_IMAGES = 20


@dataclass(frozen=True, eq=False)
class EdgeModel:
    """What was learned of a fingertip.

    Parameters
    ----------
    pins : Pins
    mean : (2 k,) float, px
        Usual movement of the pins.
    basis : (2 k, d) float
        Components as columns, scaled.
    support : (n, d) float
        Features that were learned from.
    weights : (n, 3) or (n, 4) float
        For offset, cosine, sine and, where it was known, depth.
    centre : (3,) or (4,) float
        What is said where nothing is like what was learned.
    gamma, ridge : float
        Of the kernel.
    spacing : (n,) float
        How far from each of the features the nearest others lie.
    wrong : (n,) float
        1 where the edge was read wrongly of an image while its group was held out, otherwise 0.
    usual : (3,) float
        Distance from what was learned, the same in parts of the spacing there, and movement outside the components (px), that held-out
        images have at most.
    """

    pins: Pins
    mean: FloatArray
    basis: FloatArray
    support: FloatArray
    weights: FloatArray
    centre: FloatArray
    gamma: float
    ridge: float
    spacing: FloatArray
    wrong: FloatArray
    usual: FloatArray

    def edge(self, image: Image) -> Edge:
        """The edge in an image.

        Raises
        ------
        InputError
            The image is of another size than those that were learned from.
        """
        return self.edge_of(self.pins.track(image))

    def edge_of(self, found: Tracked) -> Edge:
        """The edge that tracked pins tell."""
        moved = found.moved.ravel() - self.mean
        z = moved @ self.basis
        apart = np.maximum(self._support_square + z @ z - 2 * (self.support @ z), 0)
        said = np.exp(-self.gamma * apart) @ self.weights + self.centre
        outside = math.sqrt(max(float(moved @ moved - ((z / self._scale) ** 2).sum()), 0.0) / len(moved))
        like = _like(apart[None])[0]
        far, doubt = _far(apart[None], like[None], self.spacing), _mean_near(apart[like], self.wrong[like])
        strange = float(max(far[0][0] / self.usual[0], far[1][0] / self.usual[1], outside / self.usual[2]))
        # Twice as strange as anything that was held out: nothing is known of it. And a pin that is not seen is not known.
        confidence = min(max(2 - strange, 0.0), 1.0) * (1 - float(found.missing.mean()))
        depth = float(said[3]) if len(said) == 4 else math.nan
        return Edge(float(said[0]), math.atan2(said[2], said[1]), depth, confidence * min(math.hypot(said[1], said[2]), 1 - doubt))

    @cached_property
    def _support_square(self) -> FloatArray:
        return np.einsum("ij,ij->i", self.support, self.support)

    @cached_property
    def _scale(self) -> FloatArray:
        """Length of each column of the basis: the components themselves have length 1."""
        return np.linalg.norm(self.basis, axis=0)


@dataclass(frozen=True, eq=False)
class Examples:
    """Images that were looked at once, with what is true: to learn from any part of them.

    Parameters
    ----------
    pins : Pins
    moved : (n, 2 k) float, px
    missing : (n, k) bool
    truth : (n, 3) or (n, 4) float
        Offset (mm), cosine and sine of the angle and, where it is known of all, depth (mm).
    """

    pins: Pins
    moved: FloatArray
    missing: BoolArray
    truth: FloatArray

    @classmethod
    def of(cls, images: Sequence[Image], edges: Sequence[Edge], *, rest: Image | None = None, pins: Pins | None = None) -> Examples:
        """Track the pins of images.

        Parameters
        ----------
        images : sequence of (h, w) uint8
        edges : sequence of Edge
            What is true; depth is learned where all have one.
        rest : (h, w) uint8, optional
            The untouched fingertip; without it the pins' usual places count as rest.
        pins : Pins, optional
            Those of a model that is to be judged, instead of either: any number of images will do.

        Raises
        ------
        InputError
            There are too few images, or not as many as edges, or they differ in size, or have no pins in common.
        """
        if len(images) != len(edges):
            raise InputError(f"{len(images)} images and {len(edges)} edges; give one an image")
        if pins is None and len(images) < LEAST_IMAGES:
            raise InputError(f"{len(images)} images; {LEAST_IMAGES} or more are needed to learn from, and hundreds to learn well")
        shape = images[0].shape
        for k, image in enumerate(images):
            require_image(image, f"image {k + 1}")
            if image.shape != shape:
                raise InputError(f"image {k + 1} is of {image.shape} pixels and the first of {shape}; give images of one camera")
        if pins is None:
            pins = Pins.of_images(images) if rest is None else Pins.of_rest(require_image(rest, "the image at rest"))
        tracked = [pins.track(image) for image in images]
        truth = np.array([[e.offset_mm, math.cos(e.angle_rad), math.sin(e.angle_rad), e.depth_mm] for e in edges])
        if not np.isfinite(truth[:, :3]).all():
            raise InputError("an edge's offset or angle is not a number; leave its image out")
        return cls(
            pins,
            np.array([each.moved.ravel() for each in tracked]),
            np.array([each.missing for each in tracked]),
            truth if np.isfinite(truth[:, 3]).all() else truth[:, :3],
        )

    def __len__(self) -> int:
        return len(self.moved)

    def __getitem__(self, rows: NDArray[np.int64]) -> Examples:
        return Examples(self.pins, self.moved[rows], self.missing[rows], self.truth[rows])

    def tracked(self, k: int) -> Tracked:
        """The pins of the k-th image."""
        return Tracked(self.moved[k].reshape(-1, 2), self.missing[k], 0)


def train(
    images: Sequence[Image], edges: Sequence[Edge], *, groups: Sequence[Hashable] | None = None, rest: Image | None = None
) -> EdgeModel:
    """Learn from labelled images.

    Parameters
    ----------
    images : sequence of (h, w) uint8
    edges : sequence of Edge
        What is true.
    groups : sequence, optional
        Of each image, the trial that it is of; each its own where it is left out.
    rest : (h, w) uint8, optional
        The untouched fingertip.

    Raises
    ------
    InputError
        As `Examples.of`; or there are fewer than five groups.

    Examples
    --------
    >>> from skinfab.fingertip.optical.labelled import labelled
    >>> from skinfab.fingertip.optical.simulator import Fingertip
    >>> tip = Fingertip()
    >>> some = list(labelled(tip, 60, reach_mm=4))
    >>> model = train([one.image for one in some], [one.edge for one in some], rest=tip.image(tip.rest))
    >>> [new] = labelled(tip, 1, reach_mm=2, seed=5)
    >>> abs(model.edge(new.image).offset_mm - new.edge.offset_mm) < 2
    True
    """
    return learn(Examples.of(images, edges, rest=rest), groups=groups)


def learn(examples: Examples, *, groups: Sequence[Hashable] | None = None) -> EdgeModel:
    """Learn from examples: settings on a fifth of the groups, then from all of them."""
    groups = range(len(examples)) if groups is None else groups
    inner, held = group_folds(groups, k=_PARTS)[0]
    first, other = examples[inner], examples[held]
    mean, basis = _components(first)
    Z, W = (first.moved - mean) @ basis, (other.moved - mean) @ basis
    near, across = _apart(Z, Z), _apart(W, Z)
    centre, spread = first.truth.mean(axis=0), np.maximum(first.truth.std(axis=0), 1e-12)

    def error(setting: tuple[float, float]) -> float:
        gamma, ridge = setting
        said = np.exp(-gamma * across) @ _solve(near, first.truth - centre, gamma, ridge)
        return float((((said + centre - other.truth) / spread) ** 2).mean())

    gamma, ridge = min(itertools.product(GAMMAS, RIDGES), key=error)
    far, far_by_spacing = _far(across, _like(across), _spacing(near))
    usual = [np.quantile(each, _USUAL) for each in (far, far_by_spacing, _outside(other.moved - mean, W, basis))]
    mean, basis = _components(examples)
    Z = (examples.moved - mean) @ basis
    centre, apart = examples.truth.mean(axis=0), _apart(Z, Z)
    weights, wrong = _solve_and_judge(apart, examples.truth, centre, gamma, ridge, groups)
    return EdgeModel(
        examples.pins, mean, basis, Z, weights, centre, gamma, ridge, _spacing(apart), wrong, np.maximum(np.array(usual), 1e-9)
    )


def _like(apart: FloatArray) -> NDArray[np.intp]:
    """The features that each image (a row of squared distances) is most like, (a, k)."""
    k = min(EDGE_SIMILAR, apart.shape[1])
    return np.argpartition(apart, k - 1, axis=1)[:, :k]


def _spacing(apart: FloatArray) -> FloatArray:
    """How far the nearest others of each lie, (n,)."""
    k = min(EDGE_SPACING, len(apart) - 1)
    near = np.partition(apart, k, axis=1)[:, : k + 1]  # itself among them
    out: FloatArray = np.maximum(np.sqrt(near.sum(axis=1) / k), 1e-9)
    return out


def _far(apart: FloatArray, like: NDArray[np.intp], spacing: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance from the nearest feature, and the same in parts of the spacing there; each (a,)."""
    nearest = np.sqrt(apart.min(axis=1))
    return nearest, nearest / spacing[like].mean(axis=1)


def _mean_near(apart: FloatArray, values: FloatArray) -> float:
    """Mean of values, those nearer counting more."""
    weight = np.exp(-4 * apart / max(float(apart.max()), 1e-12))
    return float(weight @ values / weight.sum())


def _components(examples: Examples) -> tuple[FloatArray, FloatArray]:
    """Mean movement, and the principal components scaled so that the features' mean square is 1."""
    mean = examples.moved.mean(axis=0)
    spread, vectors = np.linalg.eigh(np.cov(examples.moved.T))
    count = min(PIN_COMPONENTS, len(examples) - 1, len(mean))
    spread, vectors = spread[::-1][:count], vectors[:, ::-1][:, :count]
    if not spread[0] > 0:
        raise InputError("the pins are in the same places in all images; give images of different contacts")
    kept = spread > 1e-9 * spread[0]
    return mean, vectors[:, kept] / math.sqrt(spread[kept].sum())


def _outside(moved: FloatArray, Z: FloatArray, basis: FloatArray) -> FloatArray:
    """Root mean square of what the components leave of movements, (n,) px."""
    left = (moved**2).sum(axis=1) - ((Z / np.linalg.norm(basis, axis=0)) ** 2).sum(axis=1)
    out: FloatArray = np.sqrt(np.maximum(left, 0) / moved.shape[1])
    return out


def _apart(A: FloatArray, B: FloatArray) -> FloatArray:
    """Squared distances of rows, (a, b)."""
    out: FloatArray = np.maximum((A * A).sum(axis=1)[:, None] + (B * B).sum(axis=1) - 2 * A @ B.T, 0)
    return out


def _solve(apart: FloatArray, truth: FloatArray, gamma: float, ridge: float) -> FloatArray:
    from scipy.linalg import cho_factor, cho_solve

    K = _kernel(apart, gamma, ridge)
    out: FloatArray = cho_solve(cho_factor(K, lower=True, overwrite_a=True, check_finite=False), truth, check_finite=False)
    return out


def _kernel(apart: FloatArray, gamma: float, ridge: float) -> FloatArray:
    K = np.exp(-gamma * apart)
    K[np.diag_indices_from(K)] += ridge
    return K


def _solve_and_judge(
    apart: FloatArray, truth: FloatArray, centre: FloatArray, gamma: float, ridge: float, groups: Sequence[Hashable]
) -> tuple[FloatArray, FloatArray]:
    """Weights, and of which images the edge is wrong when their groups are held out.

    What a model without rows S would say of them follows from the inverse of the whole kernel: off by inv(K^-1[S, S]) weights[S]
    (Rasmussen and Williams 2006, equation 5.12, for one row).
    """
    from scipy.linalg import cho_factor, cho_solve, solve

    inverse = cho_solve(cho_factor(_kernel(apart, gamma, ridge), lower=True, check_finite=False), np.eye(len(apart)), check_finite=False)
    weights: FloatArray = inverse @ (truth - centre)
    said = truth.copy()
    for _, held in group_folds(groups, k=_PARTS):
        said[held] -= solve(inverse[np.ix_(held, held)], weights[held], assume_a="pos")
    turned = np.arctan2(said[:, 2], said[:, 1]) - np.arctan2(truth[:, 2], truth[:, 1])
    turned = np.abs((turned + math.pi) % math.tau - math.pi)
    wrong = (np.abs(said[:, 0] - truth[:, 0]) > EDGE_RIGHT_MM) | (turned > math.radians(EDGE_RIGHT_DEG))
    return weights, wrong.astype(float)
