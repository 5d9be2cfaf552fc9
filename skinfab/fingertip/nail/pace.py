"""How many readings a log has a second, and at which of them each frame lies: by its times, or where these are coarse by what else it says.

A clock of whole milliseconds repeats at 1.4 kHz, and frames that a computer fetched in bunches have the times of fetching. Neither
tells one reading from the next, so there the rate is what was declared, or counted, or given; the count says which frames are missing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.checks import HOLE_S, HOLE_STEPS, check_times
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Times are coarse where more than this part of the steps is shorter than half their median ...
_SHORT_PART = 0.01
#: ... or where their median is shorter than this part of their mean: most frames of a bunch have almost one time.
_SHORT_MEDIAN = 0.3
#: A rate is what was declared where frames and times agree with it as well as this, or are fewer: bunches begin and end anywhere.
_AGREES, _FEWER = 0.01, 0.2
#: What is given may differ so much from what even times say.
_GIVEN = 0.05
#: A frame is missing where times run ahead by half a step of the clock and this much of a reading, of so many frames before.
_AHEAD, _BEFORE = 0.3, 64
#: A clock's step of more readings tells nothing of single ones.
_COARSEST = 3.0


@dataclass(frozen=True)
class Pace:
    """How a log's frames follow one another.

    Parameters
    ----------
    rate_hz : float
        Readings a second.
    coarse : bool
        Its times do not tell one reading from the next.
    bunched : bool
        They are those of fetching many frames at once, and say nothing at all of single ones.
    notes : tuple of str
        What is wrong with the times, and where the rate is from if not from them.
    """

    rate_hz: float
    coarse: bool = False
    bunched: bool = False
    notes: tuple[str, ...] = ()


def pace_of(recording: Recording, *, rate_hz: float | None = None) -> Pace:
    """How a log's frames follow one another.

    Parameters
    ----------
    recording : Recording
    rate_hz : float, optional
        What somebody says who knows it; used where the times are coarse.

    Raises
    ------
    InputError
        There are too few frames, their times do not go on at all, or what is given is not what they say.
    """
    timed = np.isfinite(recording.device_time)
    steps, counts = np.diff(recording.device_time[timed]), np.diff(recording.sequence[timed])
    usable = (steps >= 0) & (steps < _hole_s(steps)) & (counts >= 1)
    time, frames = float(steps[usable].sum()), int(counts[usable].sum())
    if time <= 0:
        raise InputError(
            f"stream {recording.stream.name}: the times of its {timed.sum()} frames do not go on, and give no rate; "
            "write the device's time with each frame, in seconds"
        )
    middle = float(np.median(steps[usable]))
    if middle > _SHORT_MEDIAN * time / usable.sum() and (steps[usable] < 0.5 * middle).mean() <= _SHORT_PART:
        # A mean without the gaps: the median alone would be rounded as coarsely as the device's clock.
        rate = float(1 / steps[usable & (steps < 1.5 * middle)].mean())
        if rate_hz and abs(rate_hz - rate) > _GIVEN * rate:
            raise InputError(f"stream {recording.stream.name} has {rate:.4g} readings a second by its times; leave --rate out")
        return Pace(rate, notes=tuple(check_times(recording)))
    rate, whence = _coarse_rate(recording, frames / time, rate_hz)
    # A clock's step that is shorter than a reading is that of frames within a bunch.
    clock = float(np.median(steps[usable & (steps > 0)])) * rate
    return Pace(
        rate,
        True,
        not 0.5 < clock <= _COARSEST,
        (_coarse_note(recording, frames, time, rate, whence), *check_times(recording, coarse=True)),
    )


def _hole_s(steps: FloatArray) -> float:
    """A step of this many seconds is a hole."""
    rising = steps[steps > 0]
    return max(HOLE_S, HOLE_STEPS * float(np.median(rising))) if len(rising) else HOLE_S


def _coarse_rate(recording: Recording, measured: float, given: float | None) -> tuple[float, str]:
    nominal = recording.stream.rate_hz
    if given:
        return given, "given"
    if _counted(recording):
        return measured, "counted"
    if nominal and -_AGREES < 1 - measured / nominal < _FEWER:
        return nominal, "declared"
    return measured, "all"


def _counted(recording: Recording) -> bool:
    return bool((np.diff(recording.sequence) != 1).any())


def _coarse_note(recording: Recording, frames: int, time: float, rate: float, whence: str) -> str:
    alike = len(recording) / max(len(np.unique(recording.device_time)), 1)
    what = f"{alike:.2g} frames have the same time in the mean" if alike > 1.05 else "its frames come in bunches"
    said = {
        "given": f"its rate is the {rate:g} a second of --rate",
        "counted": f"its rate is {rate:.5g} a second by the frames' count",
        "declared": f"its rate is the {rate:g} a second that it declares",
        "all": f"its rate is taken to be {rate:.5g} a second, as if no frame were lost (else give --rate)",
    }[whence]
    missing = round(time * rate - frames)
    lost = (
        f"; by that {missing} frames are missing, of which such times tell the places roughly or not at all"
        if missing > 0.01 * frames
        else ""
    )
    return f"{what}, so they do not tell one reading from the next, and {said}{lost}"


def places_of(recording: Recording, pace: Pace) -> IntArray:
    """Which place in an even row of readings each frame has: by the device's count, or by its times where that shows nothing lost.

    A plain table has no count of its own. Times that lie in bunches say when frames were fetched, and tell but holes.

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
    if _counted(recording) or not np.isfinite(steps).all() or (steps < 0).any():
        return count
    if pace.coarse:
        return _by_coarse_times(steps, pace.bunched, _hole_s(np.diff(recording.device_time)) * pace.rate_hz)
    if (steps < 0.5).any():
        return count
    places: IntArray = np.concatenate([[0], np.cumsum(np.rint(steps).astype(np.int64))])
    return places


def _by_coarse_times(steps: FloatArray, bunched: bool, hole: float) -> IntArray:
    """Places by times (as steps, in readings) that run ahead of the frames by more than their clock's own step."""
    limit = math.inf if bunched else float(np.median(steps[(steps > 0) & (steps < hole)])) / 2 + _AHEAD
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


def times_of(recording: Recording, places: IntArray, pace: Pace) -> FloatArray:
    """Of each frame, s, from the first that has one: its own, or where these come in bunches, those of an even row through them."""
    time = recording.device_time - recording.device_time[np.isfinite(recording.device_time)][0]
    if not pace.bunched or (np.diff(places) < 1).any():
        return time
    timed = np.isfinite(time)
    slope = float(np.polyfit(places[timed], time[timed], 1)[0])
    out: FloatArray = slope * (places - places[timed][0])
    return out
