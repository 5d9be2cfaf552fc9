"""A sensor whose truth is known: a curve of the angle, behind play."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from calibration.strain.models import Samples
from calibration.strain.play import play

FloatArray = NDArray[np.float64]


@pytest.fixture
def log() -> Callable[..., Samples]:
    """Flexion and extension between 5 and 85 degrees, `cycles` times in `seconds`, read through play of that half-width."""

    def make(
        *,
        cycles: float = 4,
        seconds: float = 32,
        rate: float = 100,
        width: float = 0.0,
        noise: float = 0.0,
        gait: float = 0.0,
        seed: int = 0,
    ) -> Samples:
        rng = np.random.default_rng(seed)
        time = np.arange(round(seconds * rate)) / rate
        # With a gait, faster and slower cycles by that part.
        phase = 2 * np.pi * cycles * time / seconds
        angle = 45 - 40 * np.cos(phase - gait * cycles / 2 * np.sin(2 * phase / cycles))
        felt = play(angle, width) if width else angle
        signal = 2e-3 * felt + 2e-5 * felt**2 + noise * rng.standard_normal(len(time))
        return Samples(time, signal, angle, (angle >= 10) & (angle <= 80))

    return make
