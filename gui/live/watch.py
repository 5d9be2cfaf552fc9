"""What is made of frames while they come: contacts, and the calibrated joint angle. It knows no widget and no thread."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from calibration.contact.detector import Contact, ContactDetector
from calibration.contact.rest import STILL_S
from calibration.strain.document import SensorCalibration
from calibration.strain.reading import AngleReader, Reading
from gui.live.player import part
from skinfab.errors import InputError
from skinfab.readout.frame import Frame, Recording, Stream

FloatArray = NDArray[np.float64]

#: Where a stream does not say how many frames come a second, they are counted for so long, s, and so many of them.
COUNTED_S, COUNTED = 2.0, 10
#: So much of a log before the place that was sought, s, is what the angle is reckoned from: filters have forgotten what was before,
#: and of a joint's turning points only the last ones count.
CAUGHT_UP_S = 60.0


class Watch:
    """Frames in, contacts and angles out.

    Parameters
    ----------
    stream : Stream
    contact : sequence of str
        Channels to be watched for contacts; may be empty.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> time, noise = np.arange(700) / 100, np.random.default_rng(0).standard_normal((700, 1))
    >>> touched = np.where(time > 5, 140.0, 100.0)[:, None]
    >>> log = Recording.of_values(Stream("skin", (Channel("S1"),), 100.0), touched + 0.4 * noise, device_time=time)
    >>> watch = Watch(log.stream, contact=("S1",))
    >>> for frame in log:
    ...     _ = watch.step(frame)
    >>> {name: round(change, 1) for name, change in watch.touched.items()}
    {'S1': 0.4}
    """

    def __init__(self, stream: Stream, *, contact: Sequence[str]) -> None:
        self.stream, self.contact = stream, tuple(contact)
        self._counted: list[Frame] = []
        self._calibration: tuple[SensorCalibration, str] | None = None
        self._reader: AngleReader | None = None
        self.reading: Reading | None = None
        #: What cannot be done with this stream, a sentence; empty where all is well.
        self.fault = ""
        self.detector: ContactDetector | None = None
        self._know(stream.rate_hz)

    @property
    def rate_hz(self) -> float:
        """Frames a second, 0 while they are still being counted."""
        return self.stream.rate_hz

    @property
    def touched(self) -> dict[str, float]:
        """Signed change, as a part of the reading at rest, of each channel that is being touched."""
        return {} if self.detector is None else {each.channel: each.sign * each.strength for each in self.detector.lasting()}

    @property
    def waiting(self) -> tuple[str, ...]:
        """Channels that were not at rest yet, and so are not watched for contacts."""
        return self.contact if self.detector is None else self.detector.waiting

    @property
    def frozen(self) -> tuple[str, ...]:
        """Channels that have frozen."""
        return () if self.detector is None else self.detector.frozen

    @property
    def blind(self) -> str:
        """What keeps contacts from being seen now, in words; empty where nothing does."""
        if self.fault:
            return f"no contacts: {self.fault}"
        if not self.contact:
            return ""
        if not self.rate_hz:
            return f"counting frames for {COUNTED_S:g} s"
        if waiting := self.waiting:
            return f"contacts not seen yet on channel{'s' * (len(waiting) > 1)} {_some(waiting)}, not at rest for {STILL_S:g} s"
        return f"frozen: channel{'s' * (len(self.frozen) > 1)} {_some(self.frozen)}" if self.frozen else ""

    def calibrate(self, calibration: SensorCalibration | None, channel: str = "") -> None:
        """Give out angles from now on, or none any more.

        Raises
        ------
        InputError
            There is no such channel, or the frames come too rarely for its filter.
        """
        self._reader = self.reading = self._calibration = None
        if calibration is None:
            return
        require_readable(calibration, self.stream, channel)
        channel = channel or calibration.signal
        if self.rate_hz:
            self._reader = AngleReader(calibration, self.stream, channel=channel)
        self._calibration = calibration, channel

    def watch(self, contact: Sequence[str]) -> None:
        """Watch other channels for contacts; what was known of them at rest is learnt anew."""
        if tuple(contact) != self.contact:
            self.contact = tuple(contact)
            self._know(self.rate_hz)

    def step(self, frame: Frame) -> tuple[Contact, ...]:
        """Take a frame; the contacts that it shows to have begun or ended."""
        if not self.rate_hz and not self._count(frame):
            return ()
        if self._reader is not None:
            self.reading = self._reader.step(frame)
        return () if self.detector is None else self.detector.step(frame)

    def catch_up(self, recording: Recording, k: int) -> FloatArray:
        """Begin anew, and know what would be known after the first `k` frames of a log; the angles of the last of these frames."""
        self._know(self.rate_hz)
        if self.detector is not None and k:
            self.detector.run(part(recording, 0, k))
        if self._calibration is not None:
            self.calibrate(*self._calibration)
        angles = []
        if self._reader is not None:
            for frame in part(recording, max(k - round(CAUGHT_UP_S * self.rate_hz), 0), k):
                self.reading = self._reader.step(frame)
                angles.append(self.reading.angle)
        return np.array(angles)

    def _know(self, rate_hz: float) -> None:
        """Frames come at this rate: watch."""
        self.detector, self.fault = None, ""
        if not rate_hz:
            return
        self.stream = replace(self.stream, rate_hz=rate_hz)
        try:
            if self.contact:
                self.detector = ContactDetector(self.stream, channels=self.contact)
            if self._calibration is not None and self._reader is None:
                self.calibrate(*self._calibration)
        except InputError as fault:
            self.fault = str(fault)

    def _count(self, frame: Frame) -> bool:
        """Count frames until the rate is known; is it?"""
        if not math.isfinite(frame.device_time):
            return False
        self._counted.append(frame)
        lasted = frame.device_time - self._counted[0].device_time
        if lasted < 0:
            self._counted = [frame]
        if len(self._counted) < COUNTED or lasted < COUNTED_S:
            return False
        self._know((len(self._counted) - 1) / lasted)
        if self.detector is not None:
            self.detector.run(Recording.of_frames(self.stream, self._counted[:-1]))
        self._counted = []
        return True


def _some(names: Sequence[str]) -> str:
    """
    Examples
    --------
    >>> _some(["S1", "S2"]), _some([f"S{k}" for k in range(9)])
    ('S1, S2', 'S0, S1, S2 and 6 more')
    """
    return ", ".join(names) if len(names) <= 4 else f"{', '.join(names[:3])} and {len(names) - 3} more"


def require_readable(calibration: SensorCalibration, stream: Stream, channel: str = "") -> None:
    """Refuse a calibration that this stream cannot be read by.

    Raises
    ------
    InputError
        There is no such channel, or the frames come too rarely for the filter.
    """
    stream.index(channel or calibration.signal)
    if stream.rate_hz:
        AngleReader(calibration, stream, channel=channel or calibration.signal)
