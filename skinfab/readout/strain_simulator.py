"""Strain channels of a skin on a joint that bends and stretches: enough to try a readout with, and no more.

Each channel is a Wheatstone bridge's voltage that follows the joint's angle in proportion, with white noise, on a range of
its own. Left out is all that a real sensor adds: curvature of the characteristic, hysteresis, drift, cross-talk. For these
there is `calibration.finger.simulated`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np

from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.paced import PacedFrames

#: The seed's readout: two boards of 16 inputs at 100 Hz.
CHANNELS, RATE_HZ = 32, 100.0
_BOARD_INPUTS = 16
_SUPPLY_V = 3.3
_REST_V, _SWING_V, _NOISE_V = 1.2, 0.4, 0.002
_PERIOD_S = 8.0  # the seed's uniform cycles


def strain_stream(*, channels: int = CHANNELS, rate_hz: float = RATE_HZ) -> Stream:
    """What the simulator sends.

    Examples
    --------
    >>> stream = strain_stream(channels=17)
    >>> stream.simulated, stream.channels[16].name, stream.channels[16].board, stream.channels[16].board_input
    (True, 'S17', 2, 0)
    """
    each = (Channel(f"S{k + 1}", "V", "strain", 0.0, _SUPPLY_V, "", 1 + k // _BOARD_INPUTS, k % _BOARD_INPUTS) for k in range(channels))
    return Stream("simulated strain channels", tuple(each), rate_hz, simulated=True)


def strain_frames(stream: Stream, *, seed: int = 0) -> Iterator[Frame]:
    """Frames without end; the channels follow one joint, each with a swing of its own and a little behind the one before."""
    rng = np.random.default_rng(seed)
    n = len(stream.channels)
    swing = _SWING_V * (0.5 + np.arange(1, n + 1) / n)
    phase = np.arange(n) / n
    for k in itertools.count():
        time = k / stream.rate_hz
        bent = 0.5 - 0.5 * np.cos(2 * math.pi * time / _PERIOD_S - phase)
        values = _REST_V + swing * bent + rng.normal(0.0, _NOISE_V, n)
        yield Frame(time, time, k, values, np.ones(n, dtype=bool), stream.saturated(values))


def simulated_strain(*, channels: int = CHANNELS, rate_hz: float = RATE_HZ, seed: int = 0, in_time: bool = True) -> PacedFrames:
    """The simulator as a source.

    Examples
    --------
    >>> with simulated_strain(channels=2, in_time=False) as source:
    ...     frame = source.read()
    >>> frame.values.shape, source.stream.simulated
    ((2,), True)
    """
    stream = strain_stream(channels=channels, rate_hz=rate_hz)
    return PacedFrames(stream, lambda: strain_frames(stream, seed=seed), in_time=in_time)
