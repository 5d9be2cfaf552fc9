"""What contact detection is usually done with, to be measured beside ours: a fixed threshold, and a high-pass before one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from calibration.contact.detector import Contact
from calibration.contact.rest import STILL_S
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]

#: Change that counts as a contact, as a part of the reading at rest: half of what the paper calls its smallest.
THRESHOLD = 0.05
#: Cut-off of the high-pass, Hz: it forgets a drift of a minute.
HIGH_PASS_HZ = 0.1
#: An alarm needs so many frames in a row, as ours does.
FRAMES = 3


def fixed_threshold(recording: Recording, *, signed: bool = False) -> list[Contact]:
    """A contact is where the change from the first seconds is beyond a threshold; it ends at half of that.

    Parameters
    ----------
    recording : Recording
    signed : bool
        Count rises only.
    """
    return _beyond(recording, _changes(recording), signed)


def high_pass(recording: Recording) -> list[Contact]:
    """The same after a second-order Butterworth high-pass, which takes the drift away."""
    sections = signal.butter(2, HIGH_PASS_HZ, btype="high", fs=_rate(recording), output="sos")
    return _beyond(recording, signal.sosfilt(sections, _changes(recording), axis=0), False)


def _rate(recording: Recording) -> float:
    return recording.stream.rate_hz or float(1 / np.median(np.diff(recording.device_time)))


def _changes(recording: Recording) -> FloatArray:
    """Relative change of all channels, (n, c); what is not valid or saturated repeats what was before."""
    out = np.empty_like(recording.values)
    still = recording.device_time < recording.device_time[0] + STILL_S
    for j in range(out.shape[1]):
        good = recording.valid[:, j] & ~recording.saturated[:, j]
        if not (good & still).any():
            out[:, j] = 0.0
            continue
        rest = np.median(recording.values[good & still, j])
        last = np.maximum.accumulate(np.where(good, np.arange(len(good)), -1))
        out[:, j] = np.where(last < 0, 0.0, recording.values[last, j] / rest - 1)
    return out


def _beyond(recording: Recording, changes: FloatArray, signed: bool) -> list[Contact]:
    contacts = []
    time = recording.device_time
    for j, name in enumerate(recording.stream.names):
        size = changes[:, j] if signed else np.abs(changes[:, j])
        high = np.convolve(size >= THRESHOLD, np.ones(FRAMES), "full")[: len(size)] == FRAMES
        low = size < THRESHOLD / 2
        k = 0
        while (rises := np.flatnonzero(high[k:])).size:
            first = k + int(rises[0])
            falls = np.flatnonzero(low[first:])
            last = first + int(falls[0]) if falls.size else len(size)
            peak = changes[first + int(np.argmax(size[first:last])), j]
            end = float(time[last]) if falls.size else float("nan")
            contacts.append(Contact(name, float(time[first]), end, 1 if peak > 0 else -1, float(abs(peak))))
            k = last
            if not falls.size:
                break
    return contacts
