"""The published machine from plain arrays says what scikit-learn's says, on every window."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.histogram_model import fit_histograms
from skinfab.fingertip.nail.protocol import Protocol, session
from skinfab.fingertip.nail.published import columns, fit, histograms

ONE = session("edges12", 1, protocol=Protocol(training=3, rounds=2, estimates=2, samples=128), seed=6)
NAMES = ("none", *(f"edge {k}" for k in range(1, 13)))


@pytest.mark.parametrize("condition", ["AxAyAzGxGyGz", "GxGyGz", "AxAy"])
@pytest.mark.parametrize("classes", [2, 3, 13])
def test_the_same_as_scikit_learn(condition: str, classes: int) -> None:
    rows = classes > ONE.training.classes
    windows, labels = ONE.training.readings[rows, 0], ONE.training.classes[rows]
    asked = ONE.rounds.readings.reshape(-1, 128, 6)
    theirs = fit(histograms(windows)[:, columns(condition)], labels).predict(histograms(asked)[:, columns(condition)])
    ours = fit_histograms(NAMES, labels, windows, rate_hz=1400.0, condition=condition).decide(asked)
    assert ours.tolist() == theirs.tolist() and len(set(theirs.tolist())) > 1


def test_a_missing_reading_is_refused() -> None:
    model = fit_histograms(NAMES, ONE.training.classes, ONE.training.readings[:, 0], rate_hz=1400.0)
    window = ONE.rounds.readings[:1, 0].copy()
    window[0, 3, 2] = np.nan
    with pytest.raises(InputError, match="missing"):
        model.decide(window)
