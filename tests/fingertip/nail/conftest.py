"""Shared fixtures: trials of a simulated participant."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from skinfab.fingertip.nail.improved import label_of
from skinfab.fingertip.nail.labels import Trial
from skinfab.fingertip.nail.protocol import Protocol, Trials, session
from skinfab.fingertip.nail.simulator import RATE_HZ


@pytest.fixture(scope="session")
def trials_of() -> Callable[..., list[Trial]]:
    return _trials_of


@pytest.fixture(scope="session")
def pins() -> list[Trial]:
    return _trials_of("pins6", 1)


def _trials_of(test: str, number: int, *, part: str = "", training: int = 4, samples: int = 256) -> list[Trial]:
    each = session(test, number, protocol=Protocol(training=training, rounds=3, estimates=1, samples=samples), seed=9)

    def made(of: Trials, part: str) -> list[Trial]:
        values = of.readings.reshape(len(of.touches), -1, 6)
        labels = [replace(label_of(t), participant=str(number), trial=f"{part}{k}", part=part) for k, t in enumerate(of.touches)]
        return [Trial(label, v, np.zeros(v.shape, dtype=bool), RATE_HZ) for label, v in zip(labels, values, strict=True)]

    return made(each.training, "train" if part else "") + (made(each.rounds, "test") if part else [])
