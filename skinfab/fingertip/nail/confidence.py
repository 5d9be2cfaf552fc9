"""How sure a decision is: squared distances from the classes as probabilities, and the factor on them that held-out trials ask for.

Few trials make any model too sure, so distances are divided by a temperature. It is chosen on trials that were held out, by Brier's
score (Brier 1950): the likelihood would let the one trial in a hundred that lies far off set it for all the others (simulated, confidence
came out 8 to 10 points too low). That one trial is the lapse's: some probability is left for every class, however far off.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Part of the trials that are not what distances say: scatter has longer tails than the normal distribution's.
LAPSE = 0.01
#: Temperatures that are tried; below 1 where the scatter was drawn to its mean so far that it is too wide.
_TEMPERATURES = np.geomspace(0.7, 12.0, 25)
#: Where nothing can be held out.
UNKNOWN = float(_TEMPERATURES[-1])


def probabilities(squared: FloatArray, temperature: float) -> FloatArray:
    """Of k classes at squared distances (n, k), (n, k).

    Examples
    --------
    >>> probabilities(np.array([[0.0, 2.0, 90.0]]), 1.0).round(4).tolist()
    [[0.7271, 0.2696, 0.0033]]
    """
    weight = np.exp((squared.min(axis=1, keepdims=True) - squared) / (2 * temperature))
    out: FloatArray = (1 - LAPSE) * weight / weight.sum(axis=1, keepdims=True) + LAPSE / squared.shape[1]
    return out


def temperature_of(squared: FloatArray, column: IntArray) -> float:
    """The temperature that trials ask for which were held out.

    The mean of all that are tried, each by exp(-Brier's score summed over the trials): the single best one would jump about among
    trials as few as these.

    Parameters
    ----------
    squared : (n, k) float
        Squared distances from each class.
    column : (n,) int
        Which class each trial is of.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> means, column = 2.0 * np.eye(4), rng.integers(4, size=400)
    >>> x = means[column] + 1.5 * rng.standard_normal((400, 4))
    >>> squared = ((x[:, None] - means) ** 2).sum(axis=2)  # by a scatter of 1, where it is 1.5: 2.25 is right
    >>> bool(abs(temperature_of(squared, column) - 2.25) < 0.3)
    True
    """
    true = np.eye(squared.shape[1])[column]
    score = np.array([((probabilities(squared, float(t)) - true) ** 2).sum() for t in _TEMPERATURES])
    weight = np.exp(score.min() - score)
    return float(np.exp(weight @ np.log(_TEMPERATURES) / weight.sum()))
