"""A calibrated sensor at work: frames in, angles out, one by one, whether they come from a port, a log or a simulator."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from calibration.strain.document import SensorCalibration
from calibration.strain.prepare import CUTOFF_HZ, MAX_GAP_S
from skinfab.errors import InputError
from skinfab.readout.filters import Lowpass
from skinfab.readout.frame import Frame, Stream


@dataclass(frozen=True)
class Reading:
    """What a frame says of the joint.

    Parameters
    ----------
    time : float, s
        The device's.
    signal : float
        The reading as it came; NaN where it is not valid.
    change : float
        dU/U0, filtered; NaN where nothing can be said.
    angle : float, deg
        NaN likewise.
    outside : bool
        Beyond what the sensor was calibrated for: the end of the range was taken.
    fault : str
        Why there is no angle; empty where there is one.
    """

    time: float
    signal: float
    change: float
    angle: float
    outside: bool
    fault: str


class AngleReader:
    """Turns frames into angles: one channel, filtered causally, as a relative change, through the calibration's tracker.

    Parameters
    ----------
    calibration : SensorCalibration
    stream : Stream
    channel : str, optional
        That of the calibration where it is left out.
    rate_hz : float, optional
        That of the stream where it is left out.

    Raises
    ------
    InputError
        There is no such channel, or the frames come too rarely for the filter.

    Examples
    --------
    >>> from calibration.strain.curve import fit_curve
    >>> from calibration.strain.models import CurveModel
    >>> angle = np.linspace(10, 80, 200)
    >>> made = SensorCalibration(CurveModel(fit_curve(angle, 0.002 * angle, degree=1)), "U", "A", 2.0, 10, 80, {}, "", {})
    >>> from skinfab.readout.frame import Channel
    >>> reader = AngleReader(made, Stream("one", (Channel("U"),), 100.0))
    >>> yes, no = np.array([True]), np.array([False])
    >>> round(reader.step(Frame(0.0, 0.0, 0, np.array([2.2]), yes, no)).angle, 6)
    50.0
    """

    def __init__(self, calibration: SensorCalibration, stream: Stream, *, channel: str | None = None, rate_hz: float | None = None) -> None:
        self.calibration = calibration
        self.column = stream.index(channel or calibration.signal)
        self._filter = Lowpass(CUTOFF_HZ, rate_hz or stream.rate_hz)
        self._running = self._filter.causal()
        self._tracker = calibration.model.tracker()
        self._last = -math.inf

    @property
    def delay_s(self) -> float:
        """By how much the filter is late."""
        return self._filter.delay_s

    def step(self, frame: Frame) -> Reading:
        """The joint as this frame has it."""
        time, k = frame.device_time, self.column
        signal = float(frame.values[k]) if frame.valid[k] else math.nan
        fault = self._fault(time, signal, bool(frame.saturated[k]))
        if fault:
            return Reading(time, signal, math.nan, math.nan, False, fault)
        # After a hole the filter begins anew: what it remembers is of another time.
        if time - self._last > max(MAX_GAP_S, 1.5 / self._filter.rate_hz):
            self._running = self._filter.causal()
        self._last = time
        filtered = float(self._running.step(np.array([signal]))[0])
        change = float(self.calibration.relative(np.array(filtered)))
        angle, outside = self._tracker.step(time, change)
        return Reading(time, signal, change, angle, outside, "")

    def _fault(self, time: float, signal: float, saturated: bool) -> str:
        if not math.isfinite(time):
            return "no time"
        if time <= self._last:
            return "not after the one before"
        if not math.isfinite(signal):
            return "not valid"
        return "saturated" if saturated else ""


def frame_rate(stream: Stream, device_time: np.ndarray) -> float:
    """Frames a second: what the stream says, or the median of its steps.

    Raises
    ------
    InputError
        Neither is known.

    Examples
    --------
    >>> frame_rate(Stream("one", ()), np.arange(10) / 50)
    50.0
    """
    if stream.rate_hz:
        return stream.rate_hz
    steps = np.diff(device_time)
    steps = steps[steps > 0]
    if not len(steps):
        raise InputError(f"stream {stream.name} does not say how many frames come a second, and its times do not either; record again")
    return round(1 / float(np.median(steps)), 6)
