"""The bridge's arithmetic: voltage to resistance and back, exactly; the reading at rest; and relative changes from it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: The reading at rest is the median of this long a window, s.
STILL_S = 0.2
#: The window counts as still where its readings move by no more than this part of the whole log's span.
STILL_PART = 0.05


@dataclass(frozen=True)
class QuarterBridge:
    """A Wheatstone bridge with one sensor in it, as the paper's readout has one for each channel.

    The sensor R and a fixed resistor divide the supply; a second divider gives a fixed part of it; an amplifier takes the
    difference: ``U = offset + gain * supply * (R / (R + series) - reference)``. Nothing is linearised.

    Parameters
    ----------
    supply_v : float, V
    series_kohm : float, kohm
        The fixed resistor in the sensor's half. The bridge is most sensitive where it equals the sensor.
    reference : float
        What part of the supply the other half gives, 0 to 1; 0.5 for two equal resistors.
    gain : float
        Of the amplifier; negative where its inputs are swapped.
    offset_v : float, V
        What it gives for a balanced bridge.
    low_v, high_v : float, V
        What can be read; a voltage at an end of it or beyond is saturated.

    Raises
    ------
    InputError
        A part of it is none.

    Examples
    --------
    >>> bridge = QuarterBridge(3.3, 100.0, reference=0.0)
    >>> float(bridge.voltage(np.array(100.0)))
    1.65
    >>> resistance, saturated = bridge.resistance(np.array([1.65, 3.3]))
    >>> resistance.tolist(), saturated.tolist()
    ([100.0, nan], [False, True])
    """

    supply_v: float
    series_kohm: float
    reference: float = 0.5
    gain: float = 1.0
    offset_v: float = 0.0
    low_v: float = -math.inf
    high_v: float = math.inf

    def __post_init__(self) -> None:
        for name, value in (("supply", self.supply_v), ("series resistor", self.series_kohm)):
            if not (math.isfinite(value) and value > 0):
                raise InputError(f"the bridge's {name} is {value:g}; it must be more than 0")
        if not 0 <= self.reference <= 1:
            raise InputError(f"the bridge's reference is {self.reference:g} of the supply; it must be from 0 to 1")
        if not (math.isfinite(self.gain) and self.gain and math.isfinite(self.offset_v)):
            raise InputError(f"the bridge's gain is {self.gain:g} and its offset {self.offset_v:g} V; the gain must not be 0")
        if not self.low_v < self.high_v:
            raise InputError(f"the bridge is read from {self.low_v:g} to {self.high_v:g} V, which is no range; low must be below high")

    def voltage(self, resistance: FloatArray) -> FloatArray:
        """What sensors of these resistances (kohm) give, V, cut to what can be read. An open sensor is infinite."""
        with np.errstate(invalid="ignore"):
            part = np.where(np.isposinf(resistance), 1.0, resistance / (resistance + self.series_kohm))
        out: FloatArray = np.clip(self.offset_v + self.gain * self.supply_v * (part - self.reference), self.low_v, self.high_v)
        return out

    def resistance(self, voltage: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Resistances (kohm) of voltages, and which are saturated: at an end of what can be read, or of a sensor shorted or open.

        A saturated one has no resistance: NaN.
        """
        part = (voltage - self.offset_v) / (self.gain * self.supply_v) + self.reference
        with np.errstate(invalid="ignore", divide="ignore"):
            saturated = (voltage <= self.low_v) | (voltage >= self.high_v) | (part <= 0) | (part >= 1)
            out = np.where(saturated, np.nan, self.series_kohm * part / (1 - part))
        return out, np.asarray(saturated, dtype=bool)


def relative(readings: FloatArray, at_rest: FloatArray | float) -> FloatArray:
    """dU/U0 or dR/R0: the change from the reading at rest, as a part of that.

    Examples
    --------
    >>> relative(np.array([2.0, 2.5]), 2.0).tolist()
    [0.0, 0.25]
    """
    return (readings - at_rest) / at_rest


@dataclass(frozen=True)
class Rest:
    """The reading at rest.

    Parameters
    ----------
    level : float
        U0 or R0, in the readings' unit.
    at_s : float, s
        Where its window begins.
    moved : float
        By what part of the whole span the readings move in it.
    """

    level: float
    at_s: float
    moved: float

    @property
    def still(self) -> bool:
        """Did the readings rest there?"""
        return self.moved <= STILL_PART


def at_rest(readings: FloatArray, rate_hz: float, *, span: float | None = None) -> Rest:
    """The median of the first still window; of the stillest one where there is none.

    Parameters
    ----------
    readings : (n,) float
        At even times, filtered; what is not finite is passed over, and a window with nothing else never counts.
    rate_hz : float
    span : float, optional
        By how much the readings move in the whole log, where these are but a part of it.

    Raises
    ------
    InputError
        There is no window without a gap.

    Examples
    --------
    >>> readings = np.concatenate([np.full(50, 2.0), np.linspace(2, 3, 100)])
    >>> at_rest(readings, 100.0)
    Rest(level=2.0, at_s=0.0, moved=0.0)
    """
    n = min(max(round(STILL_S * rate_hz), 1), len(readings))
    whole = np.isfinite(readings)
    if n < 1 or not whole.any():
        raise InputError("there are no readings, so that the reading at rest is not known; record some")
    if span is None:
        span = float(np.ptp(readings[whole]))
    windows = np.lib.stride_tricks.sliding_window_view(readings, n)
    moves = np.ptp(windows, axis=1)
    moves[~np.isfinite(moves)] = np.inf
    still = np.flatnonzero(moves <= STILL_PART * span)
    best = int(still[0]) if len(still) else int(np.argmin(moves))
    if not np.isfinite(moves[best]):
        raise InputError(f"no {STILL_S:g} s of the readings are without a gap, so that the reading at rest is not known; record again")
    return Rest(float(np.median(windows[best])), best / rate_hz, float(moves[best] / span) if span else 0.0)
