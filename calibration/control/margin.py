"""How much gain the loop takes: from delay, lag and slack to the critical gain, and how far from it one is.

The loop is an integrator (a command is a speed), a lag and a delay; L(s) = k exp(-s T) / (s (1 + s tau)), with k the gain in
1/s: speed asked for per degree of error, times the slope by which a sensor's curve is steeper than the controller takes it to be.
Its phase is -180 degrees at w T + atan(w tau) = 90 degrees, and the critical k is w sqrt(1 + (w tau)^2) there. A command
that is held between samples is half a period late.

Slack turns the phase further. By its describing function N(x), x the amplitude in half-widths of the slack, the loop keeps
swinging where L(iw) = -1 / N(x), and the least such k is the critical gain with slack. It does not depend on how wide the
slack is: a wider one swings wider. The describing function knows the first harmonic alone and promises too much, in
simulations 8 to 17 %, hence `OPTIMISM`. Below, the joint comes to rest, but the nearer to the limit the later: at nine tenths
of it after minutes. What is sure follows from the circle criterion: slack passes a motion's speed with a factor of 0 or 1, and
where Re L(iw) > -1 throughout, which is k < 1 / (T + tau), every such loop settles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calibration.control.controller import Input, Law
from calibration.control.laws import mean_slope
from calibration.strain.models import BranchModel
from skinfab.errors import InputError, RefusedError

FloatArray = NDArray[np.float64]

#: ``--gain auto`` is the critical gain over this (9.5 dB): what is usual between 6 and 12 dB.
AUTO = 3.0
#: What of the critical gain by the describing function is counted on.
OPTIMISM = 0.82
#: Amplitudes, in half-widths of the slack, at which the describing function is looked at: below, nothing comes through.
_AMPLITUDES = 1 + np.geomspace(1e-3, 1e3, 4001)
#: Places at which a curve's slope is looked at.
_PLACES = 201


@dataclass(frozen=True)
class Critical:
    """The loop at its limit.

    Parameters
    ----------
    gain : float, 1/s
        Above it the loop swings for ever.
    frequency_hz : float
        How it swings.
    amplitude : float
        In half-widths of the slack; infinite where there is none, and the swing grows without bound.
    """

    gain: float
    frequency_hz: float
    amplitude: float


def critical_gain(*, lag_s: float, delay_s: float, period_s: float = 0.0, play: bool = False) -> Critical:
    """The critical gain of a loop.

    Parameters
    ----------
    lag_s, delay_s : float
        Of the joint's speed, and of all that lies between motion and command.
    period_s : float
        Between commands.
    play : bool
        Has the sensor slack?

    Raises
    ------
    InputError
        A time is negative, or there is no delay at all and hence no limit.

    Examples
    --------
    >>> [round(critical_gain(lag_s=0.1, delay_s=T).gain, 1) for T in (0.03, 0.05, 0.1, 0.2)]
    [34.9, 21.5, 11.3, 6.1]
    >>> [round(critical_gain(lag_s=0.1, delay_s=T, period_s=0.01, play=True).gain, 1) for T in (0.03, 0.05, 0.1, 0.2)]
    [15.3, 12.0, 7.7, 4.6]
    """
    late = delay_s + period_s / 2
    if not (math.isfinite(lag_s + late) and min(lag_s, delay_s, period_s) >= 0 and late > 0):
        raise InputError(
            f"lag {lag_s:g} s, delay {delay_s:g} s, period {period_s:g} s: none may be negative, and without any delay every gain is stable"
        )
    if not play:
        turn = float(_crossing(np.array([math.pi]), lag_s, late)[0])
        return Critical(turn * math.hypot(1, turn * lag_s), turn / (2 * math.pi), math.inf)
    N = play_describing_function(_AMPLITUDES)
    # L has the phase of -1 / N at w, and its size at k: of all such k the least counts.
    w = _crossing(math.pi + np.angle(N), lag_s, late)
    k = w * np.hypot(1, w * lag_s) / np.abs(N)
    best = int(np.argmin(k))
    return Critical(OPTIMISM * float(k[best]), float(w[best]) / (2 * math.pi), float(_AMPLITUDES[best]))


def play_describing_function(amplitude: FloatArray) -> NDArray[np.complex128]:
    """First harmonic of play, out over in, for a sine of so many half-widths (Gelb and Vander Velde, 1968, App. B).

    Examples
    --------
    >>> play_describing_function(np.array([1e9])).round(6).tolist()
    [(1-0j)]
    """
    q = 1 - 2 / amplitude
    real = 0.5 + (np.arcsin(q) + q * np.sqrt(1 - q * q)) / math.pi
    out: NDArray[np.complex128] = real - 1j * (1 - q * q) / math.pi
    return out


def _crossing(lag: FloatArray, lag_s: float, late: float) -> FloatArray:
    """Frequencies, rad/s, at which the loop's phase is behind by so much (rad, more than a quarter turn); by bisection."""
    beyond = lag - math.pi / 2
    low, high = np.zeros_like(beyond), beyond / late
    for _ in range(80):
        middle = (low + high) / 2
        behind = middle * late + np.arctan(middle * lag_s) < beyond
        low, high = np.where(behind, middle, low), np.where(behind, high, middle)
    out: FloatArray = (low + high) / 2
    return out


