"""The play operator: what follows a signal only once its slack is used up, as a hysteretic sensor does.

The elementary operator of Prandtl's and Ishlinskii's model: z stays where it is while the signal moves within a band of
half-width r about it, and is dragged along by the band's edge beyond that.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def play(signal: ArrayLike, radius: ArrayLike) -> FloatArray:
    """Run the operator along a signal; it starts without slack used, at the signal's first value.

    Parameters
    ----------
    signal : (n,) float
    radius : float or (k,) float
        Half-width of the band, of the signal's unit.

    Returns
    -------
    (n,) or (n, k) float

    Examples
    --------
    >>> play([0.0, 1.0, 3.0, 2.0, 0.0], 1.0).tolist()
    [0.0, 0.0, 2.0, 2.0, 1.0]
    """
    u = np.ascontiguousarray(signal, dtype=float)
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    out: FloatArray = _play(u, r)
    return out if np.ndim(radius) else out[:, 0]


class Play:
    """The same, one sample at a time.

    Examples
    --------
    >>> follow = Play(1.0)
    >>> [follow.step(u) for u in (0.0, 1.0, 3.0, 2.0, 0.0)]
    [0.0, 0.0, 2.0, 2.0, 1.0]
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        self._z: float | None = None

    def step(self, u: float) -> float:
        """Follow the next value."""
        z = u if self._z is None else max(u - self.radius, min(u + self.radius, self._z))
        self._z = z
        return z


@njit(cache=True)
def _play(u: Any, r: Any) -> Any:
    out = np.empty((len(u), len(r)))
    for j in range(len(r)):
        z = u[0] if len(u) else 0.0
        for i in range(len(u)):
            z = max(u[i] - r[j], min(u[i] + r[j], z))
            out[i, j] = z
    return out
