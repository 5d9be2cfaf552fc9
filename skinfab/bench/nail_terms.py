"""What each part of the improved method is for: the same trials decided without it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.nail.classify import LEAST_SHRINKAGE, NailModel
from skinfab.fingertip.nail.improved import asked, frequency, learn
from skinfab.fingertip.nail.protocol import Protocol, Session, sessions
from skinfab.fingertip.nail.simulator import Scene
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]

#: Readings of the short windows.
SHORT = 8
#: And of how much more noise they are asked, as a cheaper sensor has it.
_NOISIER = 5.0
ALL = "nothing"


class _OneChannel(NailModel):
    """Phases counted from one channel instead of all that there are."""

    @property
    def reference(self) -> NDArray[np.complex128]:
        """Gx alone."""
        return np.array([0, 0, 0, 1, 0, 0], dtype=complex)


class _Amplitudes(NailModel):
    """Amplitudes without their phases."""

    def features(self, drive: NDArray[np.complex128]) -> FloatArray:
        """Absolute values, twice, so that there are as many."""
        size = np.abs(drive[:, self.channels]) / self.size
        return np.concatenate([size, size], axis=1)


def _as(kind: type[NailModel]) -> Callable[[NailModel], NailModel]:
    return lambda model: kind(**{name: getattr(model, name) for name in model.__dataclass_fields__})


#: What is left out, and the model without it.
TERMS: Mapping[str, Callable[[NailModel], NailModel]] = {
    ALL: lambda model: model,
    "phases": _as(_Amplitudes),
    "turning by all channels (Gx alone)": _as(_OneChannel),
    "drawing the scatter to its mean": lambda model: replace(model, shrinkage=LEAST_SHRINKAGE),
    "noise of the window": lambda model: replace(model, noise=np.zeros(6)),
    "temperature": lambda model: replace(model, temperature=1.0),
}


@dataclass(frozen=True)
class Left:
    """The method without one of its parts.

    Parameters
    ----------
    term : str
        What is left out.
    test : str
    percent_long, percent_short, percent_noisy : float
        Right on all of a trial's readings, on 8 of them, and on 8 of a sensor with five times the noise.
    too_sure : float
        Mean confidence less the part that is right, in percent, on all of a trial's readings.
    simulated : bool
    """

    term: str
    test: str
    percent_long: float
    percent_short: float
    percent_noisy: float
    too_sure: float
    simulated: bool = True


def leave_out(
    protocol: Protocol, *, tests: tuple[str, ...] = ("edges4", "edges12"), seed: int = 1, progress: Progress = silent
) -> list[Left]:
    """A row for each part and test; one estimate a trial."""
    short = replace(protocol, estimates=1)
    rows = []
    for j, test in enumerate(tests):
        got: dict[str, list[FloatArray]] = {}
        noisy = replace(Scene(), noise_g=_NOISIER * Scene.noise_g, noise_dps=_NOISIER * Scene.noise_dps)
        both = zip(sessions(test, protocol=short, seed=seed), sessions(test, protocol=short, scene=noisy, seed=seed), strict=True)
        for k, (each, noised) in enumerate(both):
            progress((j + k / protocol.participants) / len(tests), f"{test}: parts left out, participant {k + 1}")
            for term, without in TERMS.items():
                right = [_right(of, without, samples) for of, samples in ((each, None), (each, SHORT), (noised, SHORT))]
                got.setdefault(term, []).append(np.column_stack([*(of for of, _ in right), right[0][1]]))
        for term, of in got.items():
            long, few, few_noisy, sure = (100 * np.concatenate(of).mean(axis=0)).tolist()
            rows.append(Left(term, test, long, few, few_noisy, sure - long))
    return rows


def _right(each: Session, without: Callable[[NailModel], NailModel], samples: int | None) -> tuple[NDArray[np.bool_], FloatArray]:
    """Which trials are right without a part, and how confident it was."""
    model, windows = learn(each), asked(each, samples)
    found = without(model).decide(windows, drive_hz=frequency(windows, model))
    return found.classes == each.rounds.classes, found.confidence
