"""How much of a reading a curve of the angle leaves unexplained, at every lag between them at once.

The sums of a least-squares problem, one for each lag, are correlations of the angle's powers with the reading: they come
from FFTs. The angle may stand behind slack, and of either side any samples may be missing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.strain.play import play

FloatArray = NDArray[np.float64]

#: Times are taken in steps of this, s, and the lag between them from a parabola; readings hold nothing above 5 Hz.
STEP_S = 0.01
#: Degree of the curve: the paper needed 3 and 4.
DEGREE = 4
#: A grain of ridge: behind wide slack, or in a short overlap, high powers may be alike.
_RIDGE = 1e-11


@dataclass(frozen=True, eq=False)
class Pair:
    """A joint's angle and a sensor's reading, each by its own clock, at even times `STEP_S` apart.

    Parameters
    ----------
    angle_from, reading_from : float, s
        When the first of each was taken.
    angle : (n,) float, deg
    reading : (m,) float
    angle_known, reading_counts : (n,), (m,) bool
        Which ones are used; the others are there only for the angle's past.
    """

    angle_from: float
    angle: FloatArray
    angle_known: NDArray[np.bool_]
    reading_from: float
    reading: FloatArray
    reading_counts: NDArray[np.bool_]

    @property
    def offset(self) -> int:
        """When readings begin after angles, in steps."""
        return round((self.reading_from - self.angle_from) / STEP_S)


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums of a least-squares problem at each lag: of the powers' products, with the reading, and the reading's square."""

    A: FloatArray
    b: FloatArray
    c: FloatArray

    @classmethod
    def of(cls, pair: Pair, X: FloatArray, grid: NDArray[np.int64]) -> Sums:
        """Of a pair, at lags that are whole numbers of steps."""
        from scipy.fft import irfft, next_fast_len, rfft

        w, y = pair.reading_counts.astype(float), np.where(pair.reading_counts, pair.reading, 0.0)
        size = next_fast_len(len(X) + len(w), real=True)
        p = X.shape[1]
        rows, columns = np.triu_indices(p)
        steps = grid - pair.offset
        at = steps % size
        inside = (steps > -len(X)) & (steps < len(w))

        def against(values: FloatArray, columns_of: FloatArray) -> FloatArray:
            found = irfft(rfft(values, size)[:, None] * np.conj(rfft(columns_of, size, axis=0)), size, axis=0)
            out: FloatArray = np.where(inside[:, None], found[at], 0.0)
            return out

        A = np.empty((len(grid), p, p))
        A[:, rows, columns] = A[:, columns, rows] = against(w, X[:, rows] * X[:, columns])
        return cls(A, against(y, X), against(y * y, X[:, :1])[:, 0])

    @property
    def n(self) -> FloatArray:
        """How many samples each lag has in common."""
        n: FloatArray = self.A[:, 0, 0]
        return n

    def curves(self) -> FloatArray:
        """The curve that fits best at each lag, as its weights of the powers."""
        scale = np.maximum(np.trace(self.A, axis1=1, axis2=2), 1.0)
        A = self.A + (_RIDGE * scale)[:, None, None] * np.eye(self.A.shape[1])
        return np.asarray(np.linalg.solve(A, self.b[..., None])[..., 0], dtype=np.float64)

    def unexplained(self) -> FloatArray:
        """What it leaves, as part of the reading's variance; infinite where nothing is in common."""
        left = np.maximum(self.c - np.einsum("ki,ki->k", self.b, self.curves()), 0.0)
        n = np.maximum(self.n, 1.0)
        about_mean = self.c - self.b[:, 0] ** 2 / n
        tiny = 1e-12 * np.maximum(self.c.max(), 1e-300)
        part: FloatArray = np.where(about_mean > tiny, left / np.maximum(about_mean, tiny), np.inf)
        return part


def total(parts: Sequence[Sums]) -> Sums:
    """Of all the parts."""
    return Sums(sum(each.A for each in parts), sum(each.b for each in parts), sum(each.c for each in parts))  # type: ignore[arg-type]


def powers_of(pair: Pair, width: float, low: float, high: float) -> FloatArray:
    """Chebyshev polynomials of the angle behind play, 0 where it is not known: until the slack was once used up, it is not."""
    used_up = np.maximum.accumulate(pair.angle) - np.minimum.accumulate(pair.angle) >= 2 * width
    x = np.clip((2 * play(pair.angle, width) - low - high) / (high - low), -1.0, 1.0)
    return np.asarray(np.polynomial.chebyshev.chebvander(x, DEGREE) * (pair.angle_known & used_up)[:, None], dtype=np.float64)


def least(unexplained: FloatArray) -> FloatArray:
    """The least over the half-widths (first axis), by a parabola through the best one and its neighbours: slack is of any width."""
    if len(unexplained) < 3:
        fewest: FloatArray = unexplained.min(axis=0)
        return fewest
    k = np.clip(np.argmin(unexplained, axis=0), 1, len(unexplained) - 2)
    left, middle, right = (np.take_along_axis(unexplained, (k + step)[None], axis=0)[0] for step in (-1, 0, 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        bend = left - 2 * middle + right
        lowest = middle - (left - right) ** 2 / (8 * bend)
        inner = np.isfinite(bend) & (bend > 0) & (np.abs(left - right) <= 2 * bend)  # else the least lies at an end
    tried = unexplained.min(axis=0)
    out: FloatArray = np.where(inner, np.clip(lowest, 0.0, tried), tried)
    return out


def bottom(profile: FloatArray, k: int) -> float:
    """How little a parabola through a place and its neighbours gets to."""
    part = between(profile, k)
    return float(profile[k]) + (part * float(profile[k + 1] - profile[k - 1]) / 4 if part else 0.0)


def between(profile: FloatArray, k: int) -> float:
    """Where a parabola through a place and its neighbours is least, in steps from that place."""
    if not 0 < k < len(profile) - 1:
        return 0.0
    left, middle, right = profile[k - 1 : k + 2].tolist()
    bend = left - 2 * middle + right
    return float(np.clip((left - right) / (2 * bend), -0.5, 0.5)) if bend > 0 else 0.0
