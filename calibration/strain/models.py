"""From readings to angles: the curve alone, a curve a branch, and the curve with slack or lag added.

Each model starts from the monotone curve and adds what the hysteresis of a soft sensor needs, if anything; all of them
look only at the past, so that a controller can run them, and say of each reading whether it lies outside what they know.

poly      the inverse curve.
branches  one curve for rising and one for falling readings, blended by where the reading stands within a small band of
          play: no jump where the finger turns.
play      the inverse curve, corrected by play operators on it (a Prandtl-Ishlinskii model of the angle).
lag       the inverse curve, corrected by what it was 50 and 100 ms ago.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from calibration.strain.curve import Curve, fit_curve
from calibration.strain.play import Play, play
from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Half-width of the band in which the branches are blended, as part of the readings' span: beyond noise, below the slack.
BLEND = 0.03
#: Radii of the play operators, as parts of the range of angles: from the noise to a quarter of the range.
RADII = (0.03, 0.08, 0.15, 0.25)
#: How long ago the lag model looks, s: once and twice the time constant of a soft sensor.
LAGS_S = (0.05, 0.10)
#: Ridge on standardised features: they are nearly alike, and without it a new task meets huge weights of either sign.
RIDGE = 1.0


@dataclass(frozen=True, eq=False)
class Samples:
    """Readings and true angles in the order of time, without a gap.

    Parameters
    ----------
    time : (n,) float, s
    signal : (n,) float
        dU/U0.
    angle : (n,) float, deg
    fit : (n,) bool
        Which ones count: in the range of angles, and valid. The others are only what came before.
    """

    time: FloatArray
    signal: FloatArray
    angle: FloatArray
    fit: BoolArray


class Tracker(Protocol):
    """A model at work: it is told readings as they come, in order."""

    def step(self, time: float, signal: float) -> tuple[float, bool]:
        """The angle (deg) now, and whether the reading lies outside what the model knows."""
        ...


class Model(Protocol):
    """A fitted model."""

    name: ClassVar[str]

    @property
    def curve(self) -> Curve:
        """The monotone curve it stands on."""
        ...

    def estimate(self, time: FloatArray, signal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Angles (deg) of readings in the order of time, and which lie outside what the model knows."""
        ...

    def tracker(self) -> Tracker:
        """The same sample by sample, from a new start."""
        ...

    def numbers(self) -> dict[str, Any]:
        """All that it consists of, for a file; `model_of` reads it back."""
        ...


@dataclass(frozen=True, eq=False)
class CurveModel:
    """The inverse curve."""

    curve: Curve
    name: ClassVar[str] = "poly"

    def estimate(self, time: FloatArray, signal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """As `Model.estimate`."""
        return self.curve.angle(signal)

    def tracker(self) -> Tracker:
        """As `Model.tracker`."""
        return _CurveTracker(self.curve)

    def numbers(self) -> dict[str, Any]:
        """As `Model.numbers`."""
        return {"curve": self.curve.numbers()}

    @classmethod
    def fit(cls, runs: Sequence[Samples], *, degree: int) -> CurveModel:
        """To the samples of `runs` that count."""
        return cls(_curve(runs, degree))

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Any]) -> CurveModel:
        """What `numbers` gave."""
        return cls(Curve.of_numbers(numbers["curve"]))


class _CurveTracker:
    def __init__(self, curve: Curve) -> None:
        self._curve = curve

    def step(self, time: float, signal: float) -> tuple[float, bool]:
        return self._curve.angle_of(signal)


