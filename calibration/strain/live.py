"""What is reckoned from each frame as it comes, and told of all of them: readings, resistances, the angle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calibration.strain.document import SensorCalibration
from calibration.strain.prepare import CUTOFF_HZ
from calibration.strain.reading import AngleReader, frame_rate
from calibration.strain.time_figure import Panel
from skinfab.errors import InputError
from skinfab.readout.bridge import QuarterBridge, at_rest, relative
from skinfab.readout.filters import Lowpass
from skinfab.readout.frame import Frame, Recording, Stream

FloatArray = NDArray[np.float64]

ANGLE, CHANGE, OUTSIDE, TRUTH = "angle_deg", "relative_change", "outside", "true_angle_deg"


class Live:
    """One row of numbers a frame.

    With a calibration: the angle, dU/U0, whether it is outside, and the true angle where the stream has it. Without one:
    every channel, filtered; and where a bridge is given, each voltage as a resistance and its relative change.

    Parameters
    ----------
    stream : Stream
    recording : Recording
        What the readings at rest are taken from, and the rate where the stream states none.
    calibration : SensorCalibration, optional
    channel : str, optional
        To read the angle from, in place of the calibration's.
    bridge : (supply in V, series resistor in kohm), optional
        Of every channel in volts; balanced halves, gain 1, and the channel's range.

    Raises
    ------
    InputError
        The calibration's channel is not there, or no channel is in volts where a bridge is given.
    """

    def __init__(
        self,
        stream: Stream,
        recording: Recording,
        calibration: SensorCalibration | None,
        *,
        channel: str | None = None,
        bridge: tuple[float, float] | None = None,
    ) -> None:
        self._rate = frame_rate(stream, recording.device_time)
        self._reader = AngleReader(calibration, stream, channel=channel, rate_hz=self._rate) if calibration else None
        self._truth = truth_column(stream, calibration) if calibration else None
        self._in_radians = self._truth is not None and stream.channels[self._truth].unit == "rad"
        self._running = Lowpass(CUTOFF_HZ, self._rate).causal() if self._rate > 2 * CUTOFF_HZ else None
        self._held: FloatArray | None = None
        self._bridges = _bridges(recording, bridge, self._rate) if bridge else {}
        self.names = ("time_s", *self._names(stream))
        if twice := next((name for name in self.names if self.names.count(name) > 1), None):
            raise InputError(f"two columns would be called {twice!r}; rename that channel of stream {stream.name}")

    def _names(self, stream: Stream) -> list[str]:
        names = [ANGLE, CHANGE, OUTSIDE] + [TRUTH] * (self._truth is not None) if self._reader else list(stream.names)
        for k in self._bridges:
            names += [f"{stream.names[k]} (kohm)", f"{stream.names[k]} (dR/R0)"]
        return names

    def step(self, frame: Frame) -> list[float]:
        """The row of a frame; NaN for what it does not say."""
        row = [frame.device_time]
        if self._reader:
            reading = self._reader.step(frame)
            row += [reading.angle, reading.change, float(reading.outside)]
            if self._truth is not None:
                truth = float(frame.values[self._truth]) if frame.valid[self._truth] else math.nan
                row.append(math.degrees(truth) if self._in_radians else truth)
        else:
            row += self._filtered(frame)
        for k, (bridge, rest) in self._bridges.items():
            ohms, _ = bridge.resistance(np.array(frame.values[k] if frame.valid[k] else math.nan))
            row += [float(ohms), float(relative(ohms, rest))]
        return row

    def _filtered(self, frame: Frame) -> list[float]:
        usable = frame.valid & np.isfinite(frame.values)
        if self._running is None:
            return np.where(usable, frame.values, np.nan).tolist()
        # A channel that says nothing is held meanwhile: one NaN would stay in the filter for ever.
        before = np.where(usable, frame.values, 0.0) if self._held is None else self._held
        self._held = np.where(usable, frame.values, before)
        out: list[float] = np.where(usable, self._running.step(self._held), np.nan).tolist()
        return out

    def facts(self, columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
        """What is to be said of all rows, ready for JSON."""
        facts: dict[str, Any] = {"rate_hz": self._rate, "filter_hz": CUTOFF_HZ if self._reader or self._running else None}
        if self._bridges:
            rests = [rest if math.isfinite(rest) else None for _, rest in self._bridges.values()]
            facts["r0_kohm"] = dict(zip(self._bridge_names(), rests, strict=True))
        if self._reader:
            facts["angle"] = self._angles(columns)
        return facts

    def _bridge_names(self) -> list[str]:
        return [name.removesuffix(" (kohm)") for name in self.names if name.endswith(" (kohm)")]

    def _angles(self, columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
        assert self._reader is not None
        time, angle = np.array(columns["time_s"]), np.array(columns[ANGLE])
        there = np.isfinite(angle)
        facts: dict[str, Any] = {
            "model": self._reader.calibration.model.name,
            "signal": self._reader.calibration.signal,
            "min_deg": float(angle[there].min()) if there.any() else None,
            "max_deg": float(angle[there].max()) if there.any() else None,
            "without": float(np.mean(~there)) if len(there) else 0.0,
            "outside": float(np.mean(np.array(columns[OUTSIDE])[there])) if there.any() else 0.0,
            "filter_delay_s": self._reader.delay_s,
            "truth": None,
            "rms_deg": None,
            "rms_in_step_deg": None,
        }
        if self._truth is not None:
            low, high = self._reader.calibration.low, self._reader.calibration.high
            facts |= _against(time, angle, np.array(columns[TRUTH]), self._reader.delay_s, (low, high))
            facts["truth"] = self._reader.calibration.angle
        return facts


def _against(time: FloatArray, angle: FloatArray, truth: FloatArray, delay: float, limits: tuple[float, float]) -> dict[str, float | None]:
    """Errors (deg) where the true angle lies in the range: at the moment, and against what was true a filter's delay ago."""
    known = np.isfinite(truth) & np.isfinite(time)
    if np.count_nonzero(known) < 2:
        return {}
    out: dict[str, float | None] = {}
    for name, late in (("rms_deg", 0.0), ("rms_in_step_deg", delay)):
        then = _at_that_time(time - late, time[known], truth[known], float(np.median(np.diff(time)))) if late else truth
        counts = np.isfinite(angle) & np.isfinite(then) & (then >= limits[0]) & (then <= limits[1])
        out[name] = float(np.sqrt(np.mean((angle - then)[counts] ** 2))) if counts.any() else None
    return out


