"""How many readings a log has a second: by its times, or where these are not those of single readings by what else it says.

A clock of whole milliseconds repeats at 1.4 kHz, a computer that writes down when it got a frame gets some late, and frames that it fetched
in bunches have the times of fetching. There the rate is what was declared, or counted, or given, or all frames over all time; the count
says which frames are missing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.checks import HOLE_S, HOLE_STEPS, check_times
from skinfab.readout.frame import Recording

if TYPE_CHECKING:
    from skinfab.readout.logs.log import Log

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Kind = Literal["even", "clock", "bunches", "jitter"]

#: Times are even where no more than this part of the steps is farther from whole ones than this: with more, some lost frames and late ones
#: are alike ...
_ODD_PART, _OFF = 0.01, 0.3
#: ... and their median is no shorter than this part of their mean: most frames of a bunch have almost one time.
_SHORT_MEDIAN = 0.3
#: A clock that is little faster than the frames makes some steps of two of its own: where frames with so many of them keep to a line within
#: so many of its steps, as most of a log's parts do, these are no lost frames (which wander off it by the root of their number).
_DOUBLES, _WANDER = 20, 1.5
#: Steps are a clock's where no more than `_ODD_PART` of them is farther from a whole number of its steps.
_OFF_CLOCK = 0.1
#: A rate is what was declared where frames and times agree with it as well as this, or are fewer: bunches begin and end anywhere.
_AGREES, _FEWER = 0.01, 0.2
#: What is given may differ so much from what even times say.
_GIVEN = 0.05
#: A clock's step of more readings tells nothing of single ones.
_COARSEST = 3.0


@dataclass(frozen=True)
class Pace:
    """How a log's frames follow one another.

    Parameters
    ----------
    rate_hz : float
        Readings a second.
    kind : str
        What its times are: ``even``, those of single readings; ``clock``, in steps of a clock that is about as slow as the readings;
        ``bunches``, those of fetching many frames at once, which say nothing at all of single ones; ``jitter``, some of them late.
    loose_s : float
        The last frame may have been read so much later than its time says: a bunch's length, or that of single frames' delay.
    known : bool
        The rate is known of itself: by even times, the count, or who declared or gave it. Else it is all frames over all time.
    notes : tuple of str
        What is wrong with the times, and where the rate is from if not from them.
    """

    rate_hz: float
    kind: Kind = "even"
    loose_s: float = 0.0
    known: bool = True
    notes: tuple[str, ...] = ()


def pace_of_log(log: Log, *, rate_hz: float | None = None) -> Pace:
    """As `pace_of`; of a plain table, which declares no rate."""
    made = log.recording
    return pace_of(replace(made, stream=replace(made.stream, rate_hz=0.0)) if log.rate_of_times else made, rate_hz=rate_hz)


def pace_of(recording: Recording, *, rate_hz: float | None = None) -> Pace:
    """How a log's frames follow one another.

    Parameters
    ----------
    recording : Recording
    rate_hz : float, optional
        What somebody says who knows it; used where the times are not those of single readings.

    Raises
    ------
    InputError
        There are too few frames, their times do not go on at all, or what is given is not what they say.
    """
    timed = np.isfinite(recording.device_time)
    steps, counts = np.diff(recording.device_time[timed]), np.diff(recording.sequence[timed])
    usable = (steps >= 0) & (steps < hole_s(steps)) & (counts >= 1)
    if steps[usable].sum() <= 0:
        raise InputError(
            f"stream {recording.stream.name}: the times of its {timed.sum()} frames do not go on, and give no rate; "
            "write the device's time with each frame, in seconds"
        )
    kind = _kind(steps[usable])
    if kind == "even":
        # A mean without the gaps: the median alone would be rounded as coarsely as the device's clock.
        rate = float(1 / steps[usable & (steps < 1.5 * np.median(steps[usable]))].mean())
        if rate_hz and abs(rate_hz - rate) > _GIVEN * rate:
            raise InputError(f"stream {recording.stream.name} has {rate:.4g} readings a second by its times; leave --rate out")
        return Pace(rate, notes=tuple(check_times(recording)))
    if kind == "jitter" and not counted(recording):
        usable &= ~_lasting_gaps(steps, counts, usable)
    time, frames = float(steps[usable].sum()), int(counts[usable].sum())
    rate, whence = _rate_beside(recording, frames / time, rate_hz)
    note = f"{_what(recording, kind, steps[usable])}, and {_whence(frames, time, rate, whence, kind)}"
    return Pace(rate, kind, _loose_s(kind, steps[usable]), whence != "all", (note, *check_times(recording, coarse=True)))


def hole_s(steps: FloatArray) -> float:
    """A step of this many seconds is a hole."""
    rising = steps[steps > 0]
    return max(HOLE_S, HOLE_STEPS * float(np.median(rising))) if len(rising) else HOLE_S


def counted(recording: Recording) -> bool:
    """Does the device's count say that frames are missing?"""
    return bool((np.diff(recording.sequence) != 1).any())


