"""The characteristic curve of a strain sensor: its relative change over the joint's angle, and the way back.

A polynomial over a range of angles, held by its Bernstein ordinates: where these rise (or fall) throughout, so does the
curve, and it can be inverted. A plain fit need not do so (a cubic through real logs turns for 9 subjects of 14): such a
curve has two angles for one reading. It is then fitted once more under that condition, which is a least-squares problem
with steps that are not negative.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls
from scipy.special import comb

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: Places at which a curve is tabulated for the way back: straight lines between them are off by 1e-6 of the range or so.
_TABLE = 1001

#: A slope below this part of the mean one counts as none.
_FLAT = 1e-3


@dataclass(frozen=True, eq=False)
class Curve:
    """Relative change of a signal, dU/U0, as a polynomial of the angle.

    Parameters
    ----------
    low, high : float, deg
        The range it was fitted over; nothing is said beyond it.
    ordinates : (degree + 1,) float
        Of its Bernstein form over that range: its first and last one are its values at the ends.

    Examples
    --------
    >>> curve = Curve(10.0, 80.0, np.array([0.0, 0.1, 0.4]))
    >>> curve.degree, curve.signal([10.0, 80.0]).tolist(), curve.monotone
    (2, [0.0, 0.4], True)
    >>> angle, outside = curve.angle([0.15, 0.5])
    >>> angle.round(3).tolist(), outside.tolist()
    ([45.0, 80.0], [False, True])
    """

    low: float
    high: float
    ordinates: FloatArray

    @property
    def degree(self) -> int:
        """Of the polynomial."""
        return len(self.ordinates) - 1

    @property
    def rising(self) -> bool:
        """Does the signal grow with the angle?"""
        return bool(self.ordinates[-1] >= self.ordinates[0])

    def signal(self, angle: ArrayLike) -> FloatArray:
        """dU/U0 at angles (deg)."""
        return bernstein(self._part(angle), self.degree) @ self.ordinates

    def slope(self, angle: ArrayLike) -> FloatArray:
        """Its derivative at angles (deg), 1/deg: the angular sensitivity."""
        steps = np.diff(self.ordinates) * self.degree / (self.high - self.low)
        return bernstein(self._part(angle), self.degree - 1) @ steps

    @cached_property
    def monotone(self) -> bool:
        """Does it rise, or fall, throughout its range?"""
        low, high = self.monotone_range
        return low == self.low and high == self.high

    @cached_property
    def monotone_range(self) -> tuple[float, float]:
        """The longest range of angles, deg, over which it rises throughout or falls throughout."""
        at = np.linspace(self.low, self.high, _TABLE)
        slope = self.slope(at)
        size = abs(float(self.ordinates[-1] - self.ordinates[0])) / (self.high - self.low)
        sign = np.where(slope > -_FLAT * size, 1, -1) if self.rising else np.where(slope < _FLAT * size, 1, -1)
        edges = np.flatnonzero(np.diff(sign)) + 1
        runs = [run for run in np.split(np.arange(_TABLE), edges) if len(run) > 1]
        best = max(runs, key=lambda run: len(run))
        return float(at[best[0]]), float(at[best[-1]])

    def angle(self, signal: ArrayLike) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Angles (deg) of readings, and which of these lie outside the curve's own values: they give the end of the range.

        Raises
        ------
        InputError
            The curve turns, so that a reading can have two angles.
        """
        u = np.asarray(signal, dtype=float)
        readings, angles = self._table
        return np.interp(u, readings, angles), (u < readings[0]) | (u > readings[-1])

    def angle_of(self, reading: float) -> tuple[float, bool]:
        """The same of one reading: a tenth of the time.

        Raises
        ------
        InputError
            As `angle`.

        Examples
        --------
        >>> curve = Curve(10.0, 80.0, np.array([0.0, 0.1, 0.4]))
        >>> curve.angle_of(0.5), curve.angle_of(0.0), round(curve.angle_of(0.15)[0], 3)
        ((80.0, True), (10.0, False), 45.0)
        """
        readings, angles = self._steps
        k = bisect_right(readings, reading) - 1
        if k < 0:
            return angles[0], True
        if k == len(readings) - 1:
            # No number is not less than any either.
            return angles[-1] if reading >= readings[-1] else math.nan, reading > readings[-1]
        slope = (angles[k + 1] - angles[k]) / (readings[k + 1] - readings[k])
        return slope * (reading - readings[k]) + angles[k], False

    @property
    def coefficients(self) -> FloatArray:
        """Of the powers of the angle in degrees, lowest first."""
        x = np.polynomial.Polynomial([0.0], domain=[self.low, self.high], window=[0.0, 1.0])
        n = self.degree
        one = np.polynomial.Polynomial([0.0, 1.0])
        for k, value in enumerate(self.ordinates.tolist()):
            term = comb(n, k) * value * one**k * (1 - one) ** (n - k)
            x = x + np.polynomial.Polynomial(term.coef, domain=[self.low, self.high], window=[0.0, 1.0])
        power = x.convert(domain=[-1.0, 1.0], window=[-1.0, 1.0]).coef
        out: FloatArray = np.zeros(n + 1)
        out[: len(power)] = power
        return out

    def numbers(self) -> dict[str, Any]:
        """All that it consists of, for a file."""
        return {"low_deg": self.low, "high_deg": self.high, "bernstein": self.ordinates.tolist()}

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Any]) -> Curve:
        """What `numbers` gave.

        Raises
        ------
        InputError
            They are no curve.
        """
        low, high = float(numbers["low_deg"]), float(numbers["high_deg"])
        ordinates = np.array(numbers["bernstein"], dtype=float)
        if not (low < high and ordinates.ndim == 1 and len(ordinates) > 1 and np.isfinite([low, high, *ordinates]).all()):
            raise InputError(f"a curve from {low:g} to {high:g} degrees with ordinates {ordinates.tolist()} is none")
        return cls(low, high, ordinates)

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        """Readings, rising, and their angles, where there is one angle to each."""
        if not self.monotone:
            low, high = self.monotone_range
            raise InputError(
                f"the curve of degree {self.degree} turns within {self.low:g} to {self.high:g} degrees, so that a reading has two angles; "
                f"fit it monotone, or over {low:.0f} to {high:.0f} degrees"
            )
        angles = np.linspace(self.low, self.high, _TABLE)
        readings = self.signal(angles)
        if not self.rising:
            angles, readings = angles[::-1], readings[::-1]
        return np.maximum.accumulate(readings), angles

    @cached_property
    def _steps(self) -> tuple[list[float], list[float]]:
        """The same as floats."""
        readings, angles = self._table
        return readings.tolist(), angles.tolist()

    def _part(self, angle: ArrayLike) -> FloatArray:
        part: FloatArray = (np.asarray(angle, dtype=float) - self.low) / (self.high - self.low)
        return part


