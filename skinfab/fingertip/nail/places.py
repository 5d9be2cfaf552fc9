"""Where in an even row of readings each frame of a log lies, and when it was read: by the device's count, or by times as far as these go.

A frame that comes late says nothing of lost ones: those after it are in time again. Only a gap that lasts is one.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, minimum_filter1d, uniform_filter1d

from skinfab.fingertip.nail.pace import Pace, counted, hole_s
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: A frame is missing where times run ahead by half a step of the clock and this much of a reading, of so many frames before.
_AHEAD, _BEFORE = 0.3, 64
#: A gap lasts where so many frames on both sides of it lie, in their mean, more than so much of a reading apart, and more than so many
#: standard deviations of that mean.
_BESIDE, _LASTS, _SURE = 32, 0.6, 5.0
#: So many times it is looked at after a gap: the next frames may be late themselves.
_LOOKS = 4
#: Fewer frames beside a gap tell nothing.
_FEWEST = 8
#: A step of so many readings may be a gap; one of more shows, whatever else times do.
_GAP, LONG_GAP = 1.4, 8.0
#: Bunches are seen through by the mean of so many frames. Where more of the frames are missing, they are looked for in the mean of many,
#: in which so much of a reading shows one that stays for so many frames.
_THROUGH, _MISSING, _SHOWN, _STAYS = 256, 0.01, 0.65, 512


def places_of(recording: Recording, pace: Pace) -> IntArray:
    """Which place in an even row of readings each frame has: by the device's count, or by its times where that shows nothing lost.

    A plain table has no count of its own. Times that lie in bunches tell where frames are missing but to some bunches.

    Parameters
    ----------
    recording : Recording
    pace : Pace
        From `pace_of`.

    Returns
    -------
    (n,) int
        From 0; not above its predecessor where a device began anew.
    """
    count: IntArray = recording.sequence - recording.sequence[:1]
    steps = np.diff(recording.device_time) * pace.rate_hz
    if counted(recording) or not np.isfinite(steps).all() or (steps < 0).any():
        return count
    if pace.kind == "even" and (steps >= 0.5).all():
        return _summed(np.rint(steps).astype(np.int64))
    hole = hole_s(np.diff(recording.device_time)) * pace.rate_hz
    if pace.kind == "clock":
        return _by_clock(steps, hole)
    return _by_all_frames(steps, hole, pace)


def _summed(steps: IntArray) -> IntArray:
    places: IntArray = np.concatenate([[0], np.cumsum(steps)])
    return places


def _by_clock(steps: FloatArray, hole: float) -> IntArray:
    """Places by times (as steps, in readings) that run ahead of the frames by more than their clock's own step."""
    limit = float(np.median(steps[(steps > 0) & (steps < hole)])) / 2 + _AHEAD
    places, ahead, at, base = [0], [0.0], 0.0, 0.0
    for step in steps.tolist():
        at += step
        place = places[-1] + 1
        if step >= hole:
            place = max(place, round(places[-1] + step))
            ahead = []
        elif len(ahead) >= _BEFORE // 8:
            base = sum(ahead[-_BEFORE:]) / len(ahead[-_BEFORE:])
            place += math.ceil(max(at - place - base - limit, 0.0))
        ahead.append(at - place)
        places.append(place)
    return np.array(places, dtype=np.int64)


def lasting(steps: FloatArray, *, shortest: float = _GAP) -> IntArray:
    """How many frames are missing in each of the steps, in readings: none where those after it make up for it.

    Examples
    --------
    >>> steps = np.ones(200)
    >>> steps[50], steps[51:80] = 30.0, 0.0  # 29 frames that came late
    >>> steps[150] = 3.0  # two that never did
    >>> np.flatnonzero(lasting(steps)).tolist(), int(lasting(steps).sum())
    ([150], 2)
    """
    ahead = np.concatenate([[0.0], np.cumsum(steps - 1)])
    noise = 1.4826 * float(np.median(np.abs(ahead - median_filter(ahead, 2 * _BESIDE + 1))))
    missing = np.zeros(len(steps), dtype=np.int64)
    longer = np.flatnonzero(steps > shortest)
    for k in longer[np.argsort(-steps[longer], kind="stable")].tolist():  # the longest first: they hide shorter ones beside them
        # Frames that gathered while nothing came follow at once, as many as the step is long.
        late = k + 1 + math.ceil(steps[k])
        looks = max(_LOOKS, math.ceil(_LOOKS * steps[k] / _BESIDE))
        after = [ahead[n : n + _BESIDE] for n in range(late, late + looks * _BESIDE, _BESIDE) if n + _FEWEST <= len(ahead)]
        before = ahead[max(k + 1 - _BESIDE, 0) : k + 1]
        if not after or len(before) < _FEWEST:
            continue
        jump = float(min(each.mean() for each in after) - before.mean())
        if jump > max(_LASTS, _SURE * noise * math.sqrt(1 / len(after[-1]) + 1 / len(before))):
            missing[k] = min(round(jump), math.ceil(steps[k]) - 1)
            ahead[k + 1 :] -= missing[k]
    return missing


def _by_all_frames(steps: FloatArray, hole: float, pace: Pace) -> IntArray:
    """Places by times that say little of single frames, between holes: what is missing by the rate is seen in all of them together."""
    places: list[int] = []
    for k, part in enumerate(np.split(steps, np.flatnonzero(steps >= hole))):
        inside = part[1:] if k else part
        first = max(round(places[-1] + part[0]), places[-1] + 1) if k else 0
        missing = np.zeros(len(inside), dtype=np.int64) if pace.kind == "bunches" else lasting(inside, shortest=LONG_GAP)
        if (inside - missing).sum() - len(inside) > _MISSING * len(inside):
            missing += _through(inside - missing, _THROUGH if pace.kind == "bunches" else 2 * _BESIDE)
        elif pace.kind != "bunches" and pace.known:
            missing = lasting(inside)
        places += (first + _summed(1 + missing)).tolist()
    return np.array(places, dtype=np.int64)


def _through(steps: FloatArray, width: int) -> IntArray:
    """How many frames are missing in each of the steps: as far as the times run ahead in the middle of so many frames, and stay so."""
    ahead = np.concatenate([[0.0], np.cumsum(steps - 1)])
    stays = minimum_filter1d(uniform_filter1d(ahead, width, mode="nearest"), _STAYS, origin=-(_STAYS // 2), mode="nearest")
    gone = np.maximum.accumulate(np.floor(np.maximum(stays - stays[0], 0) + 1 - _SHOWN))
    out: IntArray = np.diff(gone).astype(np.int64)
    return out


def times_of(recording: Recording, places: IntArray, pace: Pace) -> FloatArray:
    """Of each frame, s, from the first that has one: its own, or where that is no reading's, as those around it say."""
    time = recording.device_time - recording.device_time[np.isfinite(recording.device_time)][0]
    if pace.kind in ("even", "clock") or (np.diff(places) < 1).any():
        return time
    timed = np.isfinite(time)
    even = places[timed] / pace.rate_hz
    around = even + median_filter(time[timed] - even, _THROUGH + 1, mode="nearest")
    out: FloatArray = np.interp(places, places[timed], around - around[0])
    return out