def _at_that_time(when: FloatArray, time: FloatArray, truth: FloatArray, step: float) -> FloatArray:
    """What was true at other moments; NaN in gaps, before the first and after the last."""
    after = np.clip(np.searchsorted(time, when), 1, len(time) - 1)
    then = np.interp(when, time, truth, left=np.nan, right=np.nan)
    return np.where(time[after] - time[after - 1] < 1.5 * step, then, np.nan)


def truth_column(stream: Stream, calibration: SensorCalibration) -> int | None:
    """The true angle's column, where the stream has one.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from skinfab.readout.frame import Channel
    >>> truth_column(Stream("one", (Channel("U"), Channel("PIP"))), SimpleNamespace(angle="PIP"))
    1
    """
    return stream.index(calibration.angle) if calibration.angle in stream.names else None


def _bridges(recording: Recording, bridge: tuple[float, float], rate: float) -> dict[int, tuple[QuarterBridge, float]]:
    """A bridge and R0 for each channel in volts."""
    out = {}
    for k, channel in enumerate(recording.stream.channels):
        if channel.unit == "V":
            made = QuarterBridge(*bridge, low_v=channel.low, high_v=channel.high)
            ohms, _ = made.resistance(recording.column(channel.name))
            try:
                out[k] = made, at_rest(ohms, rate).level
            except InputError:  # never read, or saturated from end to end: there is no R0, and the checks have said so
                out[k] = made, math.nan
    if not out:
        raise InputError("no channel is in volts, so that a bridge has nothing to turn into resistances; leave out --bridge")
    return out


def drawn(
    columns: Mapping[str, Sequence[float]], recording: Recording, calibration: SensorCalibration | None
) -> tuple[FloatArray, list[Panel]]:
    """What `draw_over_time` wants: time from the first frame on, and the panels: the angle, or each channel, or what bridges make of it."""
    time = np.array(columns["time_s"])
    since = time - time[np.isfinite(time)][0] if np.isfinite(time).any() else time
    if calibration is not None:
        curves = {calibration.angle: np.array(columns[TRUTH])} if TRUTH in columns else {}
        curves[f"{calibration.signal}, {calibration.model.name}"] = np.array(columns[ANGLE])
        return since, [Panel("angle (deg)", curves, np.array(columns[OUTSIDE]) > 0)]
    changes = [name for name in columns if name.endswith(" (dR/R0)")]
    if changes:
        return since, [Panel(f"{name.removesuffix(')')}, %)", {name: 100 * np.array(columns[name])}) for name in changes]
    units = {channel.name: f"{channel.name} ({channel.unit})" if channel.unit else channel.name for channel in recording.stream.channels}
    # A heading that holds its unit already is not given it twice.
    titles = {name: name if name.endswith((")", "]")) else unit for name, unit in units.items()}
    return since, [Panel(title, {name: np.array(columns[name])}) for name, title in titles.items()]