def _kind(steps: FloatArray) -> Kind:
    middle, mean = float(np.median(steps)), float(steps.mean())
    if middle > _SHORT_MEDIAN * mean:
        units = steps / middle
        whole = np.rint(units)
        if ((np.abs(units - whole) > _OFF) | (whole < 1)).mean() <= _ODD_PART and not _keeps_to_a_line(whole):
            return "even"
    rising = steps[steps > 0]
    clock = float(np.median(rising))
    if clock < 0.5 * mean:  # a step that is shorter than a reading is that of frames within a bunch
        return "bunches"
    ticks = np.rint(rising / clock)
    if ((np.abs(rising / clock - ticks) > _OFF_CLOCK) | (ticks < 1)).mean() > _ODD_PART:
        return "jitter"
    return "clock" if clock <= _COARSEST * mean else "bunches"


def _keeps_to_a_line(whole: FloatArray) -> bool:
    """Are steps of two ticks those of a clock, rather than of lost frames?"""
    doubles = int((whole != 1).sum())
    if doubles < _DOUBLES:
        return False
    blocks = np.array_split(whole, max(doubles // _DOUBLES, 1))
    return float(np.median([np.ptp(np.cumsum(each - each.mean())) for each in blocks])) < _WANDER


def _lasting_gaps(steps: FloatArray, counts: IntArray, usable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Steps in which many frames are missing, while single ones cannot be told from late ones."""
    from skinfab.fingertip.nail.places import LONG_GAP, lasting

    rate = float(counts[usable].sum() / steps[usable].sum())
    readings = np.where(usable, steps * rate, 1.0)
    return lasting(readings, shortest=LONG_GAP) > 0


def _rate_beside(recording: Recording, measured: float, given: float | None) -> tuple[float, str]:
    """The rate and where it is from, where times do not tell it alone."""
    nominal = recording.stream.rate_hz
    if given:
        return given, "given"
    if counted(recording):
        return measured, "counted"
    if nominal and -_AGREES < 1 - measured / nominal < _FEWER:
        return nominal, "declared"
    return measured, "all"


def _what(recording: Recording, kind: Kind, steps: FloatArray) -> str:
    alike = len(recording) / max(len(np.unique(recording.device_time)), 1)
    if kind == "jitter":
        least, middle, most = 1000 * np.quantile(steps, [0.0, 0.5, 1.0])
        return f"its times jitter (steps of {least:.2g} to {most:.2g} ms, {middle:.2g} in the middle), so some frames come late"
    what = (
        f"{alike:.2g} frames have the same time in the mean"
        if alike > 1.05
        else "its frames come in bunches"
        if kind == "bunches"
        else f"its clock goes in steps of {1000 * float(np.median(steps[steps > 0])):.2g} ms"
    )
    return f"{what}, so they do not tell one reading from the next"


def _whence(frames: int, time: float, rate: float, whence: str, kind: Kind) -> str:
    said = {
        "given": f"its rate is the {rate:g} a second of --rate",
        "counted": f"its rate is {rate:.5g} a second by the frames' count",
        "declared": f"its rate is the {rate:g} a second that it declares",
        "all": f"its rate is taken to be {rate:.5g} a second, as if no frame were lost (else give --rate)",
    }[whence]
    missing = round(time * rate - frames)
    if missing <= 0.01 * frames:
        return said
    where = "their places to some bunches" if kind == "bunches" else "their places but roughly"
    return f"{said}; by that {missing} frames are missing, of which such times tell {where}"


def _loose_s(kind: Kind, steps: FloatArray) -> float:
    """How much later than its time says a frame may have been read."""
    if kind in ("even", "clock"):
        return 0.0
    mean = float(steps.mean())
    return float(np.quantile(steps[steps > mean], 0.99)) if (steps > mean).any() else mean