@dataclass(frozen=True, eq=False)
class BranchModel:
    """A curve for rising readings and one for falling ones; `band`: half-width of the play that tells them apart."""

    curve: Curve
    rising: Curve
    falling: Curve
    band: float
    name: ClassVar[str] = "branches"

    def estimate(self, time: FloatArray, signal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """As `Model.estimate`."""
        part = (1 + (signal - play(signal, self.band)) / self.band) / 2
        (up, up_out), (down, down_out) = self.rising.angle(signal), self.falling.angle(signal)
        return part * up + (1 - part) * down, np.where(part >= 0.5, up_out, down_out)

    def tracker(self) -> Tracker:
        """As `Model.tracker`."""
        return _BranchTracker(self)

    def numbers(self) -> dict[str, Any]:
        """As `Model.numbers`."""
        return {
            "curve": self.curve.numbers(),
            "rising": self.rising.numbers(),
            "falling": self.falling.numbers(),
            "band": self.band,
        }

    @classmethod
    def fit(cls, runs: Sequence[Samples], *, degree: int) -> BranchModel:
        """To the samples of `runs` that count.

        Raises
        ------
        InputError
            They go one way only.
        """
        span = max(float(run.signal[run.fit].max()) for run in runs if run.fit.any()) - min(
            float(run.signal[run.fit].min()) for run in runs if run.fit.any()
        )
        band = BLEND * span
        up, down = [], []
        for run in runs:
            rises = run.signal - play(run.signal, band) > 0
            up.append(Samples(run.time, run.signal, run.angle, run.fit & rises))
            down.append(Samples(run.time, run.signal, run.angle, run.fit & ~rises))
        for name, part in (("rise", up), ("fall", down)):
            if sum(int(run.fit.sum()) for run in part) <= degree + 1:
                raise InputError(f"the readings hardly ever {name}: curves for both branches need a log that goes there and back")
        return cls(_curve(runs, degree), _curve(up, degree), _curve(down, degree), band)

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Any]) -> BranchModel:
        """What `numbers` gave."""
        curve, rising, falling = (Curve.of_numbers(numbers[key]) for key in ("curve", "rising", "falling"))
        return cls(curve, rising, falling, float(numbers["band"]))


class _BranchTracker:
    def __init__(self, model: BranchModel) -> None:
        self._model = model
        self._play = Play(model.band)

    def step(self, time: float, signal: float) -> tuple[float, bool]:
        part = (1 + (signal - self._play.step(signal)) / self._model.band) / 2
        (up, up_out), (down, down_out) = self._model.rising.angle_of(signal), self._model.falling.angle_of(signal)
        return part * up + (1 - part) * down, up_out if part >= 0.5 else down_out


@dataclass(frozen=True, eq=False)
class PlayModel:
    """The inverse curve b, and play operators on it: ``offset + weights . (b, play of b with each radius)``."""

    curve: Curve
    radii: tuple[float, ...]
    offset: float
    weights: tuple[float, ...]
    name: ClassVar[str] = "play"

    def estimate(self, time: FloatArray, signal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """As `Model.estimate`."""
        base, outside = self.curve.angle(signal)
        return self.offset + _played(base, self.radii) @ self.weights, outside

    def tracker(self) -> Tracker:
        """As `Model.tracker`."""
        return _PlayTracker(self)

    def numbers(self) -> dict[str, Any]:
        """As `Model.numbers`."""
        return {"curve": self.curve.numbers(), "radii_deg": list(self.radii), "offset": self.offset, "weights": list(self.weights)}

    @classmethod
    def fit(cls, runs: Sequence[Samples], *, degree: int) -> PlayModel:
        """To the samples of `runs` that count."""
        curve = _curve(runs, degree)
        radii = tuple(part * (curve.high - curve.low) for part in RADII)
        offset, weights = _ridge(runs, lambda run: _played(curve.angle(run.signal)[0], radii))
        return cls(curve, radii, offset, weights)

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Any]) -> PlayModel:
        """What `numbers` gave."""
        radii, weights = (tuple(float(each) for each in numbers[key]) for key in ("radii_deg", "weights"))
        return cls(Curve.of_numbers(numbers["curve"]), radii, float(numbers["offset"]), weights)


class _PlayTracker:
    def __init__(self, model: PlayModel) -> None:
        self._model = model
        self._plays = [Play(radius) for radius in model.radii]

    def step(self, time: float, signal: float) -> tuple[float, bool]:
        base, outside = self._model.curve.angle_of(signal)
        features = [base, *(each.step(base) for each in self._plays)]
        return self._model.offset + sum(w * f for w, f in zip(self._model.weights, features, strict=True)), outside


