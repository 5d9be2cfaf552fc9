"""A texture classifier: learned from labelled slides, judged on specimens it has not seen, saved as plain arrays."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
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


@dataclass(frozen=True)
class Length:
    """How held-out slides of one length fared: the fewer windows are averaged, the more a slide's features scatter.

    Parameters
    ----------
    samples : int
    far : float
        Squared distance to the nearest class beyond which a slide of that length is of no known material.
    right : float
        Part of them that was told right.
    """

    samples: int
    far: float
    right: float


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
    lengths : tuple of Length
        Ascending; the last one is that of the slides that it was learned from.
    """

    features: str
    n_fft: int
    rate_hz: float
    discriminant: Discriminant
    lengths: tuple[Length, ...]

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
        judged = _judged(len(slide.normal), self.lengths)
        return Decision(
            best,
            float(probabilities.max()),
            distance <= judged.far,
            dict(zip(self.discriminant.names, probabilities.tolist(), strict=True)),
            windows(len(slide.normal), self.n_fft),
            judged.right,
            len(slide.normal) < _SHORT * self.lengths[-1].samples,
        )


def windows(samples: int, n_fft: int) -> int:
    """Windows of `n_fft` that overlap by half in so many samples; one where they are fewer.

    Examples
    --------
    >>> windows(400, 512), windows(1100, 512)
    (1, 3)
    """
    return 1 + max(samples - n_fft, 0) // max(n_fft // 2, 1)


def _judged(samples: int, lengths: Sequence[Length]) -> Length:
    """The next shorter one: its slides scatter at least as much. The shortest where there is none."""
    return max((each for each in lengths if each.samples <= samples), key=lambda each: each.samples, default=lengths[0])


#: Of the usual length: below, it is said that a slide is short. And two lengths at which slides are judged are so far apart.
_SHORT = 0.7
#: The shortest length that is judged, s; what slides for less is refused.
_SHORTEST_S = 1.0
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
        Of the known materials, as if it were one of them.
    windows : int
        That its spectrum was averaged over.
    right : float
        Part of the held-out slides of that length that was told right.
    short : bool
        Is it much shorter than those that the model was learned from?
    """

    nearest: str
    probability: float
    known: bool
    probabilities: dict[str, float]
    windows: int
    right: float
    short: bool

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
    samples = _lengths([len(each.normal) for each in slides], round(_SHORTEST_S * float(rates.mean())) if features == "bands" else n_fft)
    tables = [feature_table([_cut(each, n) for each in slides], features, n_fft=n_fft) for n in samples[:-1]]
    table = feature_table(slides, features, n_fft=n_fft)
    fitted = fit_discriminant(table, labels)
    # At least one group of each material must be left to learn from.
    fewest = min(len({g for g, own in zip(groups, labels, strict=True) if own == name}) for name in fitted.names)
    if fewest < 2:
        raise InputError("a material has one specimen (group) only, so none could be held out; give slides over two or more of each")
    judged = _held_out([*tables, table], labels, groups, min(FOLDS, fewest), seed)
    rows = [str(k) for k in range(len(labels))]
    ((loose, _),) = _held_out([table], labels, rows, FOLDS, seed)
    said = judged[-1][0]
    lengths = tuple(
        Length(n, far_limit(distance), float(np.mean([a == b for a, b in zip(of, labels, strict=True)])))
        for n, (of, distance) in zip(samples, judged, strict=True)
    )
    right = np.array([a == b for a, b in zip(said, labels, strict=True)])
    return Trained(
        TextureModel(features, n_fft, float(rates.mean()), fitted, lengths),
        tuple(said),
        Confusion.of(labels, said, fitted.names),
        grouped_accuracy(right, groups),
        float(np.mean([a == b for a, b in zip(loose, labels, strict=True)])),
        len(set(groups)),
    )


def _lengths(samples: Sequence[int], shortest: int) -> list[int]:
    """The lengths at which slides are judged: the median, and steps down to the shortest."""
    usual = int(np.median(samples))
    steps = math.floor(math.log(max(usual / shortest, 1.0)) / -math.log(_SHORT))
    return [round(usual * _SHORT**k) for k in range(steps, 0, -1)] + [usual]


def _cut(slide: Slide, n: int) -> Slide:
    return replace(slide, tangential=slide.tangential[:n], normal=slide.normal[:n], inclination=slide.inclination[:n])


def _held_out(
    tables: Sequence[FloatArray], labels: Sequence[str], groups: Sequence[str], folds: int, seed: int
) -> list[tuple[list[str], FloatArray]]:
    """What each row of each table is taken for by a model that has not seen its group, and its squared distance to that class.

    Learned is from the last table alone.
    """
    out = [([""] * len(labels), np.empty(len(labels))) for _ in tables]
    for train, test in group_folds(groups, k=folds, strata=labels, seed=seed):
        require_apart(groups, train, test)
        model = fit_discriminant(tables[-1][train], [labels[k] for k in train])
        for table, (said, distance) in zip(tables, out, strict=True):
            d = model.distances(table[test])
            distance[test] = d.min(axis=1)
            for k, best in zip(test.tolist(), d.argmin(axis=1).tolist(), strict=True):
                said[k] = model.names[best]
    return out


def save_texture(trained: Trained, path: str | Path, *, made_from: Sequence[dict[str, Any]]) -> None:
    """Write a model with how good it is and what it was made from; the file says whether that was simulated."""
    model, d = trained.model, trained.model.discriminant
    facts = {
        "features": model.features,
        "n_fft": model.n_fft,
        "rate_hz": model.rate_hz,
        "lengths": [asdict(each) for each in model.lengths],
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
            tuple(Length(int(each["samples"]), float(each["far"]), float(each["right"])) for each in facts["lengths"]),
        )
        samples = [each.samples for each in model.lengths]
        if not samples or samples[0] < 1 or sorted(set(samples)) != samples or not all(each.far > 0 for each in model.lengths):
            raise InputError(f"{path}: its lengths of slides are none; train it again")
        return model, bool(facts["simulated"])
    except (KeyError, TypeError, ValueError) as fault:
        if isinstance(fault, InputError):
            raise
        raise InputError(f"{path}: a part of the model is missing or wrong ({fault!r}); train it again") from fault