def bernstein(x: FloatArray, degree: int) -> FloatArray:
    """The Bernstein polynomials of a degree at x (...), (..., degree + 1)."""
    x = np.asarray(x, dtype=float)
    # Products in turn: a power of a float takes ten times as long, and fits do little else.
    up, down = np.ones((*x.shape, degree + 1)), np.ones((*x.shape, degree + 1))
    for k in range(1, degree + 1):
        up[..., k] = up[..., k - 1] * x
        down[..., degree - k] = down[..., degree - k + 1] * (1 - x)
    out: FloatArray = comb(degree, np.arange(degree + 1)) * up * down
    return out


def fit_curve(angle: FloatArray, signal: FloatArray, *, degree: int, monotone: bool = False) -> Curve:
    """Least squares, over the range of the angles given.

    Parameters
    ----------
    angle : (n,) float, deg
    signal : (n,) float
        dU/U0.
    degree : int, >= 1
    monotone : bool
        The best curve that rises throughout, or falls, whichever fits better.

    Raises
    ------
    InputError
        Too few samples, or all at one angle.

    Examples
    --------
    >>> angle = np.linspace(10, 80, 50)
    >>> fit_curve(angle, 0.001 * angle, degree=1).coefficients.round(6).tolist()
    [0.0, 0.001]
    """
    if len(angle) <= degree + 1 or np.ptp(angle) <= 0:
        raise InputError(
            f"{len(angle)} samples over {np.ptp(angle) if len(angle) else 0:g} degrees: a curve of degree {degree} needs {degree + 2} or "
            "more, at different angles; give another range of angles or a longer log"
        )
    low, high = float(angle.min()), float(angle.max())
    basis = bernstein((angle - low) / (high - low), degree)
    plain = Curve(low, high, np.asarray(np.linalg.lstsq(basis, signal, rcond=None)[0], dtype=np.float64))
    if not monotone or plain.monotone:
        return plain
    both = [_monotone(basis, signal, sign) for sign in (1.0, -1.0)]
    return Curve(low, high, min(both, key=lambda fit: fit[1])[0])


def _monotone(basis: FloatArray, signal: FloatArray, sign: float) -> tuple[FloatArray, float]:
    """Ordinates whose steps all have this sign, and the residual's norm."""
    # The ordinates are a start of either sign and steps that are not negative.
    steps = np.cumsum(basis[:, ::-1], axis=1)[:, ::-1] * sign
    found, residual = nnls(np.column_stack([steps, -steps[:, 0]]), signal)
    found[0] -= found[-1]
    return sign * np.cumsum(found[:-1]), float(residual)