@dataclass(frozen=True, eq=False)
class LagModel:
    """The inverse curve b, and how it changed: ``offset + weights . (b, change since each lag)``."""

    curve: Curve
    lags: tuple[float, ...]
    offset: float
    weights: tuple[float, ...]
    name: ClassVar[str] = "lag"

    def estimate(self, time: FloatArray, signal: FloatArray) -> tuple[FloatArray, BoolArray]:
        """As `Model.estimate`."""
        base, outside = self.curve.angle(signal)
        return self.offset + _lagged(time, base, self.lags) @ self.weights, outside

    def tracker(self) -> Tracker:
        """As `Model.tracker`."""
        return _LagTracker(self)

    def numbers(self) -> dict[str, Any]:
        """As `Model.numbers`."""
        return {"curve": self.curve.numbers(), "lags_s": list(self.lags), "offset": self.offset, "weights": list(self.weights)}

    @classmethod
    def fit(cls, runs: Sequence[Samples], *, degree: int) -> LagModel:
        """To the samples of `runs` that count."""
        curve = _curve(runs, degree)
        offset, weights = _ridge(runs, lambda run: _lagged(run.time, curve.angle(run.signal)[0], LAGS_S))
        return cls(curve, LAGS_S, offset, weights)

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Any]) -> LagModel:
        """What `numbers` gave."""
        lags, weights = (tuple(float(each) for each in numbers[key]) for key in ("lags_s", "weights"))
        return cls(Curve.of_numbers(numbers["curve"]), lags, float(numbers["offset"]), weights)


@dataclass
class _LagTracker:
    model: LagModel
    times: deque[float] = field(default_factory=deque)
    bases: deque[float] = field(default_factory=deque)

    def step(self, time: float, signal: float) -> tuple[float, bool]:
        base, outside = self.model.curve.angle_of(signal)
        self.times.append(time)
        self.bases.append(base)
        while len(self.times) > 2 and self.times[1] <= time - self.model.lags[-1]:
            self.times.popleft()
            self.bases.popleft()
        features = [base, *(base - self._at(time - lag) for lag in self.model.lags)]
        return self.model.offset + sum(w * f for w, f in zip(self.model.weights, features, strict=True)), outside

    def _at(self, time: float) -> float:
        k = bisect_right(self.times, time)
        if k == 0:
            return self.bases[0]
        if k == len(self.times):
            return self.bases[-1]
        part = (time - self.times[k - 1]) / (self.times[k] - self.times[k - 1])
        return self.bases[k - 1] + part * (self.bases[k] - self.bases[k - 1])


#: By name, the simplest first; lag last, for what it learns of one speed is wrong at another.
MODELS: dict[str, type[CurveModel] | type[BranchModel] | type[LagModel] | type[PlayModel]] = {
    each.name: each for each in (CurveModel, BranchModel, PlayModel, LagModel)
}


def model_of(name: str, numbers: Mapping[str, Any]) -> Model:
    """The model that `Model.numbers` describes."""
    return MODELS[name].of_numbers(numbers)


def _curve(runs: Sequence[Samples], degree: int) -> Curve:
    """The monotone curve of the samples that count, over their own range."""
    angle = np.concatenate([run.angle[run.fit] for run in runs])
    signal = np.concatenate([run.signal[run.fit] for run in runs])
    return fit_curve(angle, signal, degree=degree, monotone=True)


def _played(base: FloatArray, radii: Sequence[float]) -> FloatArray:
    return np.column_stack([base, play(base, radii)])


def _lagged(time: FloatArray, base: FloatArray, lags: Sequence[float]) -> FloatArray:
    return np.column_stack([base, *(base - np.interp(time - lag, time, base) for lag in lags)])


def _ridge(runs: Sequence[Samples], features: Callable[[Samples], FloatArray]) -> tuple[float, tuple[float, ...]]:
    """Offset and weights of the features for the angle."""
    X = np.vstack([features(run)[run.fit] for run in runs])
    y = np.concatenate([run.angle[run.fit] for run in runs])
    middle, scale = X.mean(axis=0), X.std(axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    Z = (X - middle) / scale
    weights = np.linalg.solve(Z.T @ Z + RIDGE * np.eye(Z.shape[1]), Z.T @ (y - y.mean())) / scale
    return float(y.mean() - middle @ weights), tuple(weights.tolist())
