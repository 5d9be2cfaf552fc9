"""A texture classifier: learned from labelled slides, judged on specimens it has not seen, saved as plain arrays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.confusion import Confusion, grouped_accuracy
from skinfab.fingertip.force.discriminant import Discriminant, far_limit, fit_discriminant
from skinfab.fingertip.force.texture import BAND_NAMES, N_FFT, PUBLISHED_NAMES, Slide, band_features, published_features
from skinfab.fingertip.saved import load_model, save_model
from skinfab.fingertip.splits import group_folds, require_apart
from skinfab.rates import Rate

FloatArray = NDArray[np.float64]

KIND = "force texture"
FOLDS = 5
#: Of a sample that is of no class.
UNKNOWN = "unknown"

FEATURES: dict[str, tuple[Callable[..., FloatArray], tuple[str, ...]]] = {
    "bands": (band_features, BAND_NAMES),
    "published": (published_features, PUBLISHED_NAMES),
}


@dataclass(frozen=True, eq=False)
class TextureModel:
    """A classifier of slides.

    Parameters
    ----------
    features : str
        ``bands``, or ``published``.
    n_fft : int
        Samples of a spectrum.
    rate_hz : float
        Of the logs it was learned from; others are refused.
    discriminant : Discriminant
    far : float
        Squared distance to the nearest class beyond which a slide is of no known material.
    """

    features: str
    n_fft: int
    rate_hz: float
    discriminant: Discriminant
    far: float

    def decide(self, slide: Slide) -> Decision:
        """What the finger slides over.

        Raises
        ------
        InputError
            It was sampled at another rate than what the model was learned from, or is too short.
        """
        if abs(slide.rate_hz / self.rate_hz - 1) > _RATE_FRACTION:
            raise InputError(
                f"the log has {slide.rate_hz:.4g} samples a second and the model was learned at {self.rate_hz:.4g}; "
                "record at that rate, or train a model at this one"
            )
        row = FEATURES[self.features][0](slide, n_fft=self.n_fft)[None]
        probabilities = self.discriminant.probabilities(row)[0]
        distance = float(self.discriminant.distances(row).min())
        best = self.discriminant.names[int(probabilities.argmax())]
        return Decision(
            best, float(probabilities.max()), distance <= self.far, dict(zip(self.discriminant.names, probabilities.tolist(), strict=True))
        )


#: Rates of one device differ by less: its clock is good to a few parts in a thousand.
_RATE_FRACTION = 0.02


@dataclass(frozen=True)
class Decision:
    """What a slide was taken for.

    Parameters
    ----------
    nearest : str
        The material that it is most like.
    probability : float
        Of that one, among the known ones.
    known : bool
        Is it as near to it as the material's own slides are?
    probabilities : dict
    """

    nearest: str
    probability: float
    known: bool
    probabilities: dict[str, float]

    @property
    def name(self) -> str:
        """The material, or ``unknown``."""
        return self.nearest if self.known else UNKNOWN


@dataclass(frozen=True, eq=False)
class Trained:
    """A model, and how good it is on slides that it was not learned from.

    Parameters
    ----------
    model : TextureModel
        Of all slides.
    said : (n,) tuple of str
        What each slide was taken for when it was held out.
    confusion : Confusion
        Of held-out slides.
    accuracy : Rate
        Of them; whole groups are drawn anew for its interval.
    ungrouped : float
        The same with slides of one specimen on both sides: what a random split would have promised.
    groups : int
    """

    model: TextureModel
    said: tuple[str, ...]
    confusion: Confusion
    accuracy: Rate
    ungrouped: float
    groups: int


def feature_table(slides: Sequence[Slide], features: str = "bands", *, n_fft: int = N_FFT) -> FloatArray:
    """A row of features a slide, (n, f)."""
    return np.stack([FEATURES[features][0](each, n_fft=n_fft) for each in slides])


def train_texture(
    slides: Sequence[Slide], labels: Sequence[str], groups: Sequence[str], *, features: str = "bands", n_fft: int = N_FFT, seed: int = 0
) -> Trained:
    """Learn from labelled slides.

    Parameters
    ----------
    slides : sequence of Slide
        All at one rate.
    labels, groups : sequence of str
        The material of each, and what must stay together: its specimen.
    features : str
        ``bands`` or ``published``.
    n_fft : int
    seed : int
        Of the folds.

    Raises
    ------
    InputError
        Rates differ, a slide is too short, or there are too few materials, slides or groups.
    """
    rates = np.array([each.rate_hz for each in slides])
    if len(rates) and np.ptp(rates) > _RATE_FRACTION * rates.mean():
        raise InputError(f"the logs have from {rates.min():.4g} to {rates.max():.4g} samples a second; record all at one rate")
    table = feature_table(slides, features, n_fft=n_fft)
    fitted = fit_discriminant(table, labels)
    # At least one group of each material must be left to learn from.
    fewest = min(len({g for g, own in zip(groups, labels, strict=True) if own == name}) for name in fitted.names)
    if fewest < 2:
        raise InputError("a material has one specimen (group) only, so none could be held out; give slides over two or more of each")
    said, distance = _held_out(table, labels, groups, min(FOLDS, fewest), seed)
    rows = [str(k) for k in range(len(labels))]
    loose, _ = _held_out(table, labels, rows, FOLDS, seed)
    right = np.array([a == b for a, b in zip(said, labels, strict=True)])
    return Trained(
        TextureModel(features, n_fft, float(rates.mean()), fitted, far_limit(distance)),
        tuple(said),
        Confusion.of(labels, said, fitted.names),
        grouped_accuracy(right, groups),
        float(np.mean([a == b for a, b in zip(loose, labels, strict=True)])),
        len(set(groups)),
    )


def _held_out(table: FloatArray, labels: Sequence[str], groups: Sequence[str], folds: int, seed: int) -> tuple[list[str], FloatArray]:
    """What each row is taken for by a model that has not seen its group, and its squared distance to that class."""
    said, distance = [""] * len(labels), np.empty(len(labels))
    for train, test in group_folds(groups, k=folds, strata=labels, seed=seed):
        require_apart(groups, train, test)
        model = fit_discriminant(table[train], [labels[k] for k in train])
        d = model.distances(table[test])
        distance[test] = d.min(axis=1)
        for k, best in zip(test.tolist(), d.argmin(axis=1).tolist(), strict=True):
            said[k] = model.names[best]
    return said, distance


def save_texture(trained: Trained, path: str | Path, *, made_from: Sequence[dict[str, Any]]) -> None:
    """Write a model with how good it is and what it was made from; the file says whether that was simulated."""
    model, d = trained.model, trained.model.discriminant
    facts = {
        "features": model.features,
        "n_fft": model.n_fft,
        "rate_hz": model.rate_hz,
        "far": model.far,
        "names": list(d.names),
        "simulated": any(each["simulated"] for each in made_from),
        "held_out": trained.confusion.facts(),
        "made_from": list(made_from),
    }
    save_model(path, kind=KIND, facts=facts, arrays={"centre": d.centre, "scale": d.scale, "means": d.means, "precision": d.precision})


def load_texture(path: str | Path) -> tuple[TextureModel, bool]:
    """Read a model; and whether it was made from simulated logs.

    Raises
    ------
    InputError
        As `skinfab.fingertip.saved.load_model`, or its parts do not fit one another.
    """
    saved = load_model(path, kind=KIND)
    facts, a = saved.facts, saved.arrays
    try:
        names = tuple(str(each) for each in facts["names"])
        features, n_fft = str(facts["features"]), int(facts["n_fft"])
        f = len(FEATURES[features][1])
        shapes = {"centre": (f,), "scale": (f,), "means": (len(names), f), "precision": (f, f)}
        if wrong := next((key for key, shape in shapes.items() if a[key].shape != shape), None):
            raise InputError(f"{path}: {wrong} has the shape {a[wrong].shape}, and {shapes[wrong]} is needed; train it again")
        model = TextureModel(
            features,
            n_fft,
            float(facts["rate_hz"]),
            Discriminant(names, a["centre"], a["scale"], a["means"], a["precision"]),
            float(facts["far"]),
        )
        return model, bool(facts["simulated"])
    except (KeyError, TypeError, ValueError) as fault:
        if isinstance(fault, InputError):
            raise
        raise InputError(f"{path}: a part of the model is missing or wrong ({fault!r}); train it again") from fault