@dataclass(frozen=True)
class Margin:
    """A gain beside the limits.

    Parameters
    ----------
    gain : float, 1/s
        Of the controller.
    steepness : float
        By how much more the loop's gain is where the sensor is steepest.
    linear, with_play : Critical
        Without and with slack in the sensor.
    sure : float, 1/s
        Below it the loop settles whatever the slack does.
    """

    gain: float
    steepness: float
    linear: Critical
    with_play: Critical
    sure: float

    @property
    def loop_gain(self) -> float:
        """Where the sensor is steepest, 1/s."""
        return self.gain * self.steepness

    @property
    def ratio(self) -> float:
        """How many times the gain could be raised before the loop swings: the gain margin."""
        return self.with_play.gain / self.loop_gain

    @property
    def sentence(self) -> str:
        """For people."""
        swing = self.with_play
        return (
            f"gain {self.gain:.3g} 1/s, at the steepest {self.loop_gain:.3g}; sure to settle below {self.sure:.3g}, swings from "
            f"{swing.gain:.3g} 1/s on at {swing.frequency_hz:.2g} Hz (without slack in the sensor: {self.linear.gain:.3g}): gain margin "
            f"{self.ratio:.2f} ({20 * math.log10(self.ratio):.1f} dB)"
        )


def steepness(robot: Input, law: Law) -> float:
    """By how much more a law that works on readings (``p``) moves where the robot's sensor is steepest; 1 for angles."""
    if law != "p":
        return 1.0
    model = robot.calibration.model
    curves = (model.curve, model.rising, model.falling) if isinstance(model, BranchModel) else (model.curve,)
    steepest = max(float(abs(curve.slope(np.linspace(curve.low, curve.high, _PLACES))).max()) for curve in curves)
    return steepest / abs(mean_slope(model.curve))


def judged(robot: Input, law: Law, gain: float | None, *, lag_s: float, delay_s: float, period_s: float, force: bool = False) -> Margin:
    """The margin of a gain, which must be one; without a gain, that of a third of the critical one.

    Raises
    ------
    RefusedError
        The gain lies beyond the critical one, and nobody forced it.
    """
    linear = critical_gain(lag_s=lag_s, delay_s=delay_s, period_s=period_s)
    with_play = critical_gain(lag_s=lag_s, delay_s=delay_s, period_s=period_s, play=True)
    times = steepness(robot, law)
    sure = 1 / (delay_s + period_s / 2 + lag_s)
    margin = Margin(with_play.gain / times / AUTO if gain is None else gain, times, linear, with_play, sure)
    if margin.ratio <= 1 and not force:
        raise RefusedError(
            f"a gain of {margin.gain:.3g} 1/s is beyond what the loop takes: it is {margin.loop_gain:.3g} where the sensor is steepest, "
            f"and from {with_play.gain:.3g} 1/s on the joint swings for ever; give less than {with_play.gain / times:.3g}, or --force"
        )
    return margin
